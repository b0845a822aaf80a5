#pragma once
// Warm-up of new muscles, as if they had always existed: their person's last ticks are simulated in a small separate
// world.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <mobil/engine/module.h>
#include <mobil/engine/world.h>
#include <mobil/schedule.h>
#include <mobil/systems/people/sleepers.h>
#include "systems/muscles/leg_muscles.h"
#include "systems/states/waking.h"

namespace mobil::inline v0_3 {

/// Returns the ticks to simulate so that control points are within `within_m` of where they would be; 0 if rest is near
/// enough. Measured on 24 people of a crowd, 8/s of damping (tested by Sleep.MusclesWarmUpToTheRequestedError): at rest
/// 12 mm, after half a second 4.1 mm, after one 0.64 mm, after 2.1 below 4 µm.
std::uint32_t warm_ticks(float within_m, double tick_s);

/// The small world, created on first use; none of it is state.
class WarmingRoom {
 public:
  /// `modules`: the library's own. Allocates from `memory`.
  WarmingRoom(std::span<const Module> modules, std::pmr::memory_resource* memory);

  /// Warms up muscles of this choice that have just started at rest. Muscles of steady walkers get the state after so
  /// many ticks of the walk. Those of other people, and those that follow moments, stay unchanged.
  void warm(const MuscleScene& scene, std::span<const Entity> people, const LegMuscles& choice, std::uint32_t ticks);

 private:
  void warm_people(const MuscleScene& scene, const LegMuscles& choice, std::uint32_t then);

  World world_;
  Schedule schedule_;
  std::vector<Sleeper> steady_;
  std::vector<Entity> people_, rows_;
  WakingWork work_;
};

}  // namespace mobil::inline v0_3
