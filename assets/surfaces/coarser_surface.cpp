#include "assets/surfaces/coarser_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include <mobil/engine/geometry.h>
#include "assets/surfaces/surface_mesh.h"

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;
using Index = std::uint32_t;

/// Triangles less round than this are only made from still thinner ones.
constexpr double least_roundness = 0.1;

/// Squared distances from planes, summed: p·A·p + 2 b·p + c, with A symmetric.
struct Quadric {
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
  Vec3<double> b{0, 0, 0};
  double c = 0, weight = 0;

  void add_plane(const Vec3<double>& n, const Vec3<double>& on, double times) {
    const double d = -dot(n, on);
    xx += times * n.x * n.x, yy += times * n.y * n.y, zz += times * n.z * n.z;
    xy += times * n.x * n.y, xz += times * n.x * n.z, yz += times * n.y * n.z;
    b = b + times * d * n;
    c += times * d * d;
    weight += times;
  }
  void add(const Quadric& q) {
    xx += q.xx, yy += q.yy, zz += q.zz, xy += q.xy, xz += q.xz, yz += q.yz;
    b = b + q.b;
    c += q.c;
    weight += q.weight;
  }
  double at(const Vec3<double>& p) const {
    const Vec3<double> a{xx * p.x + xy * p.y + xz * p.z, xy * p.x + yy * p.y + yz * p.z,
                         xz * p.x + yz * p.y + zz * p.z};
    return weight > 0 ? std::abs(dot(a, p) + 2 * dot(b, p) + c) / weight : 0;
  }
};

/// An edge as a number: its smaller vertex, then its larger one.
std::uint64_t edge_between(Index a, Index b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}
Index smaller(std::uint64_t edge) {
  return static_cast<Index>(edge >> 32);
}
Index larger(std::uint64_t edge) {
  return static_cast<Index>(edge);
}

/// A vertex that moves to a neighbour, and the squared distances that this adds.
struct Collapse {
  double cost;
  Index from, to;
  bool operator<(const Collapse& other) const {
    if (cost != other.cost) return cost < other.cost;
    return from != other.from ? from < other.from : to < other.to;
  }
};

class Simplification {
 public:
  explicit Simplification(const SurfaceMesh& mesh) : triangle_(mesh.triangle) {
    place_.reserve(mesh.position.size());
    for (const auto& p : mesh.position) place_.push_back(to_double(p));
    join_equal_places();
    quadric_.resize(place_.size());
    for (std::size_t t = 0; t < triangle_.size(); t += 3) {
      const Vec3<double> normal = normal_of({triangle_[t], triangle_[t + 1], triangle_[t + 2]});
      const double twice_area = length(normal);
      if (twice_area == 0) continue;
      for (std::size_t k = 0; k < 3; ++k)
        quadric_[triangle_[t + k]].add_plane((1 / twice_area) * normal, place_[triangle_[t]], twice_area);
    }
    moved_.resize(place_.size());
    std::iota(moved_.begin(), moved_.end(), Index{0});
    mark_edges();
    keep_borders();
  }

  /// Collapses until at most `wanted` triangles are left, or none can go.
  std::vector<Index> run(std::size_t wanted) {
    while (triangle_.size() / 3 > wanted && pass(triangle_.size() / 3 - wanted)) {
    }
    return std::move(triangle_);
  }

