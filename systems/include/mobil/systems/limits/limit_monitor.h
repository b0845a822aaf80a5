#pragma once
// People who are beyond a limit of ground, joints or pelvis while they stop, start, turn or change speed or style.
// Steady walks keep all limits, and so do the stops, turns and changes of speed that are looked at ahead
// (mobil/systems/limits/style_limits.h). A system counts the people who still go beyond a limit, and a query names the
// limits.

#include <string>
#include <vector>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/engine/access.h>
#include <mobil/engine/entity.h>
#include <mobil/engine/world.h>
#include <mobil/systems/gait/step_bounds.h>

namespace mobil::inline v0_3 {

/// Tag of a Tally: people beyond a limit in the tick.
struct LimitViolations {};

/// One limit that a walker is beyond, on level ground.
struct LimitViolation {
  WalkBound bound;
  float value;  // m, rad or m/s²: how far they are
};
/// "a knee is bent by 146 deg; the limit is 143.8".
std::string described(const LimitViolation& broken);

/// Counts the people who are beyond a limit now. The system looks at a walker
///   who turns one way and at once the other;
///   or whose step is not followed by its mirror image, if their style is far from the usual one (`is_near_usual`), or
///   their steps are unusually long or short, or they change style.
/// All others keep the limits, or nearly: of 24 000, in ten seconds of random turns, stops and changes of speed, one
/// hip was 1° beyond and a few pelves 1 m/s². The system does not count sleepers, nor how hard the pelvis is shaken
/// within 1/30 s of a heel strike, nor the one step in which a far style gives way to a near one together with a turn
/// or a change of speed.
void count_limit_violations(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                            const GaitState<Lanes<float>>& state, const Gait<Lanes<float>>& wanted, const Rows& rows,
                            Tally<LimitViolations> beyond);

/// The limits that a walker is beyond now, whatever their style and step; none for those who sleep or are posed, and
/// for a stale handle.
std::vector<LimitViolation> limit_violations(const World& world, Entity person);

}  // namespace mobil::inline v0_3
