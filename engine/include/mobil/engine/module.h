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
#include <cstring>
#include <functional>
#include <memory>
#include <memory_resource>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <mobil/engine/archetype.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

struct Frame;    // mobil/engine/phase.h
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

/// Declaration of a type of global. `first`: bytes of the initial value. `is_sound`: checks a value from a snapshot;
/// null if every value is valid.
struct GlobalPart {
  std::uint64_t id = 0;
  std::string_view name;
  std::span<const std::byte> first;
  bool (*is_sound)(const void* value) = nullptr;
};

/// Declares T, which must be trivially copyable, unpadded, at most 16-byte aligned; T{} is its first value.
template <class T, bool (*sound)(const T&) = nullptr>
GlobalPart global_part() {
  static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= 16);
  static const T first{};
  GlobalPart part{type_id<T>(), type_name<T>(), std::as_bytes(std::span(&first, 1))};
  if constexpr (sound != nullptr) {
    part.is_sound = [](const void* value) {
      T copy;
      std::memcpy(static_cast<void*>(&copy), value, sizeof(T));
      return sound(copy);
    };
  }
  return part;
}

/// A phase of a module (Module::before, Module::after). If a `before` phase throws, the tick ends before its systems
/// and does not count. The effects of earlier phases stay, and the next tick begins with the phase that threw. If an
/// `after` phase throws, the tick counts, and later phases do not run in that tick. A phase that can run out of memory
/// must allocate before it changes anything, or use a World::Transaction. A phase can call the simulation that runs it,
/// except `tick` and `advance`.
struct Phase {
  std::string name;
  std::function<void(const Frame& frame)> run;
};

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
