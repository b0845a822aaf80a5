#include "assets/surfaces/distance_field.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>

#include <mobil/assets/surfaces/form_shapes.h>
#include <mobil/engine/geometry.h>
#include "assets/surfaces/form_mesh.h"

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;

/// Returns the point of the triangle abc that is nearest to p (Ericson, Real-Time Collision Detection, 2005, 5.1.5).
Vec nearest_on(const Vec& p, const Vec& a, const Vec& b, const Vec& c) {
  const Vec ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
               d6 = dot(ac, cp);
  if (d1 <= 0 && d2 <= 0) return a;
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + (d1 / (d1 - d3)) * ab;
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + (d2 / (d2 - d6)) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + ((d4 - d3) / (d4 - d3 + d5 - d6)) * (c - b);
  return a + (vb / (va + vb + vc)) * ab + (vc / (va + vb + vc)) * ac;
}

/// Returns the first indices of the triangles of each connected part.
std::vector<std::vector<std::size_t>> connected_parts(const SurfaceMesh& mesh) {
  std::vector<std::uint32_t> root(mesh.position.size());
  std::iota(root.begin(), root.end(), 0U);
  const auto find = [&](std::uint32_t v) {
    while (root[v] != v) v = root[v] = root[root[v]];
    return v;
  };
  for (std::size_t t = 0; t < mesh.triangle.size(); t += 3) {
    for (std::size_t k = 1; k < 3; ++k) {
      const std::uint32_t a = find(mesh.triangle[t]), b = find(mesh.triangle[t + k]);
      root[std::max(a, b)] = std::min(a, b);
    }
  }
  std::vector<std::vector<std::size_t>> parts;
  std::vector<std::size_t> part_of(mesh.position.size(), parts.max_size());
  for (std::size_t t = 0; t < mesh.triangle.size(); t += 3) {
    std::size_t& part = part_of[find(mesh.triangle[t])];
    if (part == parts.max_size()) {
      part = parts.size();
      parts.emplace_back();
    }
    parts[part].push_back(t);
  }
  return parts;
}

/// A box of samples within a field's grid.
struct Box {
  std::array<int, 3> first, count;
  std::size_t index(int x, int y, int z) const {
    const auto of = [](int i) { return static_cast<std::size_t>(i); };
    return (of(z - first[2]) * of(count[1]) + of(y - first[1])) * of(count[0]) + of(x - first[0]);
  }
  std::size_t size() const {
    return static_cast<std::size_t>(count[0]) * static_cast<std::size_t>(count[1]) * static_cast<std::size_t>(count[2]);
  }
};

std::array<double, 3> words(const Vec& v) {
  return {v.x, v.y, v.z};
}

/// Samples one closed part in its box: the distance to its triangles, and the sides from where rays along x cross them.
class PartSampler {
 public:
  PartSampler(const DistanceField& field, std::span<const std::array<Vec, 3>> triangle)
      : field_(field), triangle_(triangle) {
    std::vector<Vec> corners;
    for (const auto& t : triangle) corners.insert(corners.end(), t.begin(), t.end());
    box_ = around(corners);
    value.assign(box_.size(), static_cast<float>(field.band));
    for (const auto& t : triangle) measure(t);
    find_sides();
  }

  const Box& box() const { return box_; }
  std::vector<float> value;

