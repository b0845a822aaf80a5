#pragma once
// Muscles that begin as if they had been there all along: run through their person's last ticks in a small world of
// their own.

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

/// Ticks to run through so that control points are within that of where they would be; 0 where rest is near enough.
/// Measured on 24 people of a crowd, 8/s of damping (Sleep.MusclesWarmUpToWhatIsAsked holds it): at rest 12 mm, after
/// half a second 4.1 mm, after one 0.64 mm, after 2.1 below 4 µm.
std::uint32_t warm_ticks(float within_m, double tick_s);

/// The small world, made when first needed; nothing of it is state.
class WarmingRoom {
 public:
  /// `modules`: the library's own. Takes its memory from `memory`.
  WarmingRoom(std::span<const Module> modules, std::pmr::memory_resource* memory);

  /// People whose muscles have just begun at rest, all by this choice: of those who walk steadily the muscles are as
  /// after so many ticks of that walk. Of others, and of muscles that follow moments, they stay as they are.
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
