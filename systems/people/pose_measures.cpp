#include "systems/people/pose_measures.h"

#include <cmath>
#include <tuple>

#include <mobil/anthropometry.h>
#include <mobil/components/muscle.h>
#include <mobil/engine/geometry.h>
#include "assets/body/body_scales.h"
#include "assets/body/column.h"

namespace mobil::inline v0_3 {

using namespace geometry;

double twist_about_x(const Quat<double>& rotation) {
  return 2 * std::atan2(rotation.w < 0 ? -rotation.x : rotation.x, std::abs(rotation.w));
}

JointAngles<float> joint_angles(const Pose<float>& pose) {
  using enum Segment;
  const auto of = [&](Segment s) { return to_double(pose.rotation[index(s)]); };
  /// Returns the backward rotation of the lower segment about the upper one's x axis.
  const auto turned = [&](Segment upper, Segment lower) {
    return static_cast<float>(twist_about_x(product(conjugate(of(upper)), of(lower))));
  };
  JointAngles<float> angles{};
  // The pelvis rotates about y, then z, then x.
  const auto [to_left, up, ahead] = columns(of(pelvis));
  const Vec chest_to_left = columns(of(T1))[0];
  const auto heading = [](const Vec& left_axis) { return std::atan2(-left_axis.z, left_axis.x); };
  angles.pelvis_rotation = static_cast<float>(std::remainder(heading(to_left) - heading(chest_to_left), 2 * M_PI));
  angles.pelvis_list = static_cast<float>(-std::asin(std::fmax(-1, std::fmin(1, to_left.y))));
  angles.pelvis_tilt = static_cast<float>(std::atan2(-ahead.y, up.y) + neutral_tilt);
  for (const Side side : {Side::right, Side::left}) {
    const auto own = [side](Segment s) { return on_side(s, side); };
    angles.hip_flexion[side] = static_cast<float>(neutral_tilt) - turned(pelvis, own(thigh_right));
    angles.knee_flexion[side] = turned(own(thigh_right), own(shank_right));
    angles.ankle_dorsiflexion[side] = -turned(own(shank_right), own(foot_right));
    angles.shoulder_flexion[side] = -turned(T1, own(upper_arm_right));
    angles.elbow_flexion[side] = -turned(own(upper_arm_right), own(forearm_right));
  }
  return angles;
}

void move_mass_along_limbs(const BodySize<Lanes<float>>& size, const LimbLengths<Lanes<float>>& limbs,
                           const Pose<Lanes<float>>& pose, CentreOfMass<Lanes<float>>& centre) {
  using enum Segment;
  using Size = BodySize<Lanes<float>>;
  const std::tuple<Segment, Lanes<float> Size::*, Lanes<float> Size::*, const Lanes<float>&> bones[] = {
      {thigh_right, &Size::leg_scale_m, &Size::thigh_mass, limbs.thigh_m},
      {shank_right, &Size::leg_scale_m, &Size::shank_mass, limbs.shank_m},
      {upper_arm_right, &Size::arm_scale_m, &Size::upper_arm_mass, limbs.upper_arm_m},
      {forearm_right, &Size::arm_scale_m, &Size::forearm_mass, limbs.forearm_m}};
  for (const auto& [right_one, scale, mass, length_m] : bones) {
    for (const Side side : {Side::right, Side::left}) {
      const std::size_t s = index(on_side(right_one, side));
      const auto tip = static_cast<float>(unit_body.tip[s].y),
                 part = static_cast<float>(unit_body.centre_of_mass[s].y) / tip;
      const auto share = static_cast<float>(unit_body.mass_share[s]);
      const Quat<Lanes<float>>& q = pose.rotation[s];
      for (std::size_t l = 0; l < lane_count; ++l) {
        if (length_m[l] == 0) continue;
        // Along the bone's own y axis, down.
        const float by = share * (size.*mass)[l] * part * (length_m[l] + tip * (size.*scale)[l]);
        centre.position_m.x[l] -= by * 2 * (q.x[l] * q.y[l] - q.w[l] * q.z[l]);
        centre.position_m.y[l] -= by * (1 - 2 * (q.x[l] * q.x[l] + q.z[l] * q.z[l]));
        centre.position_m.z[l] -= by * 2 * (q.y[l] * q.z[l] + q.w[l] * q.x[l]);
      }
    }
  }
}

Feet<float> sole_points(float leg_scale_m, const Pose<float>& pose) {
  namespace f = fraction;
  Feet<float> feet{};
  for (const Side side : {Side::right, Side::left}) {
    const auto point = [&](Segment segment, double up, double forward) {
      const std::size_t s = index(on_side(segment, side));
      const auto height = static_cast<double>(leg_scale_m);
      return to_float(to_double(pose.position_m[s]) +
                      rotated(to_double(pose.rotation[s]), {0, height * up, height * forward}));
    };
    feet.heel_m[side] = point(Segment::foot_right, -f::ankle_height, -f::heel_back);
    feet.toe_m[side] = point(Segment::toes_right, -f::toe_joint_height, 0);
    feet.tip_m[side] = point(Segment::toes_right, -f::toe_joint_height, f::toes_length);
  }
  return feet;
}

}  // namespace mobil::inline v0_3
