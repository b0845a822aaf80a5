#include "assets/surfaces/form_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include <mobil/engine/interrupt.h>
#include "engine/row_hash.h"

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;
using form::BodyForm;

constexpr double coarse_m = 0.012;
constexpr int finest = 2;  // levels; a cell of level n is coarse_m / 2ⁿ wide

/// A point of the grid of the finest cells, each axis from −2²⁰ to 2²⁰.
struct Place {
  int x, y, z;
  bool operator==(const Place&) const = default;
  int& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
};
struct Cell {
  Place corner;
  int level = 0;
  bool operator==(const Cell&) const = default;
};
struct Edge {
  Place from;
  int axis, level;
  bool operator==(const Edge&) const = default;
};

std::uint64_t packed(const Place& p) {
  constexpr std::uint64_t bias = 1 << 20;
  const auto word = [](int v) { return static_cast<std::uint64_t>(v) + bias; };
  return word(p.x) | word(p.y) << 21 | word(p.z) << 42;
}
struct Hash {
  std::size_t operator()(const Place& p) const { return mix64(packed(p)); }
  std::size_t operator()(const Cell& c) const { return mix64(packed(c.corner) + static_cast<std::uint64_t>(c.level)); }
  std::size_t operator()(const Edge& e) const {
    return mix64(packed(e.from) * 3 + static_cast<std::uint64_t>(e.axis + 4 * e.level));
  }
};

constexpr int width(int level) {
  return 1 << (finest - level);
}

class Mesher {
 public:
  Mesher(const BodyForm& body, double coarseness)
      : body_(body), cell_m_(coarseness * coarse_m * body.size() / width(0)) {}

  SurfaceMesh run() {
    collect();
    for (const Edge& edge : edges_) add_quad(edge);
    for (std::size_t v = 0; v < sum_.size(); ++v)
      mesh_.position.push_back(to_float((1.0 / static_cast<double>(cuts_[v])) * sum_[v]));
    return std::move(mesh_);
  }

 private:
  Vec at(const Place& p) const { return {cell_m_ * p.x, cell_m_ * p.y, cell_m_ * p.z}; }
  Vec middle(const Cell& cell) const {
    const double half = 0.5 * width(cell.level);
    return {cell_m_ * (cell.corner.x + half), cell_m_ * (cell.corner.y + half), cell_m_ * (cell.corner.z + half)};
  }

  /// Returns the level of the cells about a point.
  int level(const Vec& p) const {
    const Vec q = (1 / body_.size()) * p;
    if (q.y > 1.50) return q.z > 0.045 || (std::abs(q.x) > 0.066 && q.y > 1.58 && q.z > -0.05) ? 2 : 1;
    if (q.y < 0.10) return q.z > 0.13 && q.y < 0.05 ? 2 : 1;
    if (std::abs(q.x) < 0.3) return 0;
    const Vec arm = body_.in_arm({-std::abs(p.x), p.y, p.z});
    const double down = (body_.arm().shoulder().y - arm.y) / body_.size();
    return down > 0.645 ? 2 : down > 0.55 ? 1 : 0;
  }

  /// Returns the leaf that contains a point, given in halves of the finest cells.
  Cell leaf(const Place& halves) const {
    Cell cell;
    for (cell.level = 0;; ++cell.level) {
      const int w = 2 * width(cell.level);
      const auto floor = [w](int v) { return (v >= 0 ? v / w : -((w - 1 - v) / w)) * (w / 2); };
      cell.corner = {floor(halves.x), floor(halves.y), floor(halves.z)};
      if (cell.level == finest || level(middle(cell)) <= cell.level) return cell;
    }
  }

  double value(const Place& p) {
    const auto [found, is_new] = value_.try_emplace(p, 0);
    if (is_new) found->second = body_.distance(at(p));
    return found->second;
  }

