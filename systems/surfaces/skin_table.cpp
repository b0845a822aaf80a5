#include <mobil/systems/surfaces/skin_table.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <mobil/components/segments.h>
#include "engine/fused-inl.h"
#include "systems/surfaces/weights8-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace {

void sum_modes(const SkinTable& table, const std::array<float, skin_modes>& share, float* lift_m) {
  const hn::CappedTag<float, 16> table_tag;  // all its sizes divide the grid
  static_assert(leg_grid_points % 16 == 0);
  hn::Vec<decltype(table_tag)> all[skin_modes];
  for (std::size_t m = 0; m < skin_modes; ++m) all[m] = hn::Set(table_tag, share[m]);
  for (std::size_t n = 0; n < leg_grid_points; n += hn::Lanes(table_tag)) {
    auto sum = hn::Mul(all[0], hn::Load(table_tag, &table.mode[0][n]));
    for (std::size_t m = 1; m < skin_modes; ++m) sum = mul_add(all[m], hn::Load(table_tag, &table.mode[m][n]), sum);
    hn::StoreU(sum, table_tag, lift_m + n);
  }
}

}  // namespace
}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {
namespace {

HWY_EXPORT(sum_modes);

/// Returns the angle with the tangent y / x, for x ≥ 0 (Abramowitz and Stegun 4.4.49: to 2e-8 and rounding).
float angle_of(float y, float x) {
  constexpr std::array odd = {0.0028662257F, -0.0161657367F, 0.0429096138F, -0.0752896400F,
                              0.1065626393F, -0.1420889944F, 0.1999355085F, -0.3333314528F};
  const float high = std::abs(y), least = std::min(high, x), most = std::max(high, x);
  const float t = most > 0 ? least / most : 0, square = t * t;
  float sum = odd[0];
  for (std::size_t i = 1; i < odd.size(); ++i) sum = sum * square + odd[i];
  const float near = t + t * square * sum, angle = high > x ? 0.5F * std::numbers::pi_v<float> - near : near;
  return y < 0 ? -angle : angle;
}

/// Returns the angle about x, above 0 if the lower segment is turned back.
float bent_back(const Quat<float>& upper, const Quat<float>& lower) {
  const float w = upper.w * lower.w + upper.x * lower.x + upper.y * lower.y + upper.z * lower.z;
  const float x = upper.w * lower.x - upper.x * lower.w - upper.y * lower.z + upper.z * lower.y;
  return 2 * angle_of(w < 0 ? -x : x, std::abs(w));
}

}  // namespace

LegAngles leg_angles_of(const Pose<float>& pose, Side side) {
  const auto of = [&](Segment right) -> const Quat<float>& { return pose.rotation[index(on_side(right, side))]; };
  const Quat<float>&pelvis = pose.rotation[index(Segment::pelvis)], &thigh = of(Segment::thigh_right),
        &shank = of(Segment::shank_right), &foot = of(Segment::foot_right);
  return {-bent_back(pelvis, thigh), bent_back(thigh, shank), -bent_back(shank, foot)};
}

std::array<float, skin_terms> skin_term_values(const LegAngles& angles) {
  const float h = std::clamp(angles.hip, min_leg_angles.hip, max_leg_angles.hip),
              k = std::clamp(angles.knee, min_leg_angles.knee, max_leg_angles.knee),
              a = std::clamp(angles.ankle, min_leg_angles.ankle, max_leg_angles.ankle);
  return {1, h, k, a, h * h, k * k, a * a, h * k, k * a, k * k * k, h * k * k, k * k * a};
}

void cover_by_table(const SkinTable& table, const LegAngles& angles, std::array<float, leg_grid_points>& lift_m) {
  const std::array<float, skin_terms> value = skin_term_values(angles);
  std::array<float, skin_modes> share{};
  for (std::size_t t = 0; t < skin_terms; ++t)
    for (std::size_t m = 0; m < skin_modes; ++m) share[m] += value[t] * table.weight[t][m];
  HWY_DYNAMIC_DISPATCH(sum_modes)(table, share, lift_m.data());
}

}  // namespace mobil::inline v0_3
#endif
