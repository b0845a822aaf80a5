#pragma once
// Scales height and mass to the 48 segments. Lengths are fractions of stature (Drillis & Contini 1966, the figure in
// Winter). Centres of mass of the legs are Dempster's, tabulated by Winter; of the arms, de Leva's from their far ends.
// Masses are in assets/body/segment_masses.h.

#include <array>
#include <cstddef>

#include <mobil/components/body.h>
#include <mobil/components/pose.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// A body of height 1 m and mass 1 kg. Others are this one scaled by height and mass, so a kernel can combine the table
/// with BodySize. Frames as in mobil/components/body.h; lengths are fractions of height, masses of body mass.
struct UnitBody {
  /// Origin of each segment in its parent's frame; for the pelvis, its position above the ground when standing.
  std::array<Vec3<double>, segment_count> joint_offset;
  std::array<Vec3<double>, segment_count> centre_of_mass;
  std::array<Vec3<double>, segment_count> tip;
  /// Share of each segment in the mass of its group (assets/body/segment_masses.h).
  std::array<double, segment_count> mass_share;
};

namespace fraction {
/// Segment lengths, heights above the sole and distances from the median plane, as fractions of height (frames:
/// mobil/components/body.h).
inline constexpr double thigh = 0.245, shank = 0.246, ankle_height = 0.039;
inline constexpr double hip_height = thigh + shank + ankle_height;
inline constexpr double hip_half_spacing = 0.046;
inline constexpr double foot_length = 0.152;
/// Distances along the sole from the ankle to the point under the heel (backward) and under the ball (forward).
inline constexpr double heel_back = 0.034, ball_forward = 0.078, toes_length = foot_length - heel_back - ball_forward;
inline constexpr double toe_joint_height = 0.008;
inline constexpr double heel_radius = 0.030 / 1.75;  // the heel rolls on a round rim
inline constexpr double shoulder_height = 0.818, shoulder_half_spacing = 0.100;
inline constexpr double upper_arm = 0.186, forearm = 0.146, hand = 0.108;
/// Offset of the kneecap's centre from the knee's with the knee straight. It is below the knee, as measured on the leg
/// after which the bones are drawn; its ligament is then as long as theirs.
inline constexpr double patella_forward = 0.027, patella_up = -0.009;
}  // namespace fraction

/// Share of the knee's flexion by which the kneecap slides round the knee with the shank. Its ligament then keeps its
/// length within a seventh.
inline constexpr float kneecap_part = 0.9F;

/// Returns the table of proportions.
constexpr UnitBody make_unit_body();

/// Returns a request for the median body of that sex and age, or one that deviates from it. Deviations are standard
/// scores of stature and of body mass index. Below 18 years they refer to the CDC growth charts of 2000. From 20 years
/// on, statures are 1.757 ± 0.069 m (men) and 1.629 ± 0.064 m (women), less the height lost with age (Sorkin, Muller &
/// Andres, Am. J. Epidemiol. 150, 1999). Body mass indices are 24.6 and 23.6 kg/m² at 30 years, with deviations of
/// 0.145 and 0.160 of their logarithm, and grow by 0.35 % a year to 65. The request is not checked: numbers that are
/// not finite and deviations beyond ±4.5 give a body that `make_body` refuses, or one at the limits.
BodyRequest typical_body(Sex sex, float age_y, float height_z = 0, float mass_index_z = 0);

/// Builds a body of the requested height, mass and age. Masses add up to mass_kg without rounding error; the column's
/// offsets add up to the stature if the legs are in proportion. Fails on an age outside 6–95 years, a height outside
/// `living_height_m`, a mass that no real body of that height and age has (`living_mass_kg`), a biotype outside 0.1–12,
/// or a limb out of range; no number can be NaN. If height, mass, biotype and constitution contradict each other less
/// grossly, one is adjusted and `composition` notes it.
Result<Body> make_body(const BodyRequest& request);
/// Returns the limb lengths of a body, requested or by proportion.
LimbLengths<float> limb_lengths(const Body& body);
/// Returns the inertia of a segment about its centre of mass and its own axes, which are principal axes, kg m². Fat and
/// muscle do not thicken a segment: inertia grows with mass and with the square of height
/// (assets/body/segment_inertia.h has the sources).
Vec3<double> segment_inertia_kg_m2(const Body& body, Segment segment);
/// Returns the anatomical position: standing at the origin facing +Z, all rotations identity.
Pose<float> standing_pose(const Body& body);
/// Checks a request without building the body. Fails with the errors of `make_body`.
Result<void> check_body(const BodyRequest& request);

