#include "systems/terrain/ground_profile.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <mobil/components/lanes.h>
#include "systems/terrain/foot_path.h"

namespace mobil::inline v0_3 {
namespace {

/// Height of an obstacle above which a lift is needed, m. The swing clears level ground by as much.
constexpr float out_m = 0.005F;
/// Maximum lift of hanging toes beyond the obstacle, m. A larger demand is that of a foot that lands just behind an
/// edge, which no lift takes past it.
constexpr float hangs_m = 0.06F;

/// Returns the part of the way at which a place is, 0 to 1.
float along(const GroundProfile& ground, float x_m, float z_m) {
  const float x = ground.to_x_m - ground.from_x_m, z = ground.to_z_m - ground.from_z_m, length2 = x * x + z * z;
  if (!(length2 > 0)) return 0;
  const float part = ((x_m - ground.from_x_m) * x + (z_m - ground.from_z_m) * z) / length2;
  return part >= 0 ? std::min(part, 1.0F) : 0;  // 0 for NaN
}

/// Returns the lift of all points of a foot on that path over obstacles above the straight way.
FootLift more_lift(const GroundProfile& ground, const FootPath& path) {
  constexpr float clear_m = 0.01F;
  std::array<TooLow, FootPath::points * lane_count> low;
  std::size_t count = 0;
  for (const FootPath::At& at : path.at) {
    const float q = at.part * (1 - at.part), in_air = 64 * q * q * q;
    for (const Vec3<float>& p : at.point_m) {
      const float height_m = ground.at(p.x, p.z), by_m = height_m + in_air * clear_m - p.y;
      if (height_m > ground.straight_at(p.x, p.z) + out_m && by_m > 0) low[count++] = {at.part, by_m};
    }
  }
  return lift_of(std::span(low).first(count));
}

}  // namespace

float GroundProfile::at(float x_m, float z_m) const {
  constexpr float step_m = 0.05F;
  const float place = along(*this, x_m, z_m) * static_cast<float>(asked + 1);
  const auto i = std::min(static_cast<std::size_t>(place), asked);
  const float a = height_m[i], b = height_m[i + 1], beyond = place - static_cast<float>(i);
  if (std::fabs(b - a) > step_m) return beyond < 0.5F ? a : b;
  return std::lerp(a, b, beyond);
}

float GroundProfile::straight_at(float x_m, float z_m) const {
  return std::lerp(height_m.front(), height_m.back(), along(*this, x_m, z_m));
}

FootLift lift_over(const GroundProfile& ground, const BodySize<float>& size, const StepPlan<float>& plan,
                   const GaitState<float>& state, const Footing<float>& footing) {
  Footing<float> under = footing;
  under.lift_early_m = under.lift_late_m = 0;
  float max_out_m = 0;
  for (std::size_t i = 0; i < GroundProfile::asked; ++i)
    max_out_m = std::max(max_out_m, ground.height_m[i + 1] - std::lerp(ground.height_m.front(), ground.height_m.back(),
                                                                       GroundProfile::part(i)));
  if (!(plan.landing > 0) || !(max_out_m > out_m)) return {};
  const float max_m = std::min(max_out_m + hangs_m, max_lift_m);
  constexpr int rounds = 2;  // a lifted foot hangs at another angle
  for (int round = 0; round < rounds; ++round) {
    const FootLift more = more_lift(ground, foot_path(size, plan, state, under));
    under.lift_early_m = std::min(under.lift_early_m + more.early_m, max_m);
    under.lift_late_m = std::min(under.lift_late_m + more.late_m, max_m);
  }
  return {under.lift_early_m, under.lift_late_m};
}

}  // namespace mobil::inline v0_3
