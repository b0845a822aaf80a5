#pragma once
// Who is beyond a limit of ground, joints or pelvis while they stop, start, turn or change speed or style. Steady walks
// keep all limits, and so do the stops, turns and changes of speed that are looked at ahead
// (systems/people/style_limits.h); what is left is counted and can be asked for.

#include <string>
#include <vector>

#include "components/body.h"
#include "components/gait.h"
#include "engine/access.h"
#include "engine/entity.h"
#include "engine/world.h"
#include "systems/kinematics/step_bounds.h"

namespace mobil {

/// Tag of a Tally: people beyond a limit in the tick.
struct BeyondLimits {};

/// One limit that a walker is beyond, on level ground.
struct BrokenLimit {
  WalkBound bound;
  float value;  // m, rad or m/s²: how far they are
};
/// "a knee is bent by 146 deg; the limit is 143.8".
std::string described(const BrokenLimit& broken);

/// Counts who is beyond a limit now. Looked at is whose step is not their steady one, and whose style is not near the
/// usual one (`is_near_usual`) or who turns one way and at once the other: of 24 000 others nobody was more than 0.5°
/// or 1 m/s² beyond a limit in ten seconds of random turns, stops and changes of speed. How hard the pelvis is shaken
/// shows from 1/30 s after a heel strike on.
void count_beyond_limits(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                         const GaitState<Lanes<float>>& state, const Gait<Lanes<float>>& wanted, const Rows& rows,
                         Tally<BeyondLimits> beyond);

/// What limits a walker is beyond now, whatever their style and step; none for those who sleep or are posed.
std::vector<BrokenLimit> broken_limits(const World& world, Entity person);

}  // namespace mobil
