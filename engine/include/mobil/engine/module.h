#pragma once
// An effect in one value: the parts that it puts on rows, the systems that work on them, and what rows must fulfil that
// come out of a snapshot. The library's own effects are modules, and a host's are the same kind of value:
//
//   Module fatigue() {
//     return {.name = "fatigue",
//             .parts = {component_id<Fatigue>()},
//             .systems = [](ScheduleBuilder& systems) { systems.add("fatigue", &tire); }};
//   }
//   Simulation simulation({.modules = {fatigue()}});
//
// A system says by its signature what it reads and writes (mobil/engine/access.h), and runs in the order that follows
// from that: between the library's systems, before or after them.

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

/// An immutable resource that snapshots name by the module's name and its own. `part`: component_id(Shared<T>{}).
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
  /// Tells modules of one simulation apart, and is how a snapshot names them.
  std::string name{};
  /// Of what the parts mean. A snapshot with rows of this module, made with another version of it, is refused.
  std::uint32_t version = 1;
  /// Everything that its rows may have: components (`component_id<C>()`), fields (`component_id(FieldWidth<Tag>{})`),
  /// tags, shared resources and published structs (`component_id(…)` of an empty one). Each part is one module's.
  std::vector<ComponentId> parts{};
  /// Resources that its rows may share. A snapshot keeps their names; what it does not know here is refused.
  std::vector<NamedResource> resources{};
  /// Values that are state, but no entity's (mobil/engine/globals.h). Each is one module's.
  std::vector<GlobalPart> globals{};
  /// The part of a table whose column follows from the table's other columns, so that snapshots leave it out: its id,
  /// or 0; one a table at most. `make` makes it of blocks [begin, end) of such a table, with the bits that the last
  /// tick gave it; from any thread. Both or neither. What another system writes into such a column is not in snapshots:
  /// after a restore it is there once that system has run.
  std::function<std::uint64_t(const Archetype& key)> follows{};
  std::function<void(Table& table, const World& world, std::size_t begin, std::size_t end)> make{};
  /// Adds its systems; may be empty.
  std::function<void(ScheduleBuilder&)> systems{};
  /// Phases before and after the systems of a tick; those of earlier modules come first.
  std::vector<Phase> before{}, after{};
  /// Whether a table's key makes sense, asked before a snapshot's rows are given a table; may be empty. `world` has the
  /// key's resources.
  std::function<Result<void>(const Archetype& key, const World& world)> check_key{};
  /// Whether the rows of a saved table that has one of these parts are sound: numbers that lists are read by are in
  /// range. May be empty. Asked after sizes and layouts were checked.
  std::function<Result<void>(const SavedWorld& saved, std::uint32_t table)> check_rows{};
};

/// The schedule of all modules' systems, in their order. Errors, one line each: two modules of one name, a part that
/// two modules claim, what ScheduleBuilder::build refuses.
Result<Schedule> make_schedule(std::span<const Module> modules,
                               std::pmr::memory_resource* memory = std::pmr::get_default_resource());

/// The module that a part is of, or null.
const Module* module_of(std::span<const Module> modules, std::uint64_t part);

}  // namespace mobil::inline v0_3
