#pragma once
// Placement of a foot so that no edge of a kerb or a stair is under its sole.

#include <array>
#include <cstddef>

#include <mobil/anthropometry.h>

namespace mobil::inline v0_3 {

/// The ground along a sole that is about to land: heights, m, and rise along the sole, m per m. Places are evenly
/// spaced from the heel to the toe tips, and beyond both as far as the foot can be moved, plus one more ahead. The foot
/// moves by whole places, so that heel and toes are always on queried ground.
struct SoleGround {
  static constexpr std::size_t under = 7, moves = 2, places = under + 2 * moves + 1;
  std::array<float, places> height_m, rise;

  static constexpr float back_h = static_cast<float>(fraction::heel_back);
  static constexpr float front_h = static_cast<float>(fraction::ball_forward + fraction::toes_length);
  static constexpr float apart_h = (back_h + front_h) / static_cast<float>(under - 1);
  /// Place nearest to the ankle of an unmoved foot.
  // NOLINTNEXTLINE(bugprone-incorrect-roundings): lround is not constexpr
  static constexpr std::size_t ankle = moves + static_cast<std::size_t>(back_h / apart_h + 0.5F);
  /// Distance ahead of the ankle, relative to the walker's height.
  static constexpr float ahead_h(std::size_t place) {
    return (static_cast<float>(place) - static_cast<float>(moves)) * apart_h - back_h;
  }
};

/// Maximum offset of a foothold, m.
inline constexpr float max_moved_m = 0.2F;

/// Offset of the foot ahead (negative: back), and the height there of the plane on which it stands. That is the plane
/// of the ground under the ankle, raised where heel or toes would be in the ground. `place` is under the ankle.
struct SoleFit {
  float ahead_m = 0, height_m = 0;
  std::size_t place = 0;
};

/// Returns the fit with the lowest cost of overhang over edges and of moving, on the level of the unmoved foot.
/// `height_m` is the walker's height.
SoleFit fit_sole(const SoleGround& ground, float height_m, float step_length_m);

}  // namespace mobil::inline v0_3