constexpr UnitBody make_unit_body() {
  using enum Segment;
  namespace f = fraction;
  UnitBody b{};
  auto at = [](Segment s) { return index(s); };

  // The column: height above the ground and forward offset of each joint, L5/S1 up to the atlanto-occipital joint.
  constexpr std::array<double, 25> height = {0.5850, 0.6050, 0.6250, 0.6450, 0.6650, 0.6850, 0.7010, 0.7165, 0.7315,
                                             0.7460, 0.7600, 0.7740, 0.7875, 0.8010, 0.8140, 0.8270, 0.8395, 0.8520,
                                             0.8630, 0.8740, 0.8850, 0.8960, 0.9070, 0.9175, 0.9280};
  constexpr std::array<double, 25> forward = {-0.0180, -0.0130, -0.0100, -0.0095, -0.0115, -0.0155, -0.0205,
                                              -0.0260, -0.0310, -0.0350, -0.0375, -0.0390, -0.0392, -0.0382,
                                              -0.0360, -0.0330, -0.0290, -0.0240, -0.0185, -0.0140, -0.0105,
                                              -0.0080, -0.0065, -0.0055, -0.0050};
  b.joint_offset[at(pelvis)] = {0, f::hip_height, 0};
  for (std::size_t i = 0; i < height.size(); ++i) {
    const double below = i == 0 ? f::hip_height : height[i - 1];
    const double behind = i == 0 ? 0.0 : forward[i - 1];
    const std::size_t s = at(L5) + i;
    b.joint_offset[s] = {0, height[i] - below, forward[i] - behind};
    b.tip[s - 1] = b.joint_offset[s];
  }
  b.tip[at(head)] = {0, 1.0 - height.back(), 0};

  // Within the trunk, masses are as Dempster's: pelvis .142, abdomen .139 over five lumbar vertebrae, thorax .216 over
  // twelve thoracic ones less the clavicles, head and neck .081. The mass of a slice is in front of its vertebra.
  constexpr double clavicle_mass = 0.003, cervical_mass = 0.012, head_and_neck = 0.081;
  constexpr double lumbar = 0.139 / 5, thoracic = (0.216 - 2 * clavicle_mass) / 12;
  constexpr double lower_trunk = 0.142 + 2 * lumbar, middle_trunk = 3 * lumbar + 3 * thoracic,
                   upper_trunk = 9 * thoracic + 2 * clavicle_mass;
  b.mass_share[at(pelvis)] = 0.142 / lower_trunk;
  b.centre_of_mass[at(pelvis)] = {0, 0.020, -0.004};
  for (std::size_t i = 0; i < 24; ++i) {
    const std::size_t s = at(L5) + i;
    const double middle = 0.5 * b.tip[s].y;
    if (i < 5) {
      b.mass_share[s] = lumbar / (i < 2 ? lower_trunk : middle_trunk);
      b.centre_of_mass[s] = {0, middle, 0.016};
    } else if (i < 17) {
      b.mass_share[s] = thoracic / (i < 8 ? middle_trunk : upper_trunk);
      b.centre_of_mass[s] = {0, middle, 0.036};
    } else {
      b.mass_share[s] = cervical_mass / 7 / head_and_neck;
      b.centre_of_mass[s] = {0, middle, 0.010};
    }
  }
  b.mass_share[at(head)] = 1 - cervical_mass / head_and_neck;
  b.centre_of_mass[at(head)] = {0, 0.014, 0.008};

  for (std::size_t side = 0; side < 2; ++side) {
    const double out = side == Side::right ? -1.0 : 1.0;  // +X is left
    auto of = [&](Segment s) { return index(on_side(s, side)); };
    constexpr double patella_share = 0.012, toes_share = 0.172, hand_share = 0.28, fingers_share = 0.093,
                     thumb_share = 0.023;

    b.joint_offset[of(thigh_right)] = {out * f::hip_half_spacing, 0, 0};
    b.tip[of(thigh_right)] = {0, -f::thigh, 0};
    b.mass_share[of(thigh_right)] = 1 - patella_share;
    b.centre_of_mass[of(thigh_right)] = {0, -0.433 * f::thigh, 0};
    b.joint_offset[of(patella_right)] = {0, -f::thigh + f::patella_up, f::patella_forward};
    b.tip[of(patella_right)] = {0, -0.012, 0};
    b.mass_share[of(patella_right)] = patella_share;
    b.joint_offset[of(shank_right)] = {0, -f::thigh, 0};
    b.tip[of(shank_right)] = {0, -f::shank, 0};
    b.mass_share[of(shank_right)] = 1;
    b.centre_of_mass[of(shank_right)] = {0, -0.433 * f::shank, 0};
    b.joint_offset[of(foot_right)] = {0, -f::shank, 0};
    b.tip[of(foot_right)] = {0, f::toe_joint_height - f::ankle_height, f::ball_forward};
    b.mass_share[of(foot_right)] = 1 - toes_share;
    b.centre_of_mass[of(foot_right)] = {0, -0.5 * f::ankle_height, 0.35 * f::ball_forward};
    b.joint_offset[of(toes_right)] = b.tip[of(foot_right)];
    b.tip[of(toes_right)] = {0, 0, f::toes_length};
    b.mass_share[of(toes_right)] = toes_share;
    b.centre_of_mass[of(toes_right)] = {0, 0, 0.4 * f::toes_length};

    // Arms hang on the sternal end of the clavicle, in front of T1.
    constexpr double t1_height = height[16], t1_forward = forward[16];
    constexpr double sternal_height = 0.815, sternal_out = 0.012, sternal_forward = 0.022;
    b.joint_offset[of(clavicle_right)] = {out * sternal_out, sternal_height - t1_height, sternal_forward - t1_forward};
    b.joint_offset[of(upper_arm_right)] = {out * (f::shoulder_half_spacing - sternal_out),
                                           f::shoulder_height - sternal_height, -0.012 - sternal_forward};
    b.tip[of(clavicle_right)] = b.joint_offset[of(upper_arm_right)];
    b.mass_share[of(clavicle_right)] = clavicle_mass / upper_trunk;
    const Vec3<double> c = b.tip[of(clavicle_right)];
    b.centre_of_mass[of(clavicle_right)] = {0.5 * c.x, 0.5 * c.y, 0.5 * c.z};
    b.tip[of(upper_arm_right)] = {0, -f::upper_arm, 0};
    b.mass_share[of(upper_arm_right)] = 1;
    b.centre_of_mass[of(upper_arm_right)] = {0, -0.645 * f::upper_arm, 0};
    b.joint_offset[of(forearm_right)] = b.tip[of(upper_arm_right)];
    b.tip[of(forearm_right)] = {0, -f::forearm, 0};
    b.mass_share[of(forearm_right)] = 1 - hand_share;
    b.centre_of_mass[of(forearm_right)] = {0, -0.445 * f::forearm, 0};
    constexpr double palm = 0.5 * f::hand;
    b.joint_offset[of(hand_right)] = b.tip[of(forearm_right)];
    b.tip[of(hand_right)] = {0, -palm, 0};
    b.mass_share[of(hand_right)] = hand_share - fingers_share - thumb_share;
    b.centre_of_mass[of(hand_right)] = {0, -0.506 * palm, 0};
    b.joint_offset[of(fingers_right)] = b.tip[of(hand_right)];
    b.tip[of(fingers_right)] = {0, -(f::hand - palm), 0};
    b.mass_share[of(fingers_right)] = fingers_share;
    b.centre_of_mass[of(fingers_right)] = {0, -0.4 * (f::hand - palm), 0};
    b.joint_offset[of(thumb_right)] = {out * 0.014, -0.015, 0.004};  // palms forward: thumbs outward
    b.tip[of(thumb_right)] = {0, -0.036, 0};
    b.mass_share[of(thumb_right)] = thumb_share;
    b.centre_of_mass[of(thumb_right)] = {0, -0.015, 0};
  }
  return b;
}

/// Table of proportions from which every body is scaled.
inline constexpr UnitBody unit_body = make_unit_body();

}  // namespace mobil::inline v0_3
