#pragma once
// The skeleton as modules (mobil/engine/module.h): people who walk, what the ground does to them, and what all people
// have, also those whose host animates the skeleton.

#include <mobil/engine/module.h>

namespace mobil::inline v0_3 {

/// Gait and kinematics: from StepPlan and GaitState to Pose, JointAngles, Feet and CentreOfMass.
Module walking_module();
/// Ground reaction and joint moments of walkers who have BodyMotion, and of posed people who have PoseHistory.
Module forces_module();
/// What posed people and walkers have in common: BodySize, Pose, and both legs as their muscles look them up.
Module skeleton_module();

}  // namespace mobil::inline v0_3