 private:
  Vec place(int x, int y, int z) const {
    return field_.corner + field_.cell * Vec{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
  }

  /// Returns the samples that are not farther than the band from the box about points.
  Box around(std::span<const Vec> points) const {
    Box box{};
    const auto corner = words(field_.corner);
    for (std::size_t d = 0; d < 3; ++d) {
      double low = std::numeric_limits<double>::max(), high = -low;
      for (const Vec& p : points) low = std::min(low, words(p)[d]), high = std::max(high, words(p)[d]);
      const double first = std::floor((low - field_.band - corner[d]) / field_.cell),
                   last = std::ceil((high + field_.band - corner[d]) / field_.cell);
      box.first[d] = std::max(0, static_cast<int>(first));
      box.count[d] = std::min(field_.count[d] - 1, static_cast<int>(last)) - box.first[d] + 1;
    }
    return box;
  }

  void measure(const std::array<Vec, 3>& t) {
    const Box near = around(t);
    const Vec across = cross(t[1] - t[0], t[2] - t[0]);
    const Vec normal = (1 / std::max(length(across), 1e-30)) * across;
    for (int z = near.first[2]; z < near.first[2] + near.count[2]; ++z) {
      for (int y = near.first[1]; y < near.first[1] + near.count[1]; ++y) {
        for (int x = near.first[0]; x < near.first[0] + near.count[0]; ++x) {
          const Vec p = place(x, y, z);
          float& own = value[box_.index(x, y, z)];
          if (std::abs(dot(normal, p - t[0])) >= static_cast<double>(own)) continue;
          own = std::min(own, static_cast<float>(length(p - nearest_on(p, t[0], t[1], t[2]))));
        }
      }
    }
  }

  /// Makes the samples inside negative: those with more surfaces before them that face back than front.
  void find_sides() {
    struct Crossing {
      double x;
      int turn;
    };
    std::vector<std::vector<Crossing>> row(static_cast<std::size_t>(box_.count[1]) *
                                           static_cast<std::size_t>(box_.count[2]));
    const auto row_of = [&](int y, int z) {
      return static_cast<std::size_t>(z - box_.first[2]) * static_cast<std::size_t>(box_.count[1]) +
             static_cast<std::size_t>(y - box_.first[1]);
    };
    for (const auto& t : triangle_) {
      const Box near = around(t);
      for (int z = near.first[2]; z < near.first[2] + near.count[2]; ++z) {
        for (int y = near.first[1]; y < near.first[1] + near.count[1]; ++y) {
          const Vec p = place(0, y, z);
          // An edge has one sign in both of its triangles: its points are always in one order.
          const auto side = [&](const Vec& a, const Vec& b) {
            const bool in_order = a.y < b.y || (a.y == b.y && (a.z < b.z || (a.z == b.z && a.x < b.x)));
            const Vec &u = in_order ? a : b, &v = in_order ? b : a;
            const double turn = (u.y - p.y) * (v.z - p.z) - (u.z - p.z) * (v.y - p.y);
            return in_order ? turn : -turn;
          };
          const double ab = side(t[0], t[1]), bc = side(t[1], t[2]), ca = side(t[2], t[0]), all = ab + bc + ca;
          if ((ab < 0) != (bc < 0) || (bc < 0) != (ca < 0) || all == 0) continue;
          row[row_of(y, z)].push_back({(bc * t[0].x + ca * t[1].x + ab * t[2].x) / all, all > 0 ? 1 : -1});
        }
      }
    }
    for (int z = box_.first[2]; z < box_.first[2] + box_.count[2]; ++z) {
      for (int y = box_.first[1]; y < box_.first[1] + box_.count[1]; ++y) {
        auto& crossings = row[row_of(y, z)];
        std::ranges::sort(crossings, {}, &Crossing::x);
        std::size_t passed = 0;
        int winding = 0;
        for (int x = box_.first[0]; x < box_.first[0] + box_.count[0]; ++x) {
          const double here = place(x, y, z).x;
          for (; passed < crossings.size() && crossings[passed].x < here; ++passed) winding += crossings[passed].turn;
          float& own = value[box_.index(x, y, z)];
          if (winding != 0) own = -own;
        }
      }
    }
  }

  const DistanceField& field_;
  std::span<const std::array<Vec, 3>> triangle_;
  Box box_{};
};

/// Continues distances inside from those at the band's edge, neighbour by neighbour, there and back (a chamfer
/// transform).
void fill_depths(DistanceField& field) {
  const Box whole{{0, 0, 0}, field.count};
  const auto [nx, ny, nz] = field.count;
  const auto edge = static_cast<float>(-field.band);
  constexpr float unknown = std::numeric_limits<float>::lowest();
  for (float& v : field.value) v = v <= edge ? unknown : v;
  const auto sweep = [&](int dir) {
    for (int k = 1; k + 1 < nz; ++k) {
      for (int j = 1; j + 1 < ny; ++j) {
        for (int i = 1; i + 1 < nx; ++i) {
          const int x = dir > 0 ? i : nx - 1 - i, y = dir > 0 ? j : ny - 1 - j, z = dir > 0 ? k : nz - 1 - k;
          float& own = field.value[whole.index(x, y, z)];
          if (own > edge) continue;
          for (int n = 0; n < 13; ++n) {  // the neighbours that the sweep has passed
            const int dx = n % 3 - 1, dy = n / 3 % 3 - 1, dz = n / 9 - 1;
            const float step = static_cast<float>(field.cell * std::sqrt(dx * dx + dy * dy + dz * dz));
            const float next = field.at(x + dir * dx, y + dir * dy, z + dir * dz);
            if (next != unknown) own = std::max(own, next - step);
          }
        }
      }
    }
  };
  sweep(1);
  sweep(-1);
  for (float& v : field.value) v = v == unknown ? edge : v;
}

/// The cube of eight samples about a point, and the point's place in it (0 to 1).
struct Around {
  std::array<int, 3> first;
  std::array<double, 3> part;
};
bool find_around(const DistanceField& field, const Vec& at, Around& cube) {
  const auto p = words(at), corner = words(field.corner);
  for (std::size_t d = 0; d < 3; ++d) {
    const double cells = (p[d] - corner[d]) / field.cell;
    if (!(cells >= 0) || cells >= field.count[d] - 1) return false;
    cube.first[d] = static_cast<int>(cells);
    cube.part[d] = cells - cube.first[d];
  }
  return true;
}

/// Fills the outer sample nearest to the surface wherever two inner samples touch only across a square of four. The
/// surface would touch itself there, so that four of its triangles meet at one edge.
DistanceField without_pinches(DistanceField field) {
  const Box whole{{0, 0, 0}, field.count};
  const float filled = static_cast<float>(-1e-3 * field.cell);
  for (bool changed = true; changed;) {
    changed = false;
    for (int z = 0; z + 1 < field.count[2]; ++z) {
      for (int y = 0; y + 1 < field.count[1]; ++y) {
        for (int x = 0; x + 1 < field.count[0]; ++x) {
          if (std::abs(static_cast<double>(field.at(x, y, z))) > 2 * field.cell) continue;
          for (std::size_t axis = 0; axis < 3; ++axis) {
            std::array<int, 3> u{}, v{};
            u[(axis + 1) % 3] = v[(axis + 2) % 3] = 1;
            const auto sample = [&](int a, int b) -> float& {
              return field
                  .value[whole.index(x + a * u[0] + b * v[0], y + a * u[1] + b * v[1], z + a * u[2] + b * v[2])];
            };
            float &p = sample(0, 0), &q = sample(1, 1), &r = sample(1, 0), &s = sample(0, 1);
            if ((p < 0) != (q < 0) || (r < 0) != (s < 0) || (p < 0) == (r < 0)) continue;
            (p < 0 ? (r < s ? r : s) : (p < q ? p : q)) = filled;
            changed = true;
          }
        }
      }
    }
  }
  return field;
}

}  // namespace

