#pragma once
// A module: an effect's parts, systems, phases and checks for snapshots. The library's effects are modules, and a
// host's are values of the same type:
//
//   Module fatigue() {
//     return {.name = "fatigue",
//             .parts = {component_id<Fatigue>()},
//             .systems = [](ScheduleBuilder& systems) { systems.add("fatigue", &tire); }};
//   }
//   Simulation simulation({.modules = {fatigue()}});
//
// The order of a system follows from its signature (mobil/engine/access.h): between, before or after the library's
// systems.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <memory_resource>
#include <span>
#include <string>
#include <vector>

#include <mobil/engine/archetype.h>
#include <mobil/engine/error.h>
#include <mobil/engine/globals.h>
#include <mobil/engine/phase.h>

namespace mobil::inline v0_3 {

class Schedule;  // mobil/schedule.h
class ScheduleBuilder;
struct SavedWorld;  // engine/snapshot.h
class Table;
class World;

/// An immutable resource that snapshots identify by the module's name and its own. `part`: component_id(Shared<T>{}).
struct NamedResource {
  std::string name{};
  ComponentId part;
  std::shared_ptr<const void> resource;
};
template <class T>
NamedResource named_resource(std::string name, std::shared_ptr<const T> resource) {
  return {std::move(name), component_id(Shared<T>{}), std::move(resource)};
}

struct Module {
  /// Name, unique in a simulation, by which snapshots identify the module.
  std::string name{};
  /// Version of the parts' meaning. Snapshots with rows of another version of this module are refused.
  std::uint32_t version = 1;
  /// All parts that its rows can have: components (`component_id<C>()`), fields (`component_id(FieldWidth<Tag>{})`),
  /// tags, shared resources and published structs (`component_id(…)` of an empty one). A part belongs to one module
  /// only.
  std::vector<ComponentId> parts{};
  /// Resources that its rows can share. Snapshots contain their names; a name that is missing here is refused.
  std::vector<NamedResource> resources{};
  /// State that does not belong to entities (mobil/engine/globals.h). A global belongs to one module only.
  std::vector<GlobalPart> globals{};
  /// `follows` returns the id of a column that can be computed from the table's other columns, or 0; at most one a
  /// table. Snapshots omit it. `make` computes blocks [begin, end) of it, with the bits of the last tick, from any
  /// thread. Set both or neither. Values that another system writes into the column are not in snapshots; they return
  /// when that system has run.
  std::function<std::uint64_t(const Archetype& key)> follows{};
  std::function<void(Table& table, const World& world, std::size_t begin, std::size_t end)> make{};
  /// Adds its systems; can be empty.
  std::function<void(ScheduleBuilder&)> systems{};
  /// Phases before and after the systems of a tick; those of earlier modules come first.
  std::vector<Phase> before{}, after{};
  /// Checks a table's key before a snapshot's rows are given a table; can be empty. `world` has the key's resources.
  std::function<Result<void>(const Archetype& key, const World& world)> check_key{};
  /// Checks the rows of a saved table that has one of these parts, mainly the ranges of numbers used as indices. Can be
  /// empty. Called after sizes and layouts were checked.
  std::function<Result<void>(const SavedWorld& saved, std::uint32_t table)> check_rows{};
};

/// Returns the schedule of all modules' systems, in their order. Errors, one line each: two modules of one name, a part
/// in two modules, errors of ScheduleBuilder::build.
Result<Schedule> make_schedule(std::span<const Module> modules,
                               std::pmr::memory_resource* memory = std::pmr::get_default_resource());

/// Returns the module of a part, or null.
const Module* module_of(std::span<const Module> modules, std::uint64_t part);

}  // namespace mobil::inline v0_3
