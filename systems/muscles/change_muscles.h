#pragma once
// Muscles that are there and become otherwise: another method, other effects, other tissue.

#include <cstdint>
#include <deque>
#include <span>

#include "engine/world.h"
#include "systems/deformation/belly_motion.h"
#include "systems/muscles/begin_muscles.h"
#include "systems/muscles/recent_poses.h"

namespace mobil {

/// Caches that changes share, and running fades ordered by the tick that they end at.
struct MuscleWork {
  struct Fading {
    Entity muscle;
    std::uint32_t ends;  // at that tick
  };
  RecentPoses recent;
  LastReducedBelly last;
  std::deque<Fading> fading;
};

/// What a person's muscles are to be. Where it `goes_on`, so does what is shown, whatever the methods; else full
/// methods take the fields of one another as they are, and a belly that was not there before begins at rest.
struct MuscleChange {
  Entity human;
  const LegMuscles& choice;
  bool goes_on;
  MuscleTime time;
};

/// Whole ticks until nothing is left of what fades, up to rounding.
std::uint32_t fade_ticks(float tick_s);

/// The entities of `own`, one for each belly, come to have just the muscle parts that their method and effects
/// need; a host's parts stay with them, stale handles are passed over. Where memory runs out that throws
/// std::bad_alloc, and nothing has changed.
void change_muscles(World& world, MuscleWork& work, const MuscleChange& change, std::span<const Belly> bellies,
                    std::span<const OwnMuscle> own);

}  // namespace mobil