  void visit(const Cell& cell) {
    const double reach = 1.3 * 0.87 * cell_m_ * width(cell.level);
    if (std::abs(body_.distance(middle(cell))) > reach) return;
    if (cell.level < finest && level(middle(cell)) > cell.level) {
      const int half = width(cell.level) / 2;
      for (int child = 0; child < 8; ++child) {
        visit({{cell.corner.x + half * (child & 1), cell.corner.y + half * (child >> 1 & 1),
                cell.corner.z + half * (child >> 2)},
               cell.level + 1});
      }
      return;
    }
    for (int axis = 0; axis < 3; ++axis) {
      for (int side = 0; side < 4; ++side) {
        Edge edge{cell.corner, axis, cell.level};
        edge.from[(axis + 1) % 3] += width(cell.level) * (side & 1);
        edge.from[(axis + 2) % 3] += width(cell.level) * (side >> 1);
        if (seen_.insert(edge).second && is_cut(edge) && !is_divided(edge)) edges_.push_back(edge);
      }
    }
  }

  void collect() {
    constexpr int block = 8;
    const int step = block * width(0);
    const double block_m = cell_m_ * step;
    const auto count = [&](double from_m) { return static_cast<int>(std::ceil(from_m * body_.size() / block_m)); };
    const int wide = count(0.96), high = count(1.85), deep = count(0.55);
    for (int z = -deep; z < deep; ++z) {
      for (int y = -1; y < high; ++y) {
        for (int x = -wide; x < wide; ++x) visit_block({x * step, y * step, z * step}, block, block_m);
      }
    }
  }

  void visit_block(const Place& from, int block, double block_m) {
    const Vec centre = at(from) + 0.5 * Vec{block_m, block_m, block_m};
    if (std::abs(body_.distance(centre)) > 1.3 * 0.87 * block_m) return;
    check_interrupt();
    for (int k = 0; k < block * block * block; ++k) {
      visit({{from.x + width(0) * (k % block), from.y + width(0) * (k / block % block),
              from.z + width(0) * (k / (block * block))},
             0});
    }
  }

  Place end(const Edge& edge) const {
    Place p = edge.from;
    p[edge.axis] += width(edge.level);
    return p;
  }
  bool is_cut(const Edge& edge) { return (value(edge.from) < 0) != (value(end(edge)) < 0); }

  /// Returns the four leaves about an edge, in turn about its axis.
  std::array<Cell, 4> around(const Edge& edge) const {
    std::array<Cell, 4> cells;
    Place middle{2 * edge.from.x, 2 * edge.from.y, 2 * edge.from.z};
    middle[edge.axis] += width(edge.level);
    constexpr std::array<std::array<int, 2>, 4> turn = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
    for (std::size_t i = 0; i < 4; ++i) {
      Place p = middle;
      p[(edge.axis + 1) % 3] += turn[i][0];
      p[(edge.axis + 2) % 3] += turn[i][1];
      cells[i] = leaf(p);
    }
    return cells;
  }
  /// True if finer cells are adjacent to the edge. Their own edges count then.
  bool is_divided(const Edge& edge) const {
    return std::ranges::any_of(around(edge), [&](const Cell& cell) { return cell.level > edge.level; });
  }

  std::uint32_t vertex(const Cell& cell, const Vec& cut) {
    const auto [found, is_new] = vertex_.try_emplace(cell, static_cast<std::uint32_t>(sum_.size()));
    if (is_new) {
      sum_.push_back({0, 0, 0});
      cuts_.push_back(0);
    }
    sum_[found->second] = sum_[found->second] + cut;
    ++cuts_[found->second];
    return found->second;
  }

  void add_quad(const Edge& edge) {
    const Place last = end(edge);
    const double a = value(edge.from), b = value(last);
    const Vec from = at(edge.from), cut = from + (a / (a - b)) * (at(last) - from);
    std::vector<std::uint32_t> corner;
    for (const Cell& cell : around(edge)) {
      const std::uint32_t v = vertex(cell, cut);
      if (corner.empty() || corner.back() != v) corner.push_back(v);
    }
    if (corner.front() == corner.back()) corner.pop_back();
    if (corner.size() < 3) return;
    if (!(a < 0)) std::ranges::reverse(corner);
    for (std::size_t k = 1; k + 1 < corner.size(); ++k) {
      for (const std::uint32_t v : {corner[0], corner[k], corner[k + 1]}) mesh_.triangle.push_back(v);
    }
  }

