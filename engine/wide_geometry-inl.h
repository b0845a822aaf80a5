// Points, directions and rotations of sixteen lanes. Include it as described in engine/wide-inl.h.

#if defined(MOBIL_ENGINE_WIDE_GEOMETRY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_ENGINE_WIDE_GEOMETRY_INL_H_
#undef MOBIL_ENGINE_WIDE_GEOMETRY_INL_H_
#else
#define MOBIL_ENGINE_WIDE_GEOMETRY_INL_H_
#endif

#include <mobil/components/lanes.h>
#include "engine/wide-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

struct WideVec {
  Wide x, y, z;
};

/// Unit quaternion, w the scalar part.
struct WideQuat {
  Wide x, y, z, w;
};

HWY_INLINE WideVec wide(const Vec3<float>& v) {
  return {wide(v.x), wide(v.y), wide(v.z)};
}
HWY_INLINE WideVec load(const Vec3<Lanes<float>>& v) {
  return {load(v.x), load(v.y), load(v.z)};
}
HWY_INLINE WideQuat load(const Quat<Lanes<float>>& q) {
  return {load(q.x), load(q.y), load(q.z), load(q.w)};
}
HWY_INLINE void store(const WideVec& v, Vec3<Lanes<float>>& to) {
  store(v.x, to.x);
  store(v.y, to.y);
  store(v.z, to.z);
}
HWY_INLINE void store(const WideQuat& q, Quat<Lanes<float>>& to) {
  store(q.x, to.x);
  store(q.y, to.y);
  store(q.z, to.z);
  store(q.w, to.w);
}

HWY_INLINE WideVec operator+(const WideVec& a, const WideVec& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
HWY_INLINE WideVec operator-(const WideVec& a, const WideVec& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
HWY_INLINE Wide dot(const WideVec& a, const WideVec& b) {
  return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z));
}
HWY_INLINE WideVec cross(const WideVec& a, const WideVec& b) {
  return {fnma(a.z, b.y, a.y * b.z), fnma(a.x, b.z, a.z * b.x), fnma(a.y, b.x, a.x * b.y)};
}
HWY_INLINE Wide length(const WideVec& a) {
  return sqrt(dot(a, a));
}
/// Returns s·a + b.
HWY_INLINE WideVec fma(const Wide& s, const WideVec& a, const WideVec& b) {
  return {fma(s, a.x, b.x), fma(s, a.y, b.y), fma(s, a.z, b.z)};
}

HWY_INLINE WideVec select(const WideMask& m, const WideVec& yes, const WideVec& no) {
  return {select(m, yes.x, no.x), select(m, yes.y, no.y), select(m, yes.z, no.z)};
}
HWY_INLINE WideQuat select(const WideMask& m, const WideQuat& yes, const WideQuat& no) {
  return {select(m, yes.x, no.x), select(m, yes.y, no.y), select(m, yes.z, no.z), select(m, yes.w, no.w)};
}

/// Returns the rotation b followed by a.
MOBIL_WIDE_INLINE WideQuat operator*(const WideQuat& a, const WideQuat& b) {
  return {fma(a.w, b.x, fma(a.x, b.w, fnma(a.z, b.y, a.y * b.z))),
          fma(a.w, b.y, fma(a.y, b.w, fnma(a.x, b.z, a.z * b.x))),
          fma(a.w, b.z, fma(a.z, b.w, fnma(a.y, b.x, a.x * b.y))),
          fnma(a.z, b.z, fnma(a.y, b.y, fnma(a.x, b.x, a.w * b.w)))};
}
/// Returns v rotated by q: v + w t + q × t with t = 2 q × v.
MOBIL_WIDE_INLINE WideVec rotate(const WideQuat& q, const WideVec& v) {
  const WideVec axis = {q.x, q.y, q.z}, once = cross(axis, v), t = once + once;
  return v + fma(q.w, t, cross(axis, t));
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
