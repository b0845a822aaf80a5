// Elementary rotations, and the step's curves, of sixteen lanes. Include it as engine/wide-inl.h says.

#if defined(MOBIL_SYSTEMS_KINEMATICS_WIDE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_KINEMATICS_WIDE_INL_H_
#undef MOBIL_SYSTEMS_KINEMATICS_WIDE_INL_H_
#else
#define MOBIL_SYSTEMS_KINEMATICS_WIDE_INL_H_
#endif

#include "components/gait.h"
#include "engine/wide_geometry-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {

HWY_INLINE WideVec scaled(const Vec3<double>& v, const Wide& by) {
  return {wide(static_cast<float>(v.x)) * by, wide(static_cast<float>(v.y)) * by, wide(static_cast<float>(v.z)) * by};
}

HWY_INLINE WideQuat turn_x(const Wide& angle) {
  Wide s, c;
  sin_cos(angle * wide(0.5F), s, c);
  return {s, wide(0.0F), wide(0.0F), c};
}
HWY_INLINE WideQuat turn_y(const Wide& angle) {
  Wide s, c;
  sin_cos(angle * wide(0.5F), s, c);
  return {wide(0.0F), s, wide(0.0F), c};
}
HWY_INLINE WideQuat turn_z(const Wide& angle) {
  Wide s, c;
  sin_cos(angle * wide(0.5F), s, c);
  return {wide(0.0F), wide(0.0F), s, c};
}

/// Turned about y, within that about z, within that about x.
HWY_INLINE WideQuat turn_yzx(const Wide& y, const Wide& z, const Wide& x) {
  return turn_y(y) * (turn_z(z) * turn_x(x));
}

/// Value of one of two neighbouring curves (the second where `second` is 1, the first where it is 0) at u in [0, 1].
HWY_INLINE Wide curve_at(const Curve<Lanes<float>>* curve, const Wide& second, const Wide& u) {
  const float intervals = static_cast<float>(knot_count - 1);
  const Wide place = clamp(u, 0.0F, 1.0F) * wide(intervals);
  const Wide knot = min(floor(place), wide(intervals - 1.0F));
  const Wide t = place - knot, r = wide(1.0F) - t;
  const float* base = curve->value[0].lane;
  const Wide word = fma(second, wide(static_cast<float>(2 * knot_count)), knot);
  const Wide slope = word + wide(static_cast<float>(knot_count));
  const Wide a = gather(base, word), b = gather(base, word + wide(1.0F));
  const Wide da = gather(base, slope), db = gather(base, slope + wide(1.0F));
  const Wide two = wide(2.0F), one = wide(1.0F);
  return fma(r * r, fma(fma(two, t, one), a, t * da), (t * t) * (fma(fma(two, r, one), b, -(r * db))));
}
HWY_INLINE Wide curve_at(const Curve<Lanes<float>>& curve, const Wide& u) {
  return curve_at(&curve, wide(0.0F), u);
}

}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
