#pragma once
// Work of a tick before or after its systems: one phase after the other, on the thread that ticks. Phases can create,
// destroy and move rows, which no system can do.
//
//   Module arrivals() {
//     return {.name = "arrivals",
//             .before = {{"arrivals", [](const Frame& frame) { frame.world.create(…); }}}};
//   }

#include <concepts>
#include <cstdint>
#include <functional>
#include <memory>
#include <memory_resource>
#include <string>
#include <utility>
#include <vector>

#include <mobil/engine/archetype.h>
#include <mobil/engine/clock.h>
#include <mobil/engine/jobs.h>

namespace mobil::inline v0_3 {

class Schedule;
class World;

/// Values kept from one tick to the next, one of each type: memory that phases work in, and results that hosts read
/// afterwards. No snapshot contains them, and no hash.
class Workspace {
 public:
  /// `memory` goes to each T that can be constructed from it.
  explicit Workspace(std::pmr::memory_resource* memory = std::pmr::get_default_resource()) : memory_(memory) {}

  /// The T, constructed when first requested. Not for two threads at once.
  template <class T>
  T& get() {
    for (const auto& [type, value] : values_)
      if (type == type_id<T>()) return *static_cast<T*>(value.get());
    std::shared_ptr<T> made;
    if constexpr (std::constructible_from<T, std::pmr::memory_resource*>) {
      made = std::make_shared<T>(memory_);
    } else {
      made = std::make_shared<T>();
    }
    values_.emplace_back(type_id<T>(), made);
    return *made;
  }
  /// The T; null where nobody has requested one yet.
  template <class T>
  T* find() const {
    for (const auto& [type, value] : values_)
      if (type == type_id<T>()) return static_cast<T*>(value.get());
    return nullptr;
  }
  std::pmr::memory_resource* memory() const { return memory_; }

 private:
  std::pmr::memory_resource* memory_;
  std::vector<std::pair<std::uint64_t, std::shared_ptr<void>>> values_;
};

/// What a simulation consists of, as its phases see it. `tick.index` counts finished ticks: an `after` phase finds this
/// one among them. The schedule's timings are those of the last tick.
struct Frame {
  World& world;
  const Jobs& jobs;
  const Tick& tick;
  Workspace& workspace;
  const Schedule& schedule;
};

/// A phase of a module (Module::before, Module::after). A `before` phase that throws ends the tick before its systems
/// run, and the tick does not count. What earlier phases did stays, and the next tick begins with the phase that threw.
/// After an `after` phase that throws the tick counts, and the phases behind it do not run for that tick.
/// A phase that may lack memory takes it before it changes anything, or works within a World::Transaction. A phase can
/// call the simulation that runs it, except `tick` and `advance`.
struct Phase {
  std::string name;
  std::function<void(const Frame& frame)> run;
};

}  // namespace mobil::inline v0_3
