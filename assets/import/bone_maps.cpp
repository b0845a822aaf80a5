#include "assets/import/bone_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <mobil/engine/geometry.h>
#include "assets/import/mesh_text.h"

namespace mobil::inline v0_3 {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using geometry::smoothstep;

/// Returns the shortest rotation of one unit vector onto another. (Eigen's uses a singular value decomposition, which
/// takes six seconds to compile.)
Matrix3d shortest_turn(const Vector3d& from, const Vector3d& onto) {
  Vector3d half = from + onto;
  if (half.squaredNorm() < 1e-12) half = from.unitOrthogonal();
  half.normalize();
  const Vector3d axis = from.cross(half);
  return Eigen::Quaterniond(from.dot(half), axis.x(), axis.y(), axis.z()).toRotationMatrix();
}

/// Returns the map from the upper joint to the lower: length fitted along the axis, `across` at right angles to it.
BoneMap long_bone(const Vector3d& upper, const Vector3d& lower, const Vector3d& body_upper, const Vector3d& body_lower,
                  double across) {
  const Vector3d axis = (lower - upper).normalized(), target = (body_lower - body_upper).normalized();
  const double along = (body_lower - body_upper).norm() / (lower - upper).norm();
  const Matrix3d along_axis = axis * axis.transpose();
  const Matrix3d turn = shortest_turn(axis, target);
  BoneMap map;
  map.from = upper;
  map.to = body_upper;
  map.linear = turn * (along * along_axis + across * (Matrix3d::Identity() - along_axis));
  return map;
}

/// Points that match the ground and the body's heel and ball: the anatomy's lowest point, the back of the heel bone,
/// the lowest point of the first metatarsal.
struct FootShape {
  double lowest_y = std::numeric_limits<double>::infinity();
  double heel_z = 0, ball_z = 0;
  bool heel_found = false, ball_found = false;
};

double z_of_lowest(const SurfaceMesh& mesh) {
  const auto lowest = std::min_element(mesh.position.begin(), mesh.position.end(),
                                       [](const auto& a, const auto& b) { return a.y < b.y; });
  return lowest->z;
}

FootShape foot_shape(const Anatomy& anatomy) {
  FootShape shape;
  for (const auto& part : anatomy.part) {
    if (part.kind != AnatomyKind::bone) continue;
    if (part.origin != Segment::foot_right && part.origin != Segment::toes_right) continue;
    for (const auto& p : part.mesh.position) shape.lowest_y = std::min<double>(shape.lowest_y, p.y);
    if (begins_with(part.mesh.name, "calcaneus")) {
      const auto& p = part.mesh.position;
      shape.heel_z = std::min_element(p.begin(), p.end(), [](const auto& a, const auto& b) { return a.z < b.z; })->z;
      shape.heel_found = true;
    }
    if (begins_with(part.mesh.name, "metatarsal_1")) {
      shape.ball_z = z_of_lowest(part.mesh);
      shape.ball_found = true;
    }
  }
  return shape;
}

BoneMap foot_map(const Anatomy& anatomy, const Body& body, const Vector3d& ankle, const Vector3d& body_ankle,
                 double size) {
  const FootShape shape = foot_shape(anatomy);
  BoneMap map;
  map.from = ankle;
  map.to = body_ankle;
  const double height = ankle.y() - shape.lowest_y;
  const double up = std::isfinite(height) && height > 0.02 ? body_ankle.y() / height : size;
  map.linear = Vector3d(size, up, size).asDiagonal();
  const auto factor = [&](bool found, double mine, double wanted) {
    if (!found || std::abs(mine) < 0.005) return 1.0;
    return std::clamp(wanted / (mine * size), 0.9, 1.1);
  };
  map.forward_factor = factor(shape.ball_found, shape.ball_z - ankle.z(), static_cast<double>(body.ball_m.z));
  map.backward_factor = factor(shape.heel_found, shape.heel_z - ankle.z(), static_cast<double>(body.heel_m.z));
  return map;
}

/// Returns the place along the leg, from the hip down: 0 pelvis, 1 thigh, 2 shank, 3 foot.
int rank(Segment segment) {
  if (segment < Segment::thigh_right) return 0;  // psoas comes from a vertebra
  switch (segment) {
    case Segment::thigh_right:
      return 1;
    case Segment::patella_right:  // the muscle continues to the shank as the ligament
    case Segment::shank_right:
      return 2;
    default:
      return 3;
  }
}

}  // namespace

