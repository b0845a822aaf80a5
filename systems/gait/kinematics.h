#pragma once
// From the solved step and the walker's clock to the pose of all 48 segments.

#include <mobil/components/body.h>
#include <mobil/components/footing.h>
#include <mobil/components/gait.h>
#include <mobil/components/pose.h>

namespace mobil::inline v0_3 {

/// The block to be posed next: fetched meanwhile, never read.
struct NextWalkers {
  const StepPlan<Lanes<float>>* plan = nullptr;
  const GaitState<Lanes<float>>* state = nullptr;
  const Pose<Lanes<float>>* pose = nullptr;
  const JointAngles<Lanes<float>>* angles = nullptr;
  const Feet<Lanes<float>>* feet = nullptr;
};

/// Writes every segment's world position and rotation, the joint angles and the feet's ground points. Hips follow the
/// step's curves, turned, listed, tilted and shifted as `pelvis_phase` (mobil/components/gait.h) says; the standing
/// foot turns about its planted heel or ball, the swing foot follows its curves; thigh and shank close the chain with
/// the knee pointing forward; the column undoes the pelvis up to the head; each arm follows the opposite leg. No state
/// of its own: any time of any step may be asked. `footing`: the ground under the feet, null where it is level. `next`
/// may be empty.
void pose_skeleton(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                   const GaitState<Lanes<float>>& state, const Footing<Lanes<float>>* footing, Pose<Lanes<float>>& pose,
                   JointAngles<Lanes<float>>& angles, Feet<Lanes<float>>& feet, const NextWalkers& next = {});

/// Centre of mass of the whole body, from the masses and centres of its segments.
void centre_of_mass(const BodySize<Lanes<float>>& size, const Pose<Lanes<float>>& pose,
                    CentreOfMass<Lanes<float>>& centre);

}  // namespace mobil::inline v0_3
