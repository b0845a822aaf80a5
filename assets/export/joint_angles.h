#pragma once
// Joint rotations as three angles, which older formats have instead of quaternions.

#include <vector>

#include "assets/export/skeleton_keys.h"
#include "engine/eigen.h"

namespace mobil::inline v0_3 {

/// R = Rx(x) · Rz(z) · Ry(y): about the parent's x axis, then about z, then about the segment's own y. Flexion is thus
/// first and the turn along the bone last, and only a z of ±90° has no unique solution. rad.
struct JointTurn {
  double x, z, y;
};

/// Returns the angles of each rotation of a joint over time, without jumps of a whole turn. Each is the one of two
/// solutions that is next to the frame before (within ±90° of z at first).
std::vector<JointTurn> joint_turns(const std::vector<Eigen::Quaterniond>& rotation);

/// Returns the rotation of `child` relative to `parent`, at each frame.
std::vector<Eigen::Quaterniond> turned_against(const SkeletonKeys& skeleton, Segment parent, Segment child);

}  // namespace mobil::inline v0_3
