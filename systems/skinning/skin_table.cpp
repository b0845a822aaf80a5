#include "systems/skinning/skin_table.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/skinning/skin_table.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "components/segments.h"
#include "engine/fused-inl.h"
#include "engine/geometry.h"
#include "systems/skinning/eight-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {
namespace {

void sum_terms(const SkinTable& table, const std::array<float, skin_terms>& value, float* lift_m) {
  constexpr EightTag tag;
  for (std::size_t n = 0; n < leg_grid_points; n += eight_lanes) {
    auto sum = hn::Mul(hn::Set(tag, value[0]), hn::Load(tag, &table.term[0][n]));
    for (std::size_t t = 1; t < skin_terms; ++t)
      sum = mul_add(hn::Set(tag, value[t]), hn::Load(tag, &table.term[t][n]), sum);
    hn::StoreU(sum, tag, lift_m + n);
  }
}

}  // namespace
}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil {
namespace {

HWY_EXPORT(sum_terms);

using namespace geometry;

/// About x, above 0 where the lower segment is turned back.
float bent_back(const Pose<float>& pose, std::size_t upper, std::size_t lower) {
  const Quat<float> joint = product(conjugate(pose.rotation[upper]), pose.rotation[lower]);
  return 2 * std::atan2(joint.w < 0 ? -joint.x : joint.x, std::abs(joint.w));
}

}  // namespace

LegAngles leg_angles_of(const Pose<float>& pose, Side side) {
  const std::size_t pelvis = index(Segment::pelvis), thigh = index(on_side(Segment::thigh_right, side)),
                    shank = index(on_side(Segment::shank_right, side)),
                    foot = index(on_side(Segment::foot_right, side));
  return {-bent_back(pose, pelvis, thigh), bent_back(pose, thigh, shank), -bent_back(pose, shank, foot)};
}

std::array<float, skin_terms> skin_term_values(const LegAngles& angles) {
  const float h = std::clamp(angles.hip, least_leg_angles.hip, most_leg_angles.hip),
              k = std::clamp(angles.knee, least_leg_angles.knee, most_leg_angles.knee),
              a = std::clamp(angles.ankle, least_leg_angles.ankle, most_leg_angles.ankle);
  return {1, h, k, a, h * h, k * k, a * a, h * k, k * a, k * k * k, h * k * k, k * k * a};
}

void cover_by_table(const SkinTable& table, const LegAngles& angles, std::array<float, leg_grid_points>& lift_m) {
  HWY_DYNAMIC_DISPATCH(sum_terms)(table, skin_term_values(angles), lift_m.data());
}

}  // namespace mobil
#endif