  const BodyForm& body_;
  double cell_m_;
  std::unordered_map<Place, double, Hash> value_;
  std::unordered_set<Edge, Hash> seen_;
  std::vector<Edge> edges_;
  std::unordered_map<Cell, std::uint32_t, Hash> vertex_;
  std::vector<Vec> sum_;
  std::vector<std::size_t> cuts_;
  SurfaceMesh mesh_;
};

/// Moves vertices to the mean of their neighbours, and back onto the surface.
void relax(const BodyForm& body, SurfaceMesh& mesh) {
  constexpr int rounds = 5;
  std::vector<Vec> place;
  for (const Vec3<float>& p : mesh.position) place.push_back(to_double(p));
  for (int round = 0; round < rounds; ++round) {
    const std::vector<Vec> mean = neighbour_means(mesh.triangle, place);
    for (std::size_t v = 0; v < place.size(); ++v)
      place[v] = onto_surface(body, 0.4 * place[v] + 0.6 * mean[v], round + 1 < rounds ? 1 : 3);
  }
  for (std::size_t v = 0; v < place.size(); ++v) mesh.position[v] = to_float(place[v]);
}

}  // namespace

std::vector<form::Vec> neighbour_means(std::span<const std::uint32_t> triangle, std::span<const form::Vec> place) {
  std::vector<Vec> mean(place.size(), Vec{0, 0, 0});
  std::vector<double> count(place.size());
  for (std::size_t t = 0; t < triangle.size(); t += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangle[t + k], b = triangle[t + (k + 1) % 3];
      mean[a] = mean[a] + place[b];
      mean[b] = mean[b] + place[a];
      ++count[a];
      ++count[b];
    }
  }
  for (std::size_t v = 0; v < place.size(); ++v) mean[v] = count[v] == 0 ? place[v] : (1 / count[v]) * mean[v];
  return mean;
}

form::Vec onto_surface(const BodyForm& body, Vec p, int steps) {
  check_interrupt();
  constexpr double max_m = 0.02, min_slope = 0.1;
  for (int i = 0; i < steps; ++i) {
    const Vec slope = body.slope(p);
    const double off = body.distance(p) / std::max(dot(slope, slope), min_slope);
    p = p - std::clamp(off, -max_m, max_m) * slope;
  }
  return p;
}

SurfaceMesh mesh_form(const BodyForm& body, double coarseness) {
  SurfaceMesh mesh = Mesher(body, coarseness).run();
  mesh.name = "skin";
  relax(body, mesh);
  return mesh;
}

void split_long_edges(const BodyForm& body, SurfaceMesh& mesh, double longest_m) {
  constexpr int max_rounds = 6;
  for (int round = 0; round < max_rounds; ++round) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle;  // of an edge, by its ends
    const auto middle_of = [&](std::uint32_t a, std::uint32_t b) -> std::optional<std::uint32_t> {
      const Vec p = to_double(mesh.position[a]), q = to_double(mesh.position[b]);
      if (length(q - p) <= longest_m) return std::nullopt;
      const auto [found, is_new] =
          middle.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.position.size()));
      if (is_new) mesh.position.push_back(to_float(onto_surface(body, 0.5 * (p + q), 3)));
      return found->second;
    };
    std::vector<std::uint32_t> finer;
    for (std::size_t t = 0; t < mesh.triangle.size(); t += 3) {
      std::vector<std::uint32_t> corner;  // with the middles of edges that are too long
      std::size_t split = 3;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = mesh.triangle[t + k], b = mesh.triangle[t + (k + 1) % 3];
        corner.push_back(a);
        if (const auto m = middle_of(a, b)) {
          corner.push_back(*m);
          if (split == 3) split = corner.size() - 1;
        }
      }
      // A fan about the first middle, or about a corner if no edge is split.
      const std::size_t n = corner.size(), first = n == 3 ? 0 : split;
      for (std::size_t k = 1; k + 1 < n; ++k)
        finer.insert(finer.end(), {corner[first], corner[(first + k) % n], corner[(first + k + 1) % n]});
    }
    mesh.triangle = std::move(finer);
    if (middle.empty()) return;
  }
}

}  // namespace mobil::inline v0_3
