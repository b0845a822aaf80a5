#pragma once
// The leg as its skin has it: straight along thigh and shank, turning step by step at hip, knee and ankle.

#include <array>
#include <cstddef>

#include "assets/skin/body_skin.h"
#include "components/pose.h"

namespace mobil {

/// Steps of a joint's bend.
inline constexpr std::size_t bend_rings = 16;

/// The rings of one joint, each turned about its centre: the first as the segment below, the last as the one above.
struct JointRings {
  Vec3<float> centre_m;
  float low_m, high_m;  // the first and the last ring's height over the centre, below it under 0
  /// x, y and z of the rings' axes (to the left, up, to the front).
  std::array<std::array<std::array<float, bend_rings + 1>, 3>, 3> axis;

  float height_m(std::size_t ring) const {
    return low_m + (high_m - low_m) * static_cast<float>(ring) / static_cast<float>(bend_rings);
  }
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

}  // namespace mobil
