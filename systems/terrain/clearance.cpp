#include "systems/terrain/clearance.h"

#include <algorithm>

#include <mobil/components/footing.h>

namespace mobil::inline v0_3 {
namespace {

float smooth(float u) {
  const float v = std::clamp(u, 0.0F, 1.0F);
  return v * v * v * (10 - 15 * v + 6 * v * v);
}

float hill(float u, float top) {
  return smooth(u / top) * (1 - smooth((u - top) / (1 - top)));
}

}  // namespace

/// Meets each point's demand in turn by the smallest change of both numbers, until all are nearly met (Kaczmarz).
FootLift lift_of(std::span<const TooLow> points) {
  constexpr int sweeps = 8;
  FootLift lift;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (const auto& [u, by_m] : points) {
      const float early = hill(u, swing_lift::early), late = hill(u, swing_lift::late);
      const float lacks = by_m - early * lift.early_m - late * lift.late_m;
      if (!(lacks > 0)) continue;
      const float per = lacks / (early * early + late * late);
      lift = {std::min(lift.early_m + per * early, max_lift_m), std::min(lift.late_m + per * late, max_lift_m)};
    }
  }
  return lift;
}

}  // namespace mobil::inline v0_3
