#pragma once
// The effect of ground reaction and joint moments (mobil/forces.h) on one person.

#include <span>

#include <mobil/components/body.h>
#include <mobil/components/pose.h>
#include <mobil/engine/jobs.h>
#include <mobil/engine/world.h>
#include <mobil/forces.h>

namespace mobil::inline v0_3 {

/// Or will have, on waking.
bool has_forces(const World& world, Entity person);
/// From now on, or no more; of people who are awake and whole, each named once. All of them, or nobody: stale handles
/// answer Status::stale_entity, and where memory runs out nothing has changed.
Status set_forces(World& world, const Jobs& jobs, std::span<const Entity> people, bool on);
/// A posed person who has them has jumped: how the pose moves is known from the third tick on.
void clear_pose_history(World& world, Entity person);

/// Of people whose host animates them, at the instant of the last tick's pose: where the poses before and after it are
/// known, too, with what they accelerate, else as if at rest. The ground is level and as high as the lower sole.
void press_posed(const BodySize<Lanes<float>>& size, const Pose<Lanes<float>>& pose, const Feet<Lanes<float>>& feet,
                 PoseHistory<Lanes<float>>& past, float tick_s, GroundReaction<Lanes<float>>& ground,
                 JointMoments<Lanes<float>>& moments);

}  // namespace mobil::inline v0_3
