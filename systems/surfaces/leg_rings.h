#pragma once
// A leg as its skin represents it: straight along thigh and shank, turning ring by ring at hip, knee and ankle.

#include <array>
#include <cstddef>

#include <mobil/assets/surfaces/body_skin.h>
#include <mobil/components/pose.h>

namespace mobil::inline v0_3 {

/// Rings of a joint's bend.
inline constexpr std::size_t bend_rings = 16;

/// Rings of one joint. Each is turned about the centre a little further than the one below; the last has the rotation
/// of the upper segment.
struct JointRings {
  Vec3<float> centre_m;
  float low_m, high_m;  // heights over the centre where the bend begins and of its last ring; negative below
  /// Axes (to the left, up, to the front) of the rings, x, y and z of each, and of the segment below.
  alignas(64) float axis[3][3][bend_rings];
  float height_m[bend_rings];  // of each ring over the centre
  std::array<Vec3<float>, 3> below;
};

/// One leg in a pose; world, m.
struct LegRings {
  JointRings hip, knee, ankle;  // the ankle's as its skin bends in front
  float thigh_m, shank_m;
  float out;                               // 1 on the right, −1 on the left: side to which a leg's angles grow
  std::array<float, leg_stations> curved;  // bend of the line at each station, rad/m; negative towards the front
  std::array<float, leg_angles> inner;     // 1 behind the leg, −1 at its front
};

/// Returns the rings of one leg in a pose (world, m). `lengths` is as in SkinShape.
LegRings leg_rings(const BodySkin& skin, const Pose<float>& pose, float lengths, Side side);

}  // namespace mobil::inline v0_3
