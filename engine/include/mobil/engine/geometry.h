#pragma once
// Arithmetic on points, directions and rotations, in float or double, for one lane at a time. Kernels have
// engine/wide_geometry-inl.h. Its names and operators are visible after `using namespace geometry`.

#include <array>
#include <cmath>
#include <type_traits>

#include <mobil/components/lanes.h>

namespace mobil::inline v0_3::geometry {

/// A vector in double precision.
using Vec = Vec3<double>;

/// Sum, difference and multiple of vectors.
template <class F>
constexpr Vec3<F> operator+(const Vec3<F>& a, const Vec3<F>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class F>
constexpr Vec3<F> operator-(const Vec3<F>& a, const Vec3<F>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class F>
constexpr Vec3<F> operator*(std::type_identity_t<F> s, const Vec3<F>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
/// Scalar product, vector product and length.
template <class F>
constexpr F dot(const Vec3<F>& a, const Vec3<F>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class F>
constexpr Vec3<F> cross(const Vec3<F>& a, const Vec3<F>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class F>
F length(const Vec3<F>& a) {
  return std::sqrt(dot(a, a));
}
/// Returns `a` scaled to length 1; its length must not be 0.
template <class F>
Vec3<F> normalised(const Vec3<F>& a) {
  return (1 / length(a)) * a;
}

/// Returns the normalised part of `direction` that is orthogonal to the unit vector `axis`, or any orthogonal unit
/// vector if the two are parallel.
inline Vec orthogonal(const Vec& direction, const Vec& axis) {
  const Vec part = direction - dot(direction, axis) * axis;
  if (length(part) > 1e-9 * (1 + length(direction))) return normalised(part);
  const Vec other = std::abs(axis.x) < 0.6 ? Vec{1, 0, 0} : Vec{0, 1, 0};
  return normalised(other - dot(other, axis) * axis);
}

/// Returns 0 below `from`, 1 above `to`, smooth between (C¹).
inline double smoothstep(double from, double to, double x) {
  const double t = x <= from ? 0.0 : x >= to ? 1.0 : (x - from) / (to - from);
  return t * t * (3 - 2 * t);
}

/// Returns v rotated by the unit quaternion q.
template <class F>
constexpr Vec3<F> rotated(const Quat<F>& q, const std::type_identity_t<Vec3<F>>& v) {
  const Vec3<F> axis{q.x, q.y, q.z};
  const Vec3<F> t = 2 * cross(axis, v);
  return v + q.w * t + cross(axis, t);
}
/// Returns the three axes rotated by the unit quaternion q: the columns of its matrix.
template <class F>
constexpr std::array<Vec3<F>, 3> columns(const Quat<F>& q) {
  const auto [x, y, z, w] = q;
  return {Vec3<F>{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
          Vec3<F>{2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
          Vec3<F>{2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
}
/// Returns the inverse rotation.
template <class F>
constexpr Quat<F> conjugate(const Quat<F>& q) {
  return {-q.x, -q.y, -q.z, q.w};
}
/// Returns the rotation a followed by b.
template <class F>
constexpr Quat<F> product(const Quat<F>& b, const Quat<F>& a) {
  return {b.w * a.x + b.x * a.w + b.y * a.z - b.z * a.y, b.w * a.y - b.x * a.z + b.y * a.w + b.z * a.x,
          b.w * a.z + b.x * a.y - b.y * a.x + b.z * a.w, b.w * a.w - b.x * a.x - b.y * a.y - b.z * a.z};
}

/// Returns the mirror image in the plane x = 0, between the two sides of the body.
template <class F>
constexpr Vec3<F> mirrored(const Vec3<F>& v) {
  return {-v.x, v.y, v.z};
}
template <class F>
constexpr Quat<F> mirrored(const Quat<F>& q) {
  return {q.x, -q.y, -q.z, q.w};
}

/// Converts to the other precision.
constexpr Vec to_double(const Vec3<float>& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
constexpr Quat<double> to_double(const Quat<float>& q) {
  return {static_cast<double>(q.x), static_cast<double>(q.y), static_cast<double>(q.z), static_cast<double>(q.w)};
}
constexpr Vec3<float> to_float(const Vec& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
constexpr Quat<float> to_float(const Quat<double>& q) {
  return {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z), static_cast<float>(q.w)};
}

}  // namespace mobil::inline v0_3::geometry
