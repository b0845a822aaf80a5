// From one value to another, in sixteen lanes. Include it as engine/wide-inl.h says.

#if defined(MOBIL_ENGINE_WIDE_CURVE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_ENGINE_WIDE_CURVE_INL_H_
#undef MOBIL_ENGINE_WIDE_CURVE_INL_H_
#else
#define MOBIL_ENGINE_WIDE_CURVE_INL_H_
#endif

#include "engine/wide-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

HWY_INLINE Wide mix(const Wide& from, const Wide& to, const Wide& part) {
  return fma(part, to - from, from);
}

/// From 0 at 0 to 1 at 1, twice continuously differentiable: 10 u³ − 15 u⁴ + 6 u⁵; beyond, its ends.
MOBIL_WIDE_INLINE Wide smooth(const Wide& u) {
  const Wide v = clamp(u, 0.0F, 1.0F);
  return v * v * v * fma(v, fma(v, wide(6.0F), wide(-15.0F)), wide(10.0F));
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
