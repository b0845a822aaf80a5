#pragma once
// One muscle that begins or changes. Part of the front door.

#include <cstdint>
#include <deque>
#include <span>

#include "engine/world.h"
#include "systems/muscles/simulation_lines.h"
#include "systems/muscles/simulation_motion.h"
#include "systems/muscles/simulation_muscles.h"
#include "systems/people/simulation_people.h"

namespace mobil {

/// What changes share: looked up once for several muscles of a person; and who fades, first to end first.
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
  std::uint32_t tick;
  float tick_s;
};

/// Whole ticks until nothing is left of what fades, up to rounding.
std::uint32_t fade_ticks(float tick_s);

/// The entities of `own`, one for each belly, become ones of just the parts that their method needs, or new ones where
/// they are stale. Where memory runs out, all is as it was.
void make_muscles(World& world, MuscleWork& work, const MuscleChange& change, std::span<const Belly> bellies,
                  std::span<OwnMuscle> own);

}  // namespace mobil
