#include "assets/export/closed_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace mobil::inline v0_3 {
namespace {

using Eigen::Vector3d;
using Corners = std::array<Vector3d, 3>;
constexpr std::size_t leaf_triangles = 8;

/// Returns 1 if a ray leaves through a triangle, −1 if it enters, 0 if it misses (Möller, Trumbore 1997).
int crossing(const Vector3d& origin, const Vector3d& direction, const Corners& corner) {
  const Vector3d u = corner[1] - corner[0], v = corner[2] - corner[0], p = direction.cross(v);
  const double determinant = u.dot(p);
  if (std::abs(determinant) < 1e-18) return 0;
  const Vector3d from = origin - corner[0], q = from.cross(u);
  const double first = from.dot(p) / determinant, second = direction.dot(q) / determinant;
  if (first < 0 || second < 0 || first + second > 1 || v.dot(q) / determinant <= 0) return 0;
  return determinant < 0 ? 1 : -1;
}

/// Returns the nearest point of a triangle (Ericson, Real-Time Collision Detection, 5.1.5).
Vector3d nearest_point(const Vector3d& point, const Corners& corner) {
  const auto& [a, b, c] = corner;
  const Vector3d ab = b - a, ac = c - a, ap = point - a, bp = point - b, cp = point - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d1 <= 0 && d2 <= 0) return a;
  if (d3 >= 0 && d4 <= d3) return b;
  if (d6 >= 0 && d5 <= d6) return c;
  const double of_c = d1 * d4 - d3 * d2, of_b = d5 * d2 - d1 * d6, of_a = d3 * d6 - d5 * d4;
  if (of_c <= 0 && d1 >= 0 && d3 <= 0) return a + ab * (d1 / (d1 - d3));
  if (of_b <= 0 && d2 >= 0 && d6 <= 0) return a + ac * (d2 / (d2 - d6));
  if (of_a <= 0 && d4 >= d3 && d5 >= d6) return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  return a + (ab * of_b + ac * of_c) / (of_a + of_b + of_c);
}

}  // namespace

ClosedSurface::ClosedSurface(const Eigen::Matrix3Xd& position, const std::vector<std::uint32_t>& triangle) {
  for (std::size_t i = 0; i + 2 < triangle.size(); i += 3)
    triangle_.push_back(
        {{position.col(triangle[i]), position.col(triangle[i + 1]), position.col(triangle[i + 2])}, i / 3});
  build(0, triangle_.size());
}

std::size_t ClosedSurface::build(std::size_t first, std::size_t end) {
  const std::size_t number = box_.size();
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::max()), high = -low;
  for (std::size_t i = first; i < end; ++i) {
    for (const Vector3d& corner : triangle_[i].corner) {
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
  }
  box_.push_back({low, high, first, end - first});
  if (end - first <= leaf_triangles) return number;
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  const std::size_t middle = first + (end - first) / 2;
  const auto at = [&](std::size_t i) { return triangle_.begin() + static_cast<std::ptrdiff_t>(i); };
  const auto place = [axis](const Triangle& t) { return t.corner[0][axis] + t.corner[1][axis] + t.corner[2][axis]; };
  std::nth_element(at(first), at(middle), at(end),
                   [&](const Triangle& a, const Triangle& b) { return place(a) < place(b); });
  const std::size_t left = build(first, middle), right = build(middle, end);
  box_[number].left = left;
  box_[number].right = right;
  return number;
}

int ClosedSurface::crossings(const Vector3d& origin, const Vector3d& direction, std::size_t box) const {
  const Box& b = box_[box];
  const Vector3d to_low = (b.low - origin).cwiseQuotient(direction),
                 to_high = (b.high - origin).cwiseQuotient(direction);
  if (std::max(0.0, to_low.cwiseMin(to_high).maxCoeff()) > to_low.cwiseMax(to_high).minCoeff()) return 0;
  if (b.left != 0) return crossings(origin, direction, b.left) + crossings(origin, direction, b.right);
  int sum = 0;
  for (std::size_t i = b.first; i < b.first + b.count; ++i) sum += crossing(origin, direction, triangle_[i].corner);
  return sum;
}

bool ClosedSurface::is_outside(const Vector3d& point) const {
  // No component is 0, and no direction lies in a plane of symmetry.
  static const std::array<Vector3d, 3> directions = {Vector3d(1, 0.013, 0.021), Vector3d(-0.9, 0.3, -0.05),
                                                     Vector3d(0.1, -1, 0.07)};
  return std::ranges::all_of(directions, [&](const Vector3d& d) { return crossings(point, d, 0) == 0; });
}

void ClosedSurface::approach(const Vector3d& point, std::size_t box, double& squared, SurfacePlace& best) const {
  const Box& b = box_[box];
  if ((point - point.cwiseMax(b.low).cwiseMin(b.high)).squaredNorm() >= squared) return;
  if (b.left != 0) {
    approach(point, b.left, squared, best);
    approach(point, b.right, squared, best);
    return;
  }
  for (std::size_t i = b.first; i < b.first + b.count; ++i) {
    const Vector3d at = nearest_point(point, triangle_[i].corner);
    const double here = (at - point).squaredNorm();
    if (here >= squared) continue;
    squared = here;
    const auto& [p, q, r] = triangle_[i].corner;
    best = {at, (q - p).cross(r - p).normalized(), std::sqrt(here), triangle_[i].number};
  }
}

SurfacePlace ClosedSurface::nearest(const Vector3d& point) const {
  SurfacePlace best;
  double squared = std::numeric_limits<double>::max();
  approach(point, 0, squared, best);
  return best;
}

}  // namespace mobil::inline v0_3
