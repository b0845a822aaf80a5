#include "assets/import/polygon_cut.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <mobil/engine/geometry.h>

namespace mobil::inline v0_3 {
namespace {

struct FlatPoint {
  double u = 0, v = 0;
  friend bool operator==(const FlatPoint&, const FlatPoint&) = default;
};

/// A polygon as seen along its normal, and the ring of its corners that are not yet clipped.
struct FlatPolygon {
  std::vector<FlatPoint> point;
  std::vector<std::uint32_t> before, after;
  double flat = 0;  // twice the area up to which corners count as collinear
  bool collinear = false;
};

/// Corners that are allowed in a clipped ear. Stricter rules are tried first.
enum class EarRule : std::uint8_t {
  nothing,  // no corner in it or on its edges
  no_area,  // the ear is flat
  on_edges  // corners on its edges
};

/// Returns twice the area of a, b, c; positive if they turn as the polygon does.
double turn(const FlatPoint& a, const FlatPoint& b, const FlatPoint& c) {
  return (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
}

FlatPolygon flatten(const std::vector<Vec3<float>>& position, std::span<const std::uint32_t> corner) {
  using namespace geometry;
  const Vec first = to_double(position[corner[0]]);
  const auto at = [&](std::size_t i) { return to_double(position[corner[i]]) - first; };
  Vec normal{0, 0, 0};
  double reach = 0;
  for (std::size_t i = 1; i < corner.size(); ++i) {
    if (i + 1 < corner.size()) normal = normal + cross(at(i), at(i + 1));
    reach = std::max(reach, dot(at(i), at(i)));
  }
  FlatPolygon polygon;
  polygon.flat = 1e-13 * reach;
  const double size = length(normal);
  polygon.collinear = !(size > polygon.flat);
  if (polygon.collinear) return polygon;
  const Vec n = (1 / size) * normal;
  const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
  const Vec across = x <= y && x <= z ? Vec{1, 0, 0} : y <= z ? Vec{0, 1, 0} : Vec{0, 0, 1};
  const Vec u = normalised(cross(across, n));
  const Vec v = cross(n, u);
  for (std::size_t i = 0; i < corner.size(); ++i) polygon.point.push_back({dot(u, at(i)), dot(v, at(i))});
  return polygon;
}

void write_fan(std::span<const std::uint32_t> corner, std::uint32_t* triangle) {
  for (std::size_t c = 2; c < corner.size(); ++c) {
    for (const auto vertex : {corner[0], corner[c - 1], corner[c]}) *triangle++ = vertex;
  }
}

bool is_fan(const FlatPolygon& polygon) {
  const auto& p = polygon.point;
  for (std::size_t c = 2; c < p.size(); ++c) {
    if (turn(p[0], p[c - 1], p[c]) <= polygon.flat) return false;
  }
  return true;
}

/// True if the corner `other` forbids the ear at `tip`.
bool in_the_way(const FlatPolygon& polygon, std::uint32_t tip, std::uint32_t other, double margin) {
  const auto& point = polygon.point;
  const FlatPoint &p = point[polygon.before[tip]], &t = point[tip], &n = point[polygon.after[tip]], &q = point[other];
  if (q == p || q == n) return false;
  if (q == t) {  // the tip touches another corner, whose edges must not lead into the ear
    for (const auto beside : {polygon.before[other], polygon.after[other]}) {
      if (turn(p, t, point[beside]) > polygon.flat && turn(t, n, point[beside]) > polygon.flat) return true;
    }
    return false;
  }
  return turn(p, t, q) > margin && turn(t, n, q) > margin && turn(n, p, q) > margin;
}

bool is_ear(const FlatPolygon& polygon, std::uint32_t tip, EarRule rule, std::size_t& work) {
  if (work == 0) return false;
  --work;
  const auto before = polygon.before[tip], after = polygon.after[tip];
  const double area = turn(polygon.point[before], polygon.point[tip], polygon.point[after]);
  if (rule == EarRule::no_area) return std::abs(area) <= polygon.flat;
  if (area <= polygon.flat) return false;
  const double margin = rule == EarRule::nothing ? -polygon.flat : polygon.flat;
  for (auto other = polygon.after[after]; other != before; other = polygon.after[other]) {
    if (work == 0) return false;
    --work;
    if (in_the_way(polygon, tip, other, margin)) return false;
  }
  return true;
}

/// True if the polygon turns back at a corner, or stays at its place.
bool is_spike(const FlatPolygon& polygon, std::uint32_t tip) {
  const auto& point = polygon.point;
  const FlatPoint &p = point[polygon.before[tip]], &t = point[tip], &n = point[polygon.after[tip]];
  return std::abs(turn(p, t, n)) <= polygon.flat && (t.u - p.u) * (n.u - t.u) + (t.v - p.v) * (n.v - t.v) <= 0;
}

/// Returns the tip of a spike among `corners` from `start` on, or else that of an ear, or point.size(). Spikes have
/// precedence: an ear next to a spike can lie outside.
std::uint32_t find_tip(const FlatPolygon& polygon, std::uint32_t start, std::uint32_t corners, std::size_t& work) {
  auto tip = start;
  for (std::uint32_t i = 0; i < corners; ++i, tip = polygon.after[tip]) {
    if (is_spike(polygon, tip)) return tip;
  }
  start = tip;
  for (const auto rule : {EarRule::nothing, EarRule::no_area, EarRule::on_edges}) {
    do {
      if (is_ear(polygon, tip, rule, work)) return tip;
      tip = polygon.after[tip];
    } while (tip != start);
  }
  return static_cast<std::uint32_t>(polygon.point.size());
}

}  // namespace

PolygonCut cut_polygon(const std::vector<Vec3<float>>& position, std::span<const std::uint32_t> corner,
                       std::uint32_t* triangle, std::size_t& work) {
  write_fan(corner, triangle);
  if (corner.size() < 4) return PolygonCut::whole;
  FlatPolygon polygon = flatten(position, corner);
  if (polygon.collinear) {
    // Without an area, a fan is right if its triangles have none either.
    for (std::size_t c = 2; c < corner.size(); ++c) {
      const std::array<std::uint32_t, 3> own = {corner[0], corner[c - 1], corner[c]};
      if (!flatten(position, own).collinear) return PolygonCut::crossed;
    }
    return PolygonCut::whole;
  }
  if (is_fan(polygon)) return PolygonCut::whole;
  const auto count = static_cast<std::uint32_t>(corner.size());
  polygon.before.resize(count);
  polygon.after.resize(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    polygon.before[i] = (i + count - 1) % count;
    polygon.after[i] = (i + 1) % count;
  }
  std::uint32_t start = 1;
  std::uint32_t* to = triangle;
  for (std::uint32_t left = count; left > 2; --left) {
    // New spikes are possible only at the two neighbours of the last tip.
    const std::uint32_t tip = find_tip(polygon, start, left == count ? count : 2, work);
    if (tip == count) {
      write_fan(corner, triangle);
      return work == 0 ? PolygonCut::endless : PolygonCut::crossed;
    }
    const auto before = polygon.before[tip], after = polygon.after[tip];
    for (const auto local : {before, tip, after}) *to++ = corner[local];
    polygon.after[before] = after;
    polygon.before[after] = before;
    start = before;
  }
  return PolygonCut::whole;
}

}  // namespace mobil::inline v0_3
