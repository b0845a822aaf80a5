#pragma once
// The forces of a walk (paper, section 4.3): an effect; who lacks these components pays nothing.

#include "components/lanes.h"

namespace mobil {

/// What the ground does to each foot, world frame: force (N) and the centre of pressure it acts at (m, on the ground);
/// zero force where the foot is in the air. Index 0 right, 1 left.
template <class F>
struct GroundReaction {
  Vec3<F> force_n[2];
  Vec3<F> centre_m[2];
};

/// Internal sagittal moments, N m: hip and knee extensor positive, ankle plantarflexor positive. Index 0 right, 1 left.
template <class F>
struct JointMoments {
  F hip_nm[2], knee_nm[2], ankle_nm[2];
};

}  // namespace mobil