Vector3d BoneMap::operator()(const Vector3d& p) const {
  Vector3d d = p - from;
  constexpr double bend_m = 0.02;
  d.z() *= backward_factor + (forward_factor - backward_factor) * smoothstep(-bend_m, bend_m, d.z());
  return to + linear * d;
}

LegJoints leg_joints(const Body& body) {
  const auto offset = [&](Segment s) { return eigen(body.joint_offset_m[index(s)]); };
  LegJoints joints;
  joints.pelvis = offset(Segment::pelvis);
  joints.hip = joints.pelvis + offset(Segment::thigh_right);
  joints.knee = joints.hip + offset(Segment::shank_right);
  joints.patella = joints.hip + offset(Segment::patella_right);
  joints.ankle = joints.knee + offset(Segment::foot_right);
  joints.ball = joints.ankle + offset(Segment::toes_right);
  return joints;
}

Result<BoneMaps> bone_maps(const Anatomy& anatomy, const Body& body) {
  const LegJoints joints = leg_joints(body);
  BoneMaps maps;
  maps.hip = eigen(anatomy.landmarks.hip);
  maps.knee = eigen(anatomy.landmarks.knee);
  maps.ankle = eigen(anatomy.landmarks.ankle);
  const double thigh = (joints.knee - joints.hip).norm(), shank = (joints.ankle - joints.knee).norm();
  const double half_spacing = joints.pelvis.x() - joints.hip.x();
  for (const auto& [what, length] :
       {std::pair{"thigh length", thigh}, std::pair{"shank length", shank}, std::pair{"half hip spacing", half_spacing},
        std::pair{"ankle height", joints.ankle.y()}}) {
    if (std::isfinite(length) && length > 0.001 && length < 2) continue;
    return fail(fmt::format("body of {} m: {} is {} m, valid: 0.001 to 2; use a body made by make_body",
                            body.request.height_m, what, length));
  }
  maps.size = (thigh + shank) / ((maps.knee - maps.hip).norm() + (maps.ankle - maps.knee).norm());

  maps.pelvis.from = maps.hip;
  maps.pelvis.to = joints.hip;
  const double width = half_spacing / (anatomy.landmarks.middle_x - maps.hip.x());
  maps.pelvis.linear = Vector3d(width, maps.size, maps.size).asDiagonal();

  maps.thigh = long_bone(maps.hip, maps.knee, joints.hip, joints.knee, maps.size);
  maps.shank = long_bone(maps.knee, maps.ankle, joints.knee, joints.ankle, maps.size);
  maps.patella = maps.thigh;
  maps.foot = foot_map(anatomy, body, maps.ankle, joints.ankle, maps.size);
  return maps;
}

const BoneMap& BoneMaps::of(Segment right_segment) const {
  if (right_segment < Segment::thigh_right) return pelvis;
  switch (right_segment) {
    case Segment::thigh_right:
      return thigh;
    case Segment::patella_right:
      return patella;
    case Segment::shank_right:
      return shank;
    default:
      return foot;
  }
}

Vector3d BoneMaps::along_muscle(const Vector3d& p, Segment origin, Segment insertion) const {
  const int first = std::min(rank(origin), rank(insertion)), last = std::max(rank(origin), rank(insertion));
  // The seat bones are below the hip centre, the kneecap's ligament below the knee's: the blends begin under them.
  const double below_hip = smoothstep(0.05, 0.13, hip.y() - p.y());
  const bool over_kneecap = origin == Segment::patella_right || insertion == Segment::patella_right;
  const double below_knee =
      over_kneecap ? smoothstep(0.02, 0.06, knee.y() - p.y()) : smoothstep(-0.03, 0.03, knee.y() - p.y());
  const double below_ankle = smoothstep(-0.04, 0.02, ankle.y() - p.y());
  const std::array<double, 5> passed = {1, first < 1 ? below_hip : 1.0, below_knee, below_ankle, 0};
  Vector3d sum = Vector3d::Zero();
  constexpr std::array<const BoneMap BoneMaps::*, 4> chain = {&BoneMaps::pelvis, &BoneMaps::thigh, &BoneMaps::shank,
                                                              &BoneMaps::foot};
  for (int i = first; i <= last; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double entered = i == first ? 1 : passed[at], left = i == last ? 0 : passed[at + 1];
    const double weight = entered - left;
    if (weight != 0) sum += weight * (this->*chain[at])(p);
  }
  return sum;
}

}  // namespace mobil::inline v0_3