DistanceField distance_field(const SurfaceMesh& mesh, double cell, double band, double rounding) {
  DistanceField field{{0, 0, 0}, cell, band, {}, {}};
  if (mesh.triangle.empty()) return field;
  std::array<double, 3> low{}, high{};
  low.fill(std::numeric_limits<double>::max());
  high.fill(std::numeric_limits<double>::lowest());
  for (const auto& p : mesh.position) {
    const auto own = words(to_double(p));
    for (std::size_t d = 0; d < 3; ++d) low[d] = std::min(low[d], own[d]), high[d] = std::max(high[d], own[d]);
  }
  // Grid lines off the round numbers of drawn shapes, so that they do not run along edges.
  constexpr std::array<double, 3> off = {0.3729, 0.4153, 0.3317};
  std::array<double, 3> corner{};
  for (std::size_t d = 0; d < 3; ++d) {
    corner[d] = low[d] - band - (1 + off[d]) * cell;
    field.count[d] = static_cast<int>(std::ceil((high[d] + band - corner[d]) / cell)) + 2;
  }
  field.corner = {corner[0], corner[1], corner[2]};
  const Box whole{{0, 0, 0}, field.count};
  field.value.assign(whole.size(), static_cast<float>(band));
  for (const auto& part : connected_parts(mesh)) {
    std::vector<std::array<Vec, 3>> triangles;
    for (const std::size_t t : part) {
      const auto corner_of = [&](std::size_t k) { return to_double(mesh.position[mesh.triangle[t + k]]); };
      triangles.push_back({corner_of(0), corner_of(1), corner_of(2)});
    }
    const PartSampler sampled(field, triangles);
    const Box& box = sampled.box();
    for (int z = box.first[2]; z < box.first[2] + box.count[2]; ++z) {
      for (int y = box.first[1]; y < box.first[1] + box.count[1]; ++y) {
        for (int x = box.first[0]; x < box.first[0] + box.count[0]; ++x) {
          float& own = field.value[whole.index(x, y, z)];
          const float other = sampled.value[box.index(x, y, z)];
          own = rounding > 0 ? static_cast<float>(
                                   form::smooth_union(static_cast<double>(own), static_cast<double>(other), rounding))
                             : std::min(own, other);
        }
      }
    }
  }
  fill_depths(field);
  return field;
}

double distance(const DistanceField& field, const Vec& at) {
  Around cube{};
  if (!find_around(field, at, cube)) return field.band;
  double sum = 0;
  for (int c = 0; c < 8; ++c) {
    const int x = c & 1, y = c >> 1 & 1, z = c >> 2;
    const double weight = (x != 0 ? cube.part[0] : 1 - cube.part[0]) * (y != 0 ? cube.part[1] : 1 - cube.part[1]) *
                          (z != 0 ? cube.part[2] : 1 - cube.part[2]);
    sum += weight * static_cast<double>(field.at(cube.first[0] + x, cube.first[1] + y, cube.first[2] + z));
  }
  return sum;
}

