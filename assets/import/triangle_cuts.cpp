#include "assets/import/triangle_cuts.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>
#include <vector>

#include <mobil/engine/geometry.h>

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;

constexpr std::uint32_t triangles_of_leaf = 4;
constexpr std::size_t max_comparisons = 300'000'000;

struct CutBox {
  Vec3<float> least, most;
};

CutBox joined(const CutBox& a, const CutBox& b) {
  return {{std::min(a.least.x, b.least.x), std::min(a.least.y, b.least.y), std::min(a.least.z, b.least.z)},
          {std::max(a.most.x, b.most.x), std::max(a.most.y, b.most.y), std::max(a.most.z, b.most.z)}};
}

bool apart(const CutBox& a, const CutBox& b) {
  return a.most.x < b.least.x || b.most.x < a.least.x || a.most.y < b.least.y || b.most.y < a.least.y ||
         a.most.z < b.least.z || b.most.z < a.least.z;
}

/// A node has the triangles first to last of the order. Its children are itself + 1 and `second`, 0 in a leaf.
struct CutNode {
  CutBox box;
  std::uint32_t first, last, second;
};

struct CutTree {
  std::vector<CutBox> box;           // of each triangle
  std::vector<std::uint32_t> order;  // of triangles
  std::vector<CutNode> node;
};

float middle(const CutBox& box, int axis) {
  const auto sum = [](float a, float b) { return 0.5F * a + 0.5F * b; };
  if (axis == 0) return sum(box.least.x, box.most.x);
  return axis == 1 ? sum(box.least.y, box.most.y) : sum(box.least.z, box.most.z);
}

std::uint32_t build(CutTree& tree, std::uint32_t first, std::uint32_t last) {
  const auto own = static_cast<std::uint32_t>(tree.node.size());
  CutBox box = tree.box[tree.order[first]];
  for (std::uint32_t i = first + 1; i < last; ++i) box = joined(box, tree.box[tree.order[i]]);
  tree.node.push_back({box, first, last, 0});
  if (last - first <= triangles_of_leaf) return own;
  const Vec3<float> size = box.most - box.least;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::uint32_t half = first + (last - first) / 2;
  std::nth_element(tree.order.begin() + first, tree.order.begin() + half, tree.order.begin() + last,
                   [&](std::uint32_t a, std::uint32_t b) {
                     return std::pair(middle(tree.box[a], axis), a) < std::pair(middle(tree.box[b], axis), b);
                   });
  build(tree, first, half);
  const std::uint32_t second = build(tree, half, last);
  tree.node[own].second = second;
  return own;
}

using Corners = std::array<Vec, 3>;

Corners corners_of(const SurfaceMesh& mesh, std::uint32_t triangle) {
  Corners corner{};
  for (std::size_t c = 0; c < 3; ++c) corner[c] = to_double(mesh.position[mesh.triangle[3 * triangle + c]]);
  return corner;
}

/// Returns six times the volume of a tetrahedron, with its sign.
double side(const Vec& a, const Vec& b, const Vec& c, const Vec& d) {
  return dot(a - d, cross(b - d, c - d));
}

bool one_sign(double a, double b, double c) {
  return (a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0);
}

/// True if an edge of `other` passes through the inside of `triangle`.
bool pierced(const Corners& triangle, const Corners& other) {
  const auto& [a, b, c] = triangle;
  std::array<double, 3> s{};
  for (std::size_t i = 0; i < 3; ++i) s[i] = side(a, b, c, other[i]);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    if (!((s[i] > 0 && s[j] < 0) || (s[i] < 0 && s[j] > 0))) continue;
    const Vec &p = other[i], &q = other[j];
    if (one_sign(side(p, q, a, b), side(p, q, b, c), side(p, q, c, a))) return true;
  }
  return false;
}

bool neighbours(const SurfaceMesh& mesh, std::uint32_t a, std::uint32_t b) {
  const auto* first = &mesh.triangle[3 * std::size_t{a}];
  const auto* second = &mesh.triangle[3 * std::size_t{b}];
  return std::any_of(first, first + 3, [&](std::uint32_t v) { return std::find(second, second + 3, v) != second + 3; });
}

}  // namespace

CutCount count_cuts(const SurfaceMesh& mesh, std::span<const std::uint32_t> piece, std::size_t max_pairs) {
  const auto triangles = static_cast<std::uint32_t>(mesh.triangle.size() / 3);
  CutCount count;
  if (triangles == 0) return count;
  CutTree tree;
  tree.order.resize(triangles);
  std::iota(tree.order.begin(), tree.order.end(), 0U);
  for (std::uint32_t t = 0; t < triangles; ++t) {
    const auto at = [&](std::size_t c) { return mesh.position[mesh.triangle[3 * std::size_t{t} + c]]; };
    tree.box.push_back(joined(joined({at(0), at(0)}, {at(1), at(1)}), {at(2), at(2)}));
  }
  build(tree, 0, triangles);

  std::vector<std::pair<std::uint32_t, std::uint32_t>> open = {{0, 0}};
  const auto compare = [&](std::uint32_t s, std::uint32_t t) {
    if (apart(tree.box[s], tree.box[t]) || neighbours(mesh, s, t)) return;
    const Corners a = corners_of(mesh, s), b = corners_of(mesh, t);
    if (!pierced(a, b) && !pierced(b, a)) return;
    ++count.pairs;
    count.between_pieces += piece[s] != piece[t] ? 1 : 0;
  };
  for (std::size_t comparisons = 0; !open.empty(); ++comparisons) {
    if (count.pairs >= max_pairs || comparisons >= max_comparisons) {
      count.complete = false;
      break;
    }
    const auto [i, j] = open.back();
    open.pop_back();
    const CutNode &a = tree.node[i], &b = tree.node[j];
    if (i != j && apart(a.box, b.box)) continue;
    if (a.second == 0 && b.second == 0) {
      for (std::uint32_t s = a.first; s < a.last; ++s) {
        for (std::uint32_t t = i == j ? s + 1 : b.first; t < b.last; ++t) compare(tree.order[s], tree.order[t]);
      }
    } else if (i == j) {
      open.insert(open.end(), {{i + 1, i + 1}, {a.second, a.second}, {i + 1, a.second}});
    } else if (b.second == 0 || (a.second != 0 && a.last - a.first >= b.last - b.first)) {
      open.insert(open.end(), {{i + 1, j}, {a.second, j}});
    } else {
      open.insert(open.end(), {{i, j + 1}, {i, b.second}});
    }
  }
  return count;
}

}  // namespace mobil::inline v0_3
