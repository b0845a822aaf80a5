// Interpolation in sixteen lanes. Include it as described in engine/wide-inl.h.

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

/// Returns 10 u³ − 15 u⁴ + 6 u⁵ for u clamped to [0, 1]. It rises from 0 to 1, twice continuously differentiable.
MOBIL_WIDE_INLINE Wide smooth(const Wide& u) {
  const Wide v = clamp(u, 0.0F, 1.0F);
  return v * v * v * fma(v, fma(v, wide(6.0F), wide(-15.0F)), wide(10.0F));
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