 private:
  Vec3<double> normal_of(const std::array<Index, 3>& corner) const {
    return cross(place_[corner[1]] - place_[corner[0]], place_[corner[2]] - place_[corner[0]]);
  }
  /// Returns a triangle's area over the sum of its squared sides, 1 if all sides are equal.
  double roundness(const std::array<Index, 3>& corner) const {
    double squares = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3<double> side = place_[corner[(k + 1) % 3]] - place_[corner[k]];
      squares += dot(side, side);
    }
    constexpr double of_equal_sides = 3.4641016151377544;  // 2 root 3
    return squares > 0 ? of_equal_sides * length(normal_of(corner)) / squares : 0;
  }

  void join_equal_places() {
    std::vector<Index> order(place_.size());
    std::iota(order.begin(), order.end(), Index{0});
    const auto before = [&](Index a, Index b) {
      const Vec3<double>&p = place_[a], &q = place_[b];
      return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z != q.z ? p.z < q.z : a < b;
    };
    std::sort(order.begin(), order.end(), before);
    std::vector<Index> same(place_.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      const bool equal = i > 0 && place_[order[i]].x == place_[order[i - 1]].x &&
                         place_[order[i]].y == place_[order[i - 1]].y && place_[order[i]].z == place_[order[i - 1]].z;
      same[order[i]] = equal ? same[order[i - 1]] : order[i];
    }
    for (Index& v : triangle_) v = same[v];
    drop_degenerate();
  }
  void drop_degenerate() {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < triangle_.size(); t += 3) {
      const Index a = triangle_[t], b = triangle_[t + 1], c = triangle_[t + 2];
      if (a == b || b == c || c == a) continue;
      triangle_[kept] = a, triangle_[kept + 1] = b, triangle_[kept + 2] = c;
      kept += 3;
    }
    triangle_.resize(kept);
  }

  /// Finds all edges, in order, and the kinds of vertices from the number of triangles at their edges.
  void mark_edges() {
    find_triangles_of_vertices();
    edge_.clear();
    border_.clear();
    on_border_.assign(place_.size(), false);
    std::vector<Index> larger_ones;
    for (Index a = 0; a < place_.size(); ++a) {
      larger_ones.clear();
      each_neighbour(a, [&](Index b) {
        if (b > a) larger_ones.push_back(b);
      });
      std::sort(larger_ones.begin(), larger_ones.end());
      for (std::size_t i = 0, end; i < larger_ones.size(); i = end) {
        const Index b = larger_ones[i];
        for (end = i + 1; end < larger_ones.size() && larger_ones[end] == b;) ++end;
        const bool border = end - i == 1;
        if (border) on_border_[a] = on_border_[b] = true;
        edge_.push_back(edge_between(a, b));
        border_.push_back(border);
      }
    }
  }

  /// Adds planes through border edges, at right angles to the surface: leaving a border costs much.
  void keep_borders() {
    constexpr double stiffness = 10;
    for (std::size_t t = 0; t < triangle_.size(); t += 3) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Index a = triangle_[t + k], b = triangle_[t + (k + 1) % 3], c = triangle_[t + (k + 2) % 3];
        const auto edge = std::lower_bound(edge_.begin(), edge_.end(), edge_between(a, b));
        if (!border_[static_cast<std::size_t>(edge - edge_.begin())]) continue;
        const Vec3<double> along = place_[b] - place_[a], inwards = place_[c] - place_[a];
        const double squared = dot(along, along);
        if (squared == 0) continue;
        const Vec3<double> across = inwards - (dot(inwards, along) / squared) * along;
        const double distance = length(across);
        if (distance == 0) continue;
        for (const Index v : {a, b}) quadric_[v].add_plane((1 / distance) * across, place_[a], stiffness * squared);
      }
    }
  }

  /// Returns whether a vertex can move along an edge: those of a border stay on it.
  bool can_move(Index from, bool border) const { return border || !on_border_[from]; }

  void find_triangles_of_vertices() {
    first_.assign(place_.size() + 1, 0);
    for (const Index v : triangle_) ++first_[v + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    at_.resize(triangle_.size());
    std::vector<Index> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < triangle_.size(); ++i) at_[next[triangle_[i]]++] = static_cast<Index>(i / 3);
  }
  /// Calls `f(triangle)` with the corners of each triangle of `v`, after this pass's collapses so far.
  template <class F>
  void each_triangle(Index v, const F& f) const {
    for (Index i = first_[v]; i < first_[v + 1]; ++i) {
      const Index* corner = &triangle_[3 * std::size_t{at_[i]}];
      const std::array<Index, 3> now = {moved_[corner[0]], moved_[corner[1]], moved_[corner[2]]};
      if (now[0] != now[1] && now[1] != now[2] && now[2] != now[0]) f(now);
    }
  }
  template <class F>
  void each_neighbour(Index v, const F& f) const {
    each_triangle(v, [&](const std::array<Index, 3>& corners) {
      for (const Index other : corners)
        if (other != v) f(other);
    });
  }

  /// Returns whether the surface stays a surface, no triangle turns over, and none becomes a needle. A third vertex
  /// that is joined to both ends must be that of a triangle at the edge.
  bool keeps_surface(Index from, Index to) {
    const Index near_to = ++round_, near_both = ++round_;
    each_neighbour(to, [&](Index v) { seen_[v] = near_to; });
    std::size_t joined = 0, shared = 0;
    bool upright = true;
    each_triangle(from, [&](const std::array<Index, 3>& corners) {
      for (const Index v : corners) {
        if (v == to || seen_[v] != near_to || v == from) continue;
        seen_[v] = near_both;
        ++joined;
      }
      if (std::ranges::find(corners, to) != corners.end()) {
        ++shared;
        return;
      }
      std::array<Index, 3> after = corners;
      std::ranges::replace(after, from, to);
      upright = upright && dot(normal_of(corners), normal_of(after)) > 0 &&
                (roundness(after) > least_roundness || roundness(after) > roundness(corners));
    });
    return upright && joined == shared;
  }

  /// Collapses the cheapest edges, no vertex twice. Returns whether there were any.
  bool pass(std::size_t surplus) {
    moved_.resize(place_.size());
    std::iota(moved_.begin(), moved_.end(), Index{0});
    mark_edges();
    seen_.assign(place_.size(), 0);
    round_ = 0;
    std::vector<Collapse> all;
    for (std::size_t e = 0; e < edge_.size(); ++e) {
      const Index a = smaller(edge_[e]), b = larger(edge_[e]);
      Collapse best{std::numeric_limits<double>::infinity(), a, b};
      if (can_move(a, border_[e])) best.cost = quadric_[a].at(place_[b]);
      if (const double back = quadric_[b].at(place_[a]); can_move(b, border_[e]) && back < best.cost)
        best = {back, b, a};
      if (best.cost < std::numeric_limits<double>::infinity()) all.push_back(best);
    }
    const std::size_t goal = surplus / 2;
    double dear = std::numeric_limits<double>::infinity();
    if (goal < all.size()) {
      std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(goal), all.end());
      dear = 1.5 * all[goal].cost;
    }
    const auto cheap = std::partition(all.begin(), all.end(), [&](const Collapse& c) { return c.cost <= dear; });
    std::vector<bool> locked(place_.size());
    std::size_t removed = 0;
    const auto collapse = [&](const Collapse& c) {
      if (locked[c.from] || locked[c.to] || !keeps_surface(c.from, c.to)) return;
      locked[c.from] = locked[c.to] = true;
      moved_[c.from] = c.to;
      quadric_[c.to].add(quadric_[c.from]);
      removed += on_border_[c.from] ? 1 : 2;
    };
    std::sort(all.begin(), cheap);
    for (auto c = all.begin(); c != cheap && removed < surplus; ++c) collapse(*c);
    if (const std::size_t least = std::max<std::size_t>(surplus / 6, 1); removed < least) {
      std::sort(cheap, all.end());
      for (auto c = cheap; c != all.end() && removed < least; ++c) collapse(*c);
    }
    if (removed == 0) return false;
    for (Index& v : triangle_) v = moved_[v];
    drop_degenerate();
    return true;
  }

  std::vector<Vec3<double>> place_;
  std::vector<Index> triangle_;
  std::vector<Quadric> quadric_;
  std::vector<std::uint64_t> edge_;
  std::vector<bool> border_;  // of each edge
  std::vector<bool> on_border_;
  std::vector<Index> first_, at_;  // triangles of vertex v: at_[first_[v]] to at_[first_[v + 1]]
  std::vector<Index> moved_;       // where each vertex is after this pass's collapses so far
  std::vector<Index> seen_;
  Index round_ = 0;
};

}  // namespace

SurfaceMesh coarser(const SurfaceMesh& mesh, double share) {
  if (share >= 1 || mesh.triangle.empty()) return mesh;
  SurfaceMesh light;
  light.name = mesh.name;
  light.position = mesh.position;
  const auto triangles = static_cast<double>(mesh.triangle.size() / 3);
  light.triangle = Simplification(mesh).run(static_cast<std::size_t>(std::ceil(share * triangles)));
  drop_unused(light);
  return light;
}

}  // namespace mobil::inline v0_3
