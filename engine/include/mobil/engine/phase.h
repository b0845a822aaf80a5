#pragma once
// Phases: work before or after the systems of a tick, one phase at a time on the calling thread. Phases can create,
// destroy and move rows; systems cannot.
//
//   Module arrivals() {
//     return {.name = "arrivals",
//             .before = {{"arrivals", [](const Frame& frame) { frame.world.create(…); }}}};
//   }

#include <concepts>
#include <cstdint>
#include <memory>
#include <memory_resource>
#include <utility>
#include <vector>

#include <mobil/engine/archetype.h>
#include <mobil/engine/clock.h>
#include <mobil/engine/jobs.h>

namespace mobil::inline v0_3 {

class Schedule;
class World;

/// Values kept between ticks, one of each type: scratch memory of phases, and results for hosts. They are not in
/// snapshots or hashes.
class Workspace {
 public:
  /// Passes `memory` to each T that can be constructed from it.
  explicit Workspace(std::pmr::memory_resource* memory = std::pmr::get_default_resource()) : memory_(memory) {}

  /// Returns the T, constructed on the first call. Not thread-safe.
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
  /// Returns the T; null before the first `get`.
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

/// A simulation as its phases see it. `tick.index` counts finished ticks, in an `after` phase including this one. The
/// schedule's timings are those of the last tick.
struct Frame {
  World& world;
  const Jobs& jobs;
  const Tick& tick;
  Workspace& workspace;
  const Schedule& schedule;
};

}  // namespace mobil::inline v0_3
