#pragma once
// How high a foot must be lifted on its way over uneven ground.

#include <span>

namespace mobil::inline v0_3 {

/// How much higher than straight from one foothold to the next the foot passes, m, early and late in its swing
/// (`swing_lift`).
struct FootLift {
  float early_m = 0, late_m = 0;
};

/// No ground is higher or lower.
inline constexpr float highest_ground_m = 1e5F;
/// No foot is lifted further.
inline constexpr float max_lift_m = 0.4F;

/// By how much a point of the foot is too low at a part of the swing's time, between 0 and 1.
struct TooLow {
  float part, by_m;
};

/// A small lift after which nothing is too low, or hardly; each at most `max_lift_m`.
FootLift lift_of(std::span<const TooLow> points);

}  // namespace mobil::inline v0_3
