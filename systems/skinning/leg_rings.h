#pragma once
// The leg as its skin has it: straight above and below the knee, turning evenly between.

#include <array>
#include <cstddef>

#include "assets/skin/body_skin.h"
#include "components/pose.h"

namespace mobil {

/// Steps of the bend of a knee.
inline constexpr std::size_t bend_rings = 16;

struct LegRings {
  Vec3<float> knee_m;
  float thigh_m, shank_m;
  float bend_m;  // above and below the knee
  float out;     // 1 on the right, −1 on the left: where a leg's angles grow to
  /// x, y and z of the rings' axes (to the left, up, to the front): of the shank's first, of the thigh's last.
  std::array<std::array<std::array<float, bend_rings + 1>, 3>, 3> axis;
  std::array<float, leg_stations> curved;  // by how much the line bends there, rad/m
  std::array<float, leg_angles> inner;     // 1 in the hollow of the knee, −1 at its front

  /// How high above the knee a ring lies.
  float height_m(std::size_t ring) const {
    return bend_m * (2 * static_cast<float>(ring) / static_cast<float>(bend_rings) - 1);
  }
};

/// Of one leg in a pose (world, m); `lengths`: as of SkinShape.
LegRings leg_rings(const BodySkin& skin, const Pose<float>& pose, float lengths, Side side);

}  // namespace mobil
