#pragma once
// State of the skeleton in this tick, written by kinematics.

#include <mobil/components/lanes.h>
#include <mobil/components/segments.h>

namespace mobil::inline v0_3 {

/// World position (m) of each segment's origin and its world rotation. Right-handed, +Y up; a person walking with
/// heading 0 goes toward +Z with +X to the left. Identity rotations are the anatomical position.
template <class F>
struct Pose {
  Vec3<F> position_m[segment_count];
  Quat<F> rotation[segment_count];
};

/// Joint angles in rad, index 0 right, 1 left. Flexion and dorsiflexion are positive. Hip flexion is measured from the
/// pelvis, tilt included. Pelvis rotation is positive with the right side forward, list with the right side up, tilt to
/// the front.
template <class F>
struct JointAngles {
  F pelvis_rotation, pelvis_list, pelvis_tilt;
  F hip_flexion[2], knee_flexion[2], ankle_dorsiflexion[2];
  F shoulder_flexion[2], elbow_flexion[2];
};

/// Points of each foot's sole in the world (m): under the heel, under the ball (toe joint), under the tips of the toes;
/// index 0 right, 1 left. `phase`: 0–1 over that side's gait cycle, 0 at its heel strike.
template <class F>
struct Feet {
  Vec3<F> heel_m[2], toe_m[2], tip_m[2];
  F phase[2];
};

/// Whole-body centre of mass in the world, m.
template <class F>
struct CentreOfMass {
  Vec3<F> position_m;
};

}  // namespace mobil::inline v0_3
