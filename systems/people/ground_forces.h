#pragma once
// Ground reaction and joint moments (mobil/forces.h) of people: switching them, and the system for posed people.

#include <span>

#include <mobil/components/body.h>
#include <mobil/components/pose.h>
#include <mobil/engine/jobs.h>
#include <mobil/engine/world.h>
#include <mobil/forces.h>

namespace mobil::inline v0_3 {

/// Returns true if a person has forces, or will have them on waking.
bool has_forces(const World& world, Entity person);
/// Switches forces on or off for awake people who have a pose, each named once. Changes all or none: returns
/// Status::stale_entity for stale handles, and leaves everything unchanged if memory runs out.
Status set_forces(World& world, const Jobs& jobs, std::span<const Entity> people, bool on);
/// Clears the pose history of a posed person with forces after a jump. Motion is known again from the third tick on.
void clear_pose_history(World& world, Entity person);

/// Computes forces of posed people at the instant of the last tick's pose. Accelerations are included if the poses
/// before and after it are known; if not, people are taken to be at rest. The ground is level, at the lower sole.
void press_posed(const BodySize<Lanes<float>>& size, const Pose<Lanes<float>>& pose, const Feet<Lanes<float>>& feet,
                 PoseHistory<Lanes<float>>& past, float tick_s, GroundReaction<Lanes<float>>& ground,
                 JointMoments<Lanes<float>>& moments);

}  // namespace mobil::inline v0_3
