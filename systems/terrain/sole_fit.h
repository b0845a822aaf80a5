#pragma once
// Where a foot comes down so that no edge, of a kerb or a stair, is under its sole.

#include <array>
#include <cstddef>

#include <mobil/anthropometry.h>

namespace mobil::inline v0_3 {

/// The ground along a sole that is about to come down: heights, m, and how much the ground rises along the sole, m per
/// m. Places lie evenly from the heel to the tips of the toes, and beyond both as far as the foot may be moved, and one
/// more ahead. It is moved from place to place, so that what is under heel and toes is known exactly.
struct SoleGround {
  static constexpr std::size_t under = 7, moves = 2, places = under + 2 * moves + 1;
  std::array<float, places> height_m, rise;

  static constexpr float back_h = static_cast<float>(fraction::heel_back);
  static constexpr float front_h = static_cast<float>(fraction::ball_forward + fraction::toes_length);
  static constexpr float apart_h = (back_h + front_h) / static_cast<float>(under - 1);
  /// The place nearest to the ankle of a foot that is not moved.
  // NOLINTNEXTLINE(bugprone-incorrect-roundings): lround is not constexpr
  static constexpr std::size_t ankle = moves + static_cast<std::size_t>(back_h / apart_h + 0.5F);
  /// Ahead of the ankle, of the walker's height.
  static constexpr float ahead_h(std::size_t place) {
    return (static_cast<float>(place) - static_cast<float>(moves)) * apart_h - back_h;
  }
};

/// No foothold is moved further, m.
inline constexpr float max_moved_m = 0.2F;

/// How far ahead the foot is put (below 0: back), and how high the plane is there that it stands on: that of the ground
/// under the ankle, raised where heel or toes would be in the ground. `place`: of the ground under the ankle.
struct SoleFit {
  float ahead_m = 0, height_m = 0;
  std::size_t place = 0;
};

/// The least move after which as little as may be of the sole reaches over an edge, on the level where it would stand
/// unmoved. `height_m`: of the walker.
SoleFit fit_sole(const SoleGround& ground, float height_m, float step_length_m);

}  // namespace mobil::inline v0_3
