// Elementary rotations of sixteen lanes. See engine/wide-inl.h for how to include it.

#if defined(MOBIL_SYSTEMS_KINEMATICS_WIDE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_KINEMATICS_WIDE_INL_H_
#undef MOBIL_SYSTEMS_KINEMATICS_WIDE_INL_H_
#else
#define MOBIL_SYSTEMS_KINEMATICS_WIDE_INL_H_
#endif

#include "assets/gait/step_curves-inl.h"
#include "engine/wide_geometry-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

HWY_INLINE WideVec scaled(const Vec3<float>& v, const Wide& by) {
  return {v.x * by, v.y * by, v.z * by};
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

/// Sine and cosine of half of a constant angle.
struct HalfAngle {
  float sine, cosine;
};
constexpr HalfAngle half_of(double angle) {
  return {cosine(0.5 * angle - 0.5 * 3.14159265358979324), cosine(0.5 * angle)};
}
HWY_INLINE WideQuat turn_x(const HalfAngle& half) {
  return {wide(half.sine), wide(0.0F), wide(0.0F), wide(half.cosine)};
}

/// Interpolates between two rotations that are less than a right angle apart.
MOBIL_WIDE_INLINE WideQuat part_way(const WideQuat& a, const WideQuat& b, const Wide& part) {
  const WideQuat m = {fma(part, b.x - a.x, a.x), fma(part, b.y - a.y, a.y), fma(part, b.z - a.z, a.z),
                      fma(part, b.w - a.w, a.w)};
  const Wide r = 1.0F / sqrt(fma(m.x, m.x, fma(m.y, m.y, fma(m.z, m.z, m.w * m.w))));
  return {m.x * r, m.y * r, m.z * r, m.w * r};
}
HWY_INLINE WideQuat turn_z(const Wide& angle) {
  Wide s, c;
  sin_cos(angle * wide(0.5F), s, c);
  return {wide(0.0F), wide(0.0F), s, c};
}

/// Returns a rotation about y, within it about z, within that about x.
MOBIL_WIDE_INLINE WideQuat turn_yzx(const Wide& y, const Wide& z, const Wide& x) {
  return turn_y(y) * (turn_z(z) * turn_x(x));
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
