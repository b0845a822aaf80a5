#pragma once
// Arithmetic on points and directions in double, for building shapes. Set-up only.

#include <cmath>

#include "components/lanes.h"

namespace mobil::geometry {

using Vec = Vec3<double>;

constexpr Vec operator+(const Vec& a, const Vec& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
constexpr Vec operator-(const Vec& a, const Vec& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
constexpr Vec operator*(double s, const Vec& a) {
  return {s * a.x, s * a.y, s * a.z};
}
constexpr double dot(const Vec& a, const Vec& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
constexpr Vec cross(const Vec& a, const Vec& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(const Vec& a) {
  return std::sqrt(dot(a, a));
}
inline Vec normalised(const Vec& a) {
  return (1.0 / length(a)) * a;
}

/// The part of `direction` that is orthogonal to the unit vector `axis`, of unit length; some such vector where the two
/// are parallel.
inline Vec orthogonal(const Vec& direction, const Vec& axis) {
  const Vec part = direction - dot(direction, axis) * axis;
  if (length(part) > 1e-9 * (1 + length(direction))) return normalised(part);
  const Vec other = std::abs(axis.x) < 0.6 ? Vec{1, 0, 0} : Vec{0, 1, 0};
  return normalised(other - dot(other, axis) * axis);
}

/// 0 below `from`, 1 above `to`, smooth between (C¹).
inline double smoothstep(double from, double to, double x) {
  const double t = x <= from ? 0.0 : x >= to ? 1.0 : (x - from) / (to - from);
  return t * t * (3 - 2 * t);
}

template <class F>
constexpr Vec to_double(const Vec3<F>& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
constexpr Vec3<float> to_float(const Vec& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// v rotated by the unit quaternion q.
template <class F>
constexpr Vec rotated(const Quat<F>& q, const Vec& v) {
  const Vec axis{static_cast<double>(q.x), static_cast<double>(q.y), static_cast<double>(q.z)};
  const Vec t = 2.0 * cross(axis, v);
  return v + static_cast<double>(q.w) * t + cross(axis, t);
}
template <class F>
constexpr Quat<F> conjugate(const Quat<F>& q) {
  return {-q.x, -q.y, -q.z, q.w};
}

}  // namespace mobil::geometry
