#include "assets/import/mend_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <mobil/assets/import/mesh_edges.h>
#include <mobil/engine/geometry.h>
#include "assets/import/union_find.h"

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;

constexpr std::uint32_t no_edge = ~0U;

/// Returns the edge of the neighbouring triangle, none at a border; nothing if an edge has more than two triangles.
std::optional<std::vector<std::uint32_t>> twin_edges(const SurfaceMesh& mesh) {
  const auto sorted = sorted_edges(mesh);
  std::vector<std::uint32_t> twin(sorted.size(), no_edge);
  bool surface = true;
  each_edge(sorted, [&](std::size_t first, std::size_t last) {
    surface = surface && last - first <= 2;
    if (last - first != 2) return;
    twin[sorted[first].edge] = sorted[first + 1].edge;
    twin[sorted[first + 1].edge] = sorted[first].edge;
  });
  if (!surface) return std::nullopt;
  return twin;
}

Vec corner_of(const SurfaceMesh& mesh, std::size_t corner) {
  return to_double(mesh.position[mesh.triangle[corner]]);
}

double double_area(const Vec& a, const Vec& b, const Vec& c) {
  return length(cross(b - a, c - a));
}

/// Follows open edges from `start` back to it. Returns the border's vertices in order; none if they do not lead back.
std::vector<std::uint32_t> border_loop(const std::vector<std::uint32_t>& next, std::uint32_t start) {
  std::vector<std::uint32_t> loop;
  for (std::uint32_t v = start; loop.empty() || v != start; v = next[v]) {
    if (v == no_edge || loop.size() > next.size()) return {};
    loop.push_back(v);
  }
  return loop;
}

}  // namespace

std::size_t drop_doubled(SurfaceMesh& mesh) {
  const std::size_t triangles = mesh.triangle.size() / 3;
  std::vector<bool> suspect(triangles, false);
  const auto sorted = sorted_edges(mesh);
  each_edge(sorted, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; last - first > 2 && i < last; ++i) suspect[sorted[i].edge / 3] = true;
  });
  using Key = std::pair<std::array<std::uint32_t, 3>, std::size_t>;
  std::vector<Key> key;
  for (std::size_t t = 0; t < triangles; ++t) {
    if (!suspect[t]) continue;
    std::array<std::uint32_t, 3> corner = {mesh.triangle[3 * t], mesh.triangle[3 * t + 1], mesh.triangle[3 * t + 2]};
    std::sort(corner.begin(), corner.end());
    key.emplace_back(corner, t);
  }
  std::sort(key.begin(), key.end());
  std::vector<bool> goes(triangles, false);
  std::size_t dropped = 0;
  for (std::size_t i = 1; i < key.size(); ++i) {
    if (key[i].first != key[i - 1].first) continue;
    goes[key[i].second] = true;
    ++dropped;
  }
  std::size_t kept = 0;
  for (std::size_t t = 0; dropped > 0 && t < triangles; ++t) {
    if (goes[t]) continue;
    for (std::size_t c = 0; c < 3; ++c) mesh.triangle[kept++] = mesh.triangle[3 * t + c];
  }
  if (dropped > 0) mesh.triangle.resize(kept);
  return dropped;
}

std::optional<std::size_t> wind_alike(SurfaceMesh& mesh) {
  const auto twin = twin_edges(mesh);
  if (!twin) return std::nullopt;
  const auto triangles = static_cast<std::uint32_t>(mesh.triangle.size() / 3);
  enum State : std::uint8_t { unknown, stays, turns };
  std::vector<State> state(triangles, unknown);
  std::vector<std::uint32_t> piece;
  std::size_t turned = 0;
  for (std::uint32_t start = 0; start < triangles; ++start) {
    if (state[start] != unknown) continue;
    piece.assign(1, start);
    state[start] = stays;
    std::size_t turning = 0;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const std::uint32_t t = piece[i];
      for (std::uint32_t e = 3 * t; e < 3 * t + 3; ++e) {
        const std::uint32_t other = (*twin)[e];
        if (other == no_edge) continue;
        const bool alike = mesh.triangle[e] != mesh.triangle[other];
        const State wanted = alike == (state[t] == stays) ? stays : turns;
        State& its = state[other / 3];
        if (its == unknown) {
          its = wanted;
          turning += wanted == turns ? 1 : 0;
          piece.push_back(other / 3);
        } else if (its != wanted) {
          return std::nullopt;
        }
      }
    }
    const bool others = 2 * turning > piece.size();
    for (const std::uint32_t t : piece) {
      if ((state[t] == turns) != others) std::swap(mesh.triangle[3 * t + 1], mesh.triangle[3 * t + 2]);
    }
    turned += others ? piece.size() - turning : turning;
  }
  return turned;
}

