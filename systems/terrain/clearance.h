#pragma once
// Lift of a foot on its way over uneven ground.

#include <span>

namespace mobil::inline v0_3 {

/// Height of the foot above the straight line between footholds, m, early and late in its swing (`swing_lift`).
struct FootLift {
  float early_m = 0, late_m = 0;
};

/// Maximum height of the ground above or below y = 0, m.
inline constexpr float highest_ground_m = 1e5F;
/// Maximum lift of a foot, m.
inline constexpr float max_lift_m = 0.4F;

/// Amount by which a point of the foot is too low at a part of the swing's time, between 0 and 1.
struct TooLow {
  float part, by_m;
};

/// Returns a small lift after which no point is too low, or hardly. Both values are at most `max_lift_m`.
FootLift lift_of(std::span<const TooLow> points);

}  // namespace mobil::inline v0_3
