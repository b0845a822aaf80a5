#pragma once
// Maps of the anatomy's right leg to one body: one map a bone, agreeing at the joint centres.

#include <mobil/assets/import/anatomy_folder.h>
#include <mobil/components/body.h>
#include "engine/eigen.h"

namespace mobil::inline v0_3 {

inline Eigen::Vector3d eigen(const Vec3<float>& v) {
  return {v.x, v.y, v.z};
}

/// p ↦ to + linear·(p − from), m; the foot's also has factors along z, in front of and behind the ankle.
struct BoneMap {
  Eigen::Vector3d from = Eigen::Vector3d::Zero(), to = Eigen::Vector3d::Zero();
  Eigen::Matrix3d linear = Eigen::Matrix3d::Identity();
  double forward_factor = 1, backward_factor = 1;  // further factors along z in front of, and behind `from`

  Eigen::Vector3d operator()(const Eigen::Vector3d& p) const;
};

/// Joint centres in the world with the body in the anatomical position at x = z = 0, right side, m.
struct LegJoints {
  Eigen::Vector3d pelvis, hip, knee, patella, ankle, ball;
};

struct BoneMaps {
  BoneMap pelvis, thigh, patella, shank, foot;
  Eigen::Vector3d hip, knee, ankle;  // of the anatomy, where the maps meet
  double size = 1;                   // leg length over the anatomy's

  const BoneMap& of(Segment right_segment) const;
  /// Maps a point of a muscle that runs from one segment to another. The maps from the first to the last along the leg
  /// are blended over a few centimetres about the joints between, so each end stays on its bone.
  Eigen::Vector3d along_muscle(const Eigen::Vector3d& p, Segment origin, Segment insertion) const;
};

LegJoints leg_joints(const Body& body);

/// Returns the maps. Pelvis: hip centre on hip centre, its width by the spacing of the hip centres, height and depth by
/// the leg's length. Thigh and shank: joint centres on joint centres, turned by the smallest rotation, across by the
/// leg's length. Foot: upright, ankle on ankle, lowest point on the ground, heel and ball at the body's (within 0.9–1.1
/// of the leg's length scale). Fails on a body whose lengths are not finite and positive.
Result<BoneMaps> bone_maps(const Anatomy& anatomy, const Body& body);

}  // namespace mobil::inline v0_3