std::size_t split_pinches(SurfaceMesh& mesh) {
  const auto twin = twin_edges(mesh);
  if (!twin) return 0;
  UnionFind fans(mesh.triangle.size());  // of corners
  for (std::uint32_t e = 0; e < mesh.triangle.size(); ++e) {
    const std::uint32_t other = (*twin)[e];
    if (other == no_edge || mesh.triangle[e] == mesh.triangle[other]) continue;
    fans.join(e, next_corner(other));
    fans.join(next_corner(e), other);
  }
  std::vector<std::uint32_t> first_fan(mesh.position.size(), no_edge);
  std::vector<bool> pinched(mesh.position.size(), false);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> moved;  // fan and its new vertex
  std::vector<std::uint32_t> vertex_of_fan(mesh.triangle.size(), no_edge);
  for (std::uint32_t c = 0; c < mesh.triangle.size(); ++c) {
    const std::uint32_t fan = fans.find(c), v = mesh.triangle[c];
    if (vertex_of_fan[fan] == no_edge) {
      const bool is_first = first_fan[v] == no_edge;
      if (is_first) {
        first_fan[v] = fan;
        vertex_of_fan[fan] = v;
      } else {
        pinched[v] = true;
        vertex_of_fan[fan] = static_cast<std::uint32_t>(mesh.position.size());
        const auto copy = mesh.position[v];
        mesh.position.push_back(copy);
      }
    }
    mesh.triangle[c] = vertex_of_fan[fan];
  }
  return static_cast<std::size_t>(std::count(pinched.begin(), pinched.end(), true));
}

ClosedHoles close_holes(SurfaceMesh& mesh, double each, double all) {
  ClosedHoles holes;
  const auto twin = twin_edges(mesh);
  if (!twin) return holes;
  std::vector<std::uint32_t> next(mesh.position.size(), no_edge), start;
  double area = 0;
  for (std::uint32_t e = 0; e < mesh.triangle.size(); ++e) {
    if (e % 3 == 0) area += double_area(corner_of(mesh, e), corner_of(mesh, e + 1), corner_of(mesh, e + 2));
    if ((*twin)[e] != no_edge) continue;
    next[mesh.triangle[e]] = mesh.triangle[next_corner(e)];
    start.push_back(mesh.triangle[e]);
  }
  std::vector<bool> seen(mesh.position.size(), false);
  for (const std::uint32_t v : start) {
    if (seen[v]) continue;
    const auto loop = border_loop(next, v);
    for (const auto u : loop) seen[u] = true;
    Vec middle{0, 0, 0};
    for (const auto u : loop) middle = middle + (1.0 / static_cast<double>(loop.size())) * to_double(mesh.position[u]);
    double closing = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const auto &a = mesh.position[loop[i]], &b = mesh.position[loop[(i + 1) % loop.size()]];
      closing += double_area(to_double(a), to_double(b), middle);
    }
    if (loop.size() < 3 || closing > each * area || holes.share * area + closing > all * area) {
      ++holes.left;
      continue;
    }
    ++holes.closed;
    holes.share += closing / area;
    if (loop.size() == 3) {
      mesh.triangle.insert(mesh.triangle.end(), {loop[0], loop[2], loop[1]});
      continue;
    }
    const auto centre = static_cast<std::uint32_t>(mesh.position.size());
    mesh.position.push_back(to_float(middle));
    for (std::size_t i = 0; i < loop.size(); ++i) {
      mesh.triangle.insert(mesh.triangle.end(), {loop[(i + 1) % loop.size()], loop[i], centre});
    }
  }
  return holes;
}

double times_inside_others(const SurfaceMesh& mesh, const Pieces& pieces, std::uint32_t piece) {
  const auto own = static_cast<std::size_t>(std::find(pieces.of.begin(), pieces.of.end(), piece) - pieces.of.begin());
  const Vec p = corner_of(mesh, 3 * own);
  double angle = 0;
  for (std::size_t t = 0; t < pieces.of.size(); ++t) {
    if (pieces.of[t] == piece) continue;
    const Vec a = corner_of(mesh, 3 * t) - p, b = corner_of(mesh, 3 * t + 1) - p, c = corner_of(mesh, 3 * t + 2) - p;
    const double la = length(a), lb = length(b), lc = length(c);
    angle += 2 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  return angle / (4 * std::numbers::pi);
}

std::size_t turn_outwards(SurfaceMesh& mesh, const Pieces& pieces) {
  const std::vector<double> volume = piece_volumes(mesh, pieces);
  const auto largest =
      std::max_element(volume.begin(), volume.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  if (largest == volume.end()) return 0;
  const auto main = static_cast<std::uint32_t>(largest - volume.begin());
  const bool main_turns = *largest < 0;
  const std::vector<std::size_t> triangles = piece_triangles(pieces);
  std::vector<bool> turns(pieces.count, false);
  for (std::uint32_t p = 0; p < pieces.count; ++p) {
    turns[p] = volume[p] < 0;
    const bool large = 100 * triangles[p] >= pieces.of.size();  // few enough to compare each with all
    if (p == main || !large || turns[p] == main_turns) continue;
    if (std::abs(times_inside_others(mesh, pieces, p)) > 0.5) turns[p] = main_turns;
  }
  for (std::size_t t = 0; t < pieces.of.size(); ++t) {
    if (turns[pieces.of[t]]) std::swap(mesh.triangle[3 * t + 1], mesh.triangle[3 * t + 2]);
  }
  return static_cast<std::size_t>(std::count(turns.begin(), turns.end(), true));
}

}  // namespace mobil::inline v0_3
