// Sizes on which a walk depends. See engine/wide-inl.h for how to include it.

#if defined(MOBIL_SYSTEMS_GAIT_LEG_SIZE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_GAIT_LEG_SIZE_INL_H_
#undef MOBIL_SYSTEMS_GAIT_LEG_SIZE_INL_H_
#else
#define MOBIL_SYSTEMS_GAIT_LEG_SIZE_INL_H_
#endif

#include <mobil/anthropometry.h>
#include <mobil/components/body.h>
#include "assets/body/body_scales.h"
#include "engine/wide-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

/// Scales of the legs, of the distance of the hip joints, and of the body above the hips, m; masses of a leg, parts of
/// the body's; parts of a woman and of a child.
struct LegSize {
  Wide leg, hips, upper;
  Wide thigh_mass, shank_mass, foot_mass;
  Wide woman, child;
};

HWY_INLINE Wide hips_scale(const Wide& height, const Wide& leg) {
  return hara::at_zero_m + (leg * hara::per_leg + height * hara::per_height);
}

HWY_INLINE LegSize leg_size(const BodySize<Lanes<float>>& size) {
  constexpr auto below_over_above = static_cast<float>(fraction::hip_height / (1 - fraction::hip_height));
  const Wide height = load(size.height_m), leg = load(size.leg_scale_m);
  return {leg,
          hips_scale(height, leg),
          fma(height - leg, wide(below_over_above), height),
          load(size.thigh_mass),
          load(size.shank_mass),
          load(size.foot_mass),
          load(size.woman),
          load(size.child)};
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
