#include "systems/people/pose_measures.h"

#include <cmath>

#include "assets/body/anthropometry.h"
#include "components/muscle.h"
#include "engine/geometry.h"

namespace mobil {

using namespace geometry;

double twist_about_x(const Quat<double>& rotation) {
  return 2 * std::atan2(rotation.w < 0 ? -rotation.x : rotation.x, std::abs(rotation.w));
}

JointAngles<float> joint_angles(const Pose<float>& pose) {
  using enum Segment;
  const auto of = [&](Segment s) { return to_double(pose.rotation[index(s)]); };
  /// How far the lower segment is turned about the upper one's x axis: backward.
  const auto turned = [&](Segment upper, Segment lower) {
    return static_cast<float>(twist_about_x(product(conjugate(of(upper)), of(lower))));
  };
  JointAngles<float> angles{};
  // The pelvis is turned about y, then z, then x.
  const auto [to_left, up, ahead] = columns(of(pelvis));
  const Vec chest_to_left = columns(of(T1))[0];
  const auto heading = [](const Vec& left_axis) { return std::atan2(-left_axis.z, left_axis.x); };
  angles.pelvis_rotation = static_cast<float>(std::remainder(heading(to_left) - heading(chest_to_left), 2 * M_PI));
  angles.pelvis_list = static_cast<float>(-std::asin(std::fmax(-1, std::fmin(1, to_left.y))));
  angles.pelvis_tilt = static_cast<float>(std::atan2(-ahead.y, up.y));
  for (const Side side : {right, left}) {
    const auto own = [side](Segment s) { return on_side(s, side); };
    angles.hip_flexion[side] = -turned(pelvis, own(thigh_right));
    angles.knee_flexion[side] = turned(own(thigh_right), own(shank_right));
    angles.ankle_dorsiflexion[side] = -turned(own(shank_right), own(foot_right));
    angles.shoulder_flexion[side] = -turned(T1, own(upper_arm_right));
    angles.elbow_flexion[side] = -turned(own(upper_arm_right), own(forearm_right));
  }
  return angles;
}

Feet<float> sole_points(float height_m, const Pose<float>& pose) {
  namespace f = fraction;
  Feet<float> feet{};
  for (const Side side : {right, left}) {
    const auto point = [&](Segment segment, double up, double forward) {
      const std::size_t s = index(on_side(segment, side));
      const auto height = static_cast<double>(height_m);
      return to_float(to_double(pose.position_m[s]) +
                      rotated(to_double(pose.rotation[s]), {0, height * up, height * forward}));
    };
    feet.heel_m[side] = point(Segment::foot_right, -f::ankle_height, -f::heel_back);
    feet.toe_m[side] = point(Segment::toes_right, -f::toe_joint_height, 0);
    feet.tip_m[side] = point(Segment::toes_right, -f::toe_joint_height, f::toes_length);
  }
  return feet;
}

}  // namespace mobil
