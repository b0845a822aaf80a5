#pragma once
// Changes of existing muscles: another method, other effects, other tissue.

#include <cstdint>
#include <span>
#include <vector>

#include <mobil/engine/world.h>
#include <mobil/systems/muscles/muscle_ref.h>
#include "systems/deformation/belly_motion.h"
#include "systems/muscles/begin_muscles.h"
#include "systems/muscles/pose_history.h"

namespace mobil::inline v0_3 {

/// Scratch data that changes keep to save work; none of it is state.
struct MuscleWork {
  RecentPoses recent;
  LastReducedBelly last;
  // Tables with fades among the first `tables_seen`, and muscles whose fades ended in this tick.
  std::size_t tables_seen = 0;
  std::vector<std::size_t> fading;
  std::vector<Entity> faded;
};

/// New choice for a person's muscles. If `goes_on`, the shown displacement continues without a jump for all methods. If
/// not, full methods take over each other's fields unchanged, and a belly that did not exist starts at rest.
struct MuscleChange {
  Entity person;
  const LegMuscles& choice;
  bool goes_on;
  MuscleTime time;
};

/// Returns the whole ticks after which a fade is zero, up to rounding.
std::uint32_t fade_ticks(float tick_s);

/// Gives each muscle of `own`, one for each belly, exactly the muscle components that its method and effects need. A
/// host's components stay; stale handles are skipped. Throws std::bad_alloc if memory runs out, and changes nothing
/// then.
void change_muscles(World& world, BellyLibrary& library, MuscleWork& work, const MuscleChange& change,
                    std::span<const Belly> bellies, std::span<const MuscleRef> own);

}  // namespace mobil::inline v0_3
