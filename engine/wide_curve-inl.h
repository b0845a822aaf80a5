// Smooth functions of sixteen lanes, and values of their curves (components/curve.h). Include it as engine/wide-inl.h
// says.

#if defined(MOBIL_ENGINE_WIDE_CURVE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_ENGINE_WIDE_CURVE_INL_H_
#undef MOBIL_ENGINE_WIDE_CURVE_INL_H_
#else
#define MOBIL_ENGINE_WIDE_CURVE_INL_H_
#endif

#include "components/curve.h"
#include "engine/wide-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {

/// 0 below 0, 1 above 1, with continuous slope between.
MOBIL_WIDE_INLINE Wide ease(const Wide& u) {
  const Wide v = clamp(u, 0.0F, 1.0F);
  return v * v * (3.0F - 2.0F * v);
}

HWY_INLINE Wide mix(const Wide& from, const Wide& to, const Wide& part) {
  return fma(part, to - from, from);
}

/// Cubic through a at u = 0 and b at u = 1 with slopes per unit of u.
MOBIL_WIDE_INLINE Wide hermite(const Wide& u, const Wide& a, const Wide& a_slope, const Wide& b, const Wide& b_slope) {
  const Wide v = 1.0F - u;
  return v * v * ((1.0F + 2.0F * u) * a + u * a_slope) + u * u * ((1.0F + 2.0F * v) * b - v * b_slope);
}

/// A curve at u in [0, 1] of its time; beyond, its ends.
HWY_NOINLINE inline Wide curve_at(const Curve<Lanes<float>>& curve, const Wide& u) {
  constexpr float intervals = static_cast<float>(knot_count - 1);
  const Wide place = clamp(u, 0.0F, 1.0F) * intervals;
  const Wide knot = min(floor(place), intervals - 1.0F);
  const Wide t = place - knot, r = 1.0F - t;
  const float* base = curve.value[0].lane;
  const Wide slope = knot + static_cast<float>(knot_count);
  const Wide a = gather(base, knot), b = gather(base, knot + 1.0F);
  const Wide da = gather(base, slope), db = gather(base, slope + 1.0F);
  return fma(r * r, fma(fma(wide(2.0F), t, wide(1.0F)), a, t * da),
             (t * t) * (fma(fma(wide(2.0F), r, wide(1.0F)), b, -(r * db))));
}

}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
