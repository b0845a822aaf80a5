#pragma once
// One muscle that begins or changes. Part of the front door.

#include <cstdint>
#include <deque>

#include "engine/world.h"
#include "systems/simulation_lines.h"
#include "systems/simulation_motion.h"
#include "systems/simulation_muscles.h"

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

/// What a person's muscle is to be. Where it `goes_on`, so does what is shown, whatever the methods; else full methods
/// take the fields of one another as they are, and a belly that was not there before begins at rest.
struct MuscleChange {
  Entity human;
  Side side;
  const Belly& belly;
  const LegMuscles& choice;
  bool goes_on;
  std::uint32_t tick;
  float tick_s;
};

/// Whole ticks until nothing is left of what fades, up to rounding.
std::uint32_t fade_ticks(float tick_s);

/// `muscle` becomes an entity of just the parts that its method needs, or a new one where it is stale.
void make_muscle(World& world, MuscleWork& work, const MuscleChange& change, Entity& muscle);

}  // namespace mobil