Vec slope(const DistanceField& field, const Vec& at) {
  const double step = 0.5 * field.cell;
  const auto across = [&](const Vec& off) {
    return (distance(field, at + off) - distance(field, at - off)) / (2 * step);
  };
  return {across({step, 0, 0}), across({0, step, 0}), across({0, 0, step})};
}

SurfaceMesh zero_surface(const DistanceField& sampled) {
  const DistanceField field = without_pinches(sampled);
  SurfaceMesh mesh;
  constexpr std::uint32_t none = ~std::uint32_t{0};
  const auto [nx, ny, nz] = field.count;
  const Box cells{{0, 0, 0}, {nx - 1, ny - 1, nz - 1}};
  std::vector<std::uint32_t> vertex(cells.size(), none);
  std::vector<Vec> place;
  const auto inside = [&](int x, int y, int z) { return field.at(x, y, z) < 0; };
  for (int z = 0; z + 1 < nz; ++z) {
    for (int y = 0; y + 1 < ny; ++y) {
      for (int x = 0; x + 1 < nx; ++x) {
        if (std::abs(static_cast<double>(field.at(x, y, z))) > 2 * field.cell) continue;
        Vec sum{0, 0, 0};
        int cuts = 0;
        for (int axis = 0; axis < 3; ++axis) {
          for (int side = 0; side < 4; ++side) {
            std::array<int, 3> a = {x, y, z};
            a[static_cast<std::size_t>((axis + 1) % 3)] += side & 1;
            a[static_cast<std::size_t>((axis + 2) % 3)] += side >> 1;
            std::array<int, 3> b = a;
            ++b[static_cast<std::size_t>(axis)];
            const double da = static_cast<double>(field.at(a[0], a[1], a[2])),
                         db = static_cast<double>(field.at(b[0], b[1], b[2]));
            if ((da < 0) == (db < 0)) continue;
            std::array<double, 3> cut = {1.0 * a[0], 1.0 * a[1], 1.0 * a[2]};
            cut[static_cast<std::size_t>(axis)] += da / (da - db);
            sum = sum + Vec{cut[0], cut[1], cut[2]};
            ++cuts;
          }
        }
        if (cuts == 0) continue;
        vertex[cells.index(x, y, z)] = static_cast<std::uint32_t>(place.size());
        place.push_back(field.corner + (field.cell / cuts) * sum);
      }
    }
  }
  const auto quad = [&](std::array<std::uint32_t, 4> corner, bool turned) {
    if (turned) std::swap(corner[1], corner[3]);
    for (const std::size_t k : {0, 1, 2, 0, 2, 3}) mesh.triangle.push_back(corner[k]);
  };
  const auto of = [&](int x, int y, int z) { return vertex[cells.index(x, y, z)]; };
  for (int z = 1; z + 1 < nz; ++z) {
    for (int y = 1; y + 1 < ny; ++y) {
      for (int x = 1; x + 1 < nx; ++x) {
        const bool here = inside(x, y, z);
        if (here != inside(x + 1, y, z))
          quad({of(x, y - 1, z - 1), of(x, y, z - 1), of(x, y, z), of(x, y - 1, z)}, !here);
        if (here != inside(x, y + 1, z))
          quad({of(x - 1, y, z - 1), of(x - 1, y, z), of(x, y, z), of(x, y, z - 1)}, !here);
        if (here != inside(x, y, z + 1))
          quad({of(x - 1, y - 1, z), of(x, y - 1, z), of(x, y, z), of(x - 1, y, z)}, !here);
      }
    }
  }
  constexpr int rounds = 3;
  for (int round = 0; round < rounds; ++round) {
    const std::vector<Vec> mean = neighbour_means(mesh.triangle, place);
    for (std::size_t v = 0; v < place.size(); ++v) {
      const Vec moved = 0.5 * (place[v] + mean[v]), out = slope(field, moved);
      place[v] = moved - (distance(field, moved) / std::max(dot(out, out), 0.25)) * out;
    }
  }
  for (const Vec& p : place) mesh.position.push_back(to_float(p));
  return mesh;
}

Vec nearest_point(const SurfaceMesh& mesh, const Vec& to) {
  Vec best{};
  double least = std::numeric_limits<double>::max();
  for (std::size_t t = 0; t < mesh.triangle.size(); t += 3) {
    const auto corner = [&](std::size_t k) { return to_double(mesh.position[mesh.triangle[t + k]]); };
    const Vec a = corner(0);
    const Vec q = nearest_on(to, a, corner(1), corner(2));
    if (const double d = dot(q - to, q - to); d < least) least = d, best = q;
  }
  return best;
}

}  // namespace mobil::inline v0_3
