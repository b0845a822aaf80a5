#pragma once
// Modules (mobil/engine/module.h) of walkers, of forces from the ground, and of the skeleton that all people have.

#include <mobil/engine/module.h>

namespace mobil::inline v0_3 {

/// Returns the module of gait and kinematics: from StepPlan and GaitState to Pose, JointAngles, Feet and CentreOfMass.
Module walking_module();
/// Returns the module of ground reaction and joint moments: walkers with BodyMotion, posed people with PoseHistory.
Module forces_module();
/// Returns the module common to posed people and walkers: BodySize, Pose, and both legs as published for muscles.
Module skeleton_module();

}  // namespace mobil::inline v0_3
