#pragma once
// The effect of ground reaction and joint moments (components/forces.h) on one person.

#include <span>

#include "components/body.h"
#include "components/forces.h"
#include "components/pose.h"
#include "engine/jobs.h"
#include "engine/world.h"

namespace mobil {

/// Or will have, on waking.
bool has_forces(const World& world, Entity person);
/// From now on, or no more; of people who are awake and whole, each named once. All of them, or nobody: stale handles
/// answer Status::stale_entity, and where memory runs out nothing has changed.
Status set_forces(World& world, const Jobs& jobs, std::span<const Entity> people, bool on);
/// A posed person who has them has jumped: how the pose moves is known from the third tick on.
void forget_past(World& world, Entity person);

/// Of people whose host animates them, at the instant of the last tick's pose: where the poses before and after it are
/// known, too, with what they accelerate, else as if at rest. The ground is level and as high as the lower sole.
void press_posed(const BodySize<Lanes<float>>& size, const Pose<Lanes<float>>& pose, const Feet<Lanes<float>>& feet,
                 PosedPast<Lanes<float>>& past, float tick_s, GroundReaction<Lanes<float>>& ground,
                 JointMoments<Lanes<float>>& moments);

}  // namespace mobil
