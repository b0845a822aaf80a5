#pragma once
// Muscles that are there and become otherwise: another method, other effects, other tissue.

#include <cstdint>
#include <span>
#include <vector>

#include <mobil/engine/world.h>
#include <mobil/systems/muscles/muscle_ref.h>
#include "systems/deformation/belly_motion.h"
#include "systems/muscles/begin_muscles.h"
#include "systems/muscles/pose_history.h"

namespace mobil::inline v0_3 {

/// What changes keep from one to the next to save work: nothing of it is state.
struct MuscleWork {
  RecentPoses recent;
  LastReducedBelly last;
  // Tables with fades, of those seen so far; and whose fades ended after this tick.
  std::size_t tables_seen = 0;
  std::vector<std::size_t> fading;
  std::vector<Entity> faded;
};

/// What a person's muscles are to be. Where it `goes_on`, so does what is shown, whatever the methods; else full
/// methods take the fields of one another as they are, and a belly that was not there before begins at rest.
struct MuscleChange {
  Entity person;
  const LegMuscles& choice;
  bool goes_on;
  MuscleTime time;
};

/// Whole ticks until nothing is left of what fades, up to rounding.
std::uint32_t fade_ticks(float tick_s);

/// The entities of `own`, one for each belly, come to have just the muscle parts that their method and effects
/// need; a host's parts stay with them, stale handles are passed over. Where memory runs out that throws
/// std::bad_alloc, and nothing has changed.
void change_muscles(World& world, BellyLibrary& library, MuscleWork& work, const MuscleChange& change,
                    std::span<const Belly> bellies, std::span<const MuscleRef> own);

}  // namespace mobil::inline v0_3
