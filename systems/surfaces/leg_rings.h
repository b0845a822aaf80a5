#pragma once
// The leg as its skin has it: straight along thigh and shank, turning step by step at hip, knee and ankle.

#include <array>
#include <cstddef>

#include <mobil/assets/surfaces/body_skin.h>
#include <mobil/components/pose.h>

namespace mobil::inline v0_3 {

/// Steps of a joint's bend.
inline constexpr std::size_t bend_rings = 16;

/// The rings of one joint, each turned about its centre a little further from the segment below; the last as the one
/// above.
struct JointRings {
  Vec3<float> centre_m;
  float low_m, high_m;  // where the bend begins and its last ring is, over the centre; below it under 0
  /// x, y and z of the axes (to the left, up, to the front) of the rings, and of the segment below.
  alignas(64) float axis[3][3][bend_rings];
  float height_m[bend_rings];  // of each ring over the centre
  std::array<Vec3<float>, 3> below;
};

/// World, m, of one leg as a pose has it.
struct LegRings {
  JointRings hip, knee, ankle;  // the ankle's as its skin bends in front
  float thigh_m, shank_m;
  float out;                               // 1 on the right, −1 on the left: where a leg's angles grow to
  std::array<float, leg_stations> curved;  // by how much the line bends there, rad/m; below 0 towards the front
  std::array<float, leg_angles> inner;     // 1 behind the leg, −1 at its front
};

/// Of one leg in a pose (world, m); `lengths`: as of SkinShape.
LegRings leg_rings(const BodySkin& skin, const Pose<float>& pose, float lengths, Side side);

}  // namespace mobil::inline v0_3
