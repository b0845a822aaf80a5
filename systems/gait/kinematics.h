#pragma once
// Pose of all 48 segments from the solved step and the walker's clock.

#include <mobil/components/body.h>
#include <mobil/components/footing.h>
#include <mobil/components/gait.h>
#include <mobil/components/pose.h>
#include <mobil/components/step_plan.h>

namespace mobil::inline v0_3 {

/// The block posed next, which is prefetched and never read.
struct NextWalkers {
  const StepPlan<Lanes<float>>* plan = nullptr;
  const GaitState<Lanes<float>>* state = nullptr;
  const Pose<Lanes<float>>* pose = nullptr;
  const JointAngles<Lanes<float>>* angles = nullptr;
  const Feet<Lanes<float>>* feet = nullptr;
};

/// Writes the world position and rotation of each segment, the joint angles and the feet's ground points. Hips follow
/// the step's curves, with the rotation, list, tilt and shift of `pelvis_phase` (mobil/components/step_plan.h). The
/// standing foot rotates about its planted heel or ball, and the swing foot follows its curves. Thigh and shank close
/// the chain with the knee pointing forward. The column undoes the pelvis' rotation up to the head, and each arm
/// follows the opposite leg. The function has no state of its own, so any time of any step can be posed. `footing` is
/// the ground under the feet, null on level ground. `next` can be empty.
void pose_skeleton(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                   const GaitState<Lanes<float>>& state, const Footing<Lanes<float>>* footing, Pose<Lanes<float>>& pose,
                   JointAngles<Lanes<float>>& angles, Feet<Lanes<float>>& feet, const NextWalkers& next = {});

/// Computes the centre of mass of the whole body from the masses and centres of its segments.
void centre_of_mass(const BodySize<Lanes<float>>& size, const Pose<Lanes<float>>& pose,
                    CentreOfMass<Lanes<float>>& centre);

}  // namespace mobil::inline v0_3
