#pragma once
// Finds walkers who violate a limit of ground, joints or pelvis while they stop, start, turn or change speed or style.
// Steady walks keep all limits, and so do the stops, turns and changes of speed that are checked in advance
// (mobil/systems/limits/style_limits.h). A system counts the remaining violations, and a query returns the limits.

#include <string>
#include <vector>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/components/step_plan.h>
#include <mobil/engine/access.h>
#include <mobil/engine/entity.h>
#include <mobil/engine/world.h>
#include <mobil/systems/gait/step_bounds.h>

namespace mobil::inline v0_3 {

/// Tag of a Tally that counts people beyond a limit in the tick.
struct LimitViolations {};

/// A limit that a walker violates, on level ground.
struct LimitViolation {
  WalkBound bound;
  float value;  // the walker's value, m, rad or m/s²
};
/// Returns a description, for example "a knee is bent by 146 deg; the limit is 143.8".
std::string described(const LimitViolation& broken);

/// Counts the people who are beyond a limit now. The system checks a walker
///   who turns one way and directly afterwards the other way;
///   or whose step is not followed by its mirror image, if the style is far from the usual one (`is_near_usual`), the
///   steps are unusually long or short, or the style changes.
/// All others keep the limits, or nearly: of 24 000 people in ten seconds of random turns, stops and changes of speed,
/// one hip was 1° beyond and a few pelves 1 m/s². Not counted are sleepers and accelerations of the pelvis within
/// 1/30 s of a heel strike. A step in which the style changes from far to near during a turn or a change of speed is
/// not counted either.
void count_limit_violations(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                            const GaitState<Lanes<float>>& state, const Gait<Lanes<float>>& wanted, const Rows& rows,
                            Tally<LimitViolations> beyond);

/// Returns the limits that a walker violates now, for any style and step. Empty for sleepers, posed people and stale
/// handles.
std::vector<LimitViolation> limit_violations(const World& world, Entity person);

}  // namespace mobil::inline v0_3
