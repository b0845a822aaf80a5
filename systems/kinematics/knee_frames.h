#pragma once
// Legs as their own knees see them.

#include "components/body.h"
#include "components/gait.h"
#include "components/leg_frames.h"

namespace mobil {

/// Both legs of the pose that `pose_skeleton` makes of a step (systems/kinematics/kinematics.h), right first, without
/// the pose: for muscles that nobody looks at. Places are within 5 µm of the pose's near the origin, and lose no digits
/// far from it.
void knee_frames(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                 const GaitState<Lanes<float>>& state, KneeFrame<Lanes<float>> (&leg)[2]);

}  // namespace mobil
