// Vectors and quaternions of sixteen lanes. Include after engine/wide-inl.h's conditions (see there).

#if defined(MOBIL_SYSTEMS_KINEMATICS_WIDE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_KINEMATICS_WIDE_INL_H_
#undef MOBIL_SYSTEMS_KINEMATICS_WIDE_INL_H_
#else
#define MOBIL_SYSTEMS_KINEMATICS_WIDE_INL_H_
#endif

#include "components/gait.h"
#include "engine/wide-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {

struct WideVec {
  Wide x, y, z;
};

/// Unit quaternion, w the scalar part.
struct WideQuat {
  Wide x, y, z, w;
};

HWY_INLINE WideVec operator+(const WideVec& a, const WideVec& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

HWY_INLINE WideVec scaled(const Vec3<double>& v, const Wide& by) {
  return {wide(static_cast<float>(v.x)) * by, wide(static_cast<float>(v.y)) * by, wide(static_cast<float>(v.z)) * by};
}

/// First b, then a.
HWY_INLINE WideQuat operator*(const WideQuat& a, const WideQuat& b) {
  return {fma(a.w, b.x, fma(a.x, b.w, fnma(a.z, b.y, a.y * b.z))),
          fma(a.w, b.y, fma(a.y, b.w, fnma(a.x, b.z, a.z * b.x))),
          fma(a.w, b.z, fma(a.z, b.w, fnma(a.y, b.x, a.x * b.y))),
          fnma(a.z, b.z, fnma(a.y, b.y, fnma(a.x, b.x, a.w * b.w)))};
}

/// v turned by q: v + 2 (q.w t + q × t) with t = q × v.
HWY_INLINE WideVec rotate(const WideQuat& q, const WideVec& v) {
  const Wide two = wide(2.0F);
  const WideVec t = {two * fnma(q.z, v.y, q.y * v.z), two * fnma(q.x, v.z, q.z * v.x), two * fnma(q.y, v.x, q.x * v.y)};
  return {v.x + fma(q.w, t.x, fnma(q.z, t.y, q.y * t.z)), v.y + fma(q.w, t.y, fnma(q.x, t.z, q.z * t.x)),
          v.z + fma(q.w, t.z, fnma(q.y, t.x, q.x * t.y))};
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
