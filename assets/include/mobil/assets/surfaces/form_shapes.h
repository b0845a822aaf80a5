#pragma once
// Distances to simple shapes, and their smooth union. A distance is negative inside. For ellipsoids and tubes it is
// exact only near the surface. Lengths in m.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include <mobil/assets/body/between.h>
#include <mobil/engine/geometry.h>

namespace mobil::inline v0_3::form {

using namespace geometry;  // Vec and its operators

/// Returns the smaller of two distances, rounded where they differ by less than `k` (quadratic, C¹).
inline double smooth_union(double a, double b, double k) {
  const double h = (std::max)(k - std::abs(a - b), 0.0) / k;
  return (std::min)(a, b) - 0.25 * h * h * k;
}
/// Returns the distance to `a` without `b`, with rounded edges.
inline double smooth_difference(double a, double b, double k) {
  return -smooth_union(-a, b, k);
}

/// Returns the distance to an ellipsoid with axes along x, y and z.
inline double ellipsoid(const Vec& p, const Vec& centre, const Vec& semi) {
  const Vec d = p - centre;
  const Vec unit{d.x / semi.x, d.y / semi.y, d.z / semi.z};
  const Vec slope{unit.x / semi.x, unit.y / semi.y, unit.z / semi.z};
  const double size = length(unit), steep = length(slope);
  if (steep < 1e-9) return -(std::min)({semi.x, semi.y, semi.z});
  return size * (size - 1) / steep;
}

/// Returns the distance to a capsule from a to b, with a radius at either end.
inline double capsule(const Vec& p, const Vec& a, const Vec& b, double at_a, double at_b) {
  const Vec along = b - a, from = p - a;
  const double t = std::clamp(dot(from, along) / dot(along, along), 0.0, 1.0);
  return length(from - t * along) - (at_a + t * (at_b - at_a));
}

/// Returns a curve through values at 0, 1, 2… (Catmull–Rom), between the k-th and the next.
template <class Value>
double curve(std::size_t count, std::size_t k, double t, const Value& value) {
  const double a = value(k == 0 ? 0 : k - 1), b = value(k), c = value(k + 1), d = value((std::min)(k + 2, count - 1));
  return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
}

/// Section of a tube: at `along`, an ellipse about (x, z).
struct Ring {
  double along, across, deep, x = 0, z = 0;
};
/// Returns the distance of (x, along, z) to a tube with rounded ends through rings in the order of `along`.
inline double tube(std::span<const Ring> rings, double along, double x, double z) {
  const auto [k, t] = between(rings.size(), along, [&](std::size_t i) { return rings[i].along; });
  const auto at = [&, k = k, t = t](double Ring::*value) {
    return curve(rings.size(), k, t, [&](std::size_t i) { return rings[i].*value; });
  };
  const double across = at(&Ring::across), deep = at(&Ring::deep);
  const double u = (x - at(&Ring::x)) / across, v = (z - at(&Ring::z)) / deep;
  const double side = (std::sqrt(u * u + v * v) - 1) * (std::min)(across, deep);
  const double beyond = (std::max)(rings.front().along - along, along - rings.back().along);
  return beyond > 0 ? std::hypot((std::max)(side, 0.0), beyond) : (std::max)(side, beyond);
}

}  // namespace mobil::inline v0_3::form
