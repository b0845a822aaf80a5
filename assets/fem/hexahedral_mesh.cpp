#include <mobil/assets/fem/hexahedral_mesh.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <mobil/engine/geometry.h>
#include "engine/exact_math.h"

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;

double determinant(const Vec& a, const Vec& b, const Vec& c) {
  return dot(a, cross(b, c));
}

Result<void> check_stations(std::span<const LatticeStation> stations) {
  if (stations.size() < 2) return fail("a bent block needs at least two stations, at t = 0 and t = 1");
  for (std::size_t s = 0; s < stations.size(); ++s) {
    const LatticeStation& c = stations[s];
    if (!(std::isfinite(c.t) && std::isfinite(c.offset_x_m) && std::isfinite(c.offset_y_m))) {
      return fail(fmt::format("station {}: t and offsets must be finite numbers", s));
    }
    if (!(c.semi_x_m > 1e-6F && c.semi_x_m < 10 && c.semi_y_m > 1e-6F && c.semi_y_m < 10)) {
      return fail(
          fmt::format("station {}: half-widths {} and {} m must lie between 1e-6 and 10 m", s, c.semi_x_m, c.semi_y_m));
    }
    if (!(c.semi_x_m * c.semi_y_m - c.shear_x_m * c.shear_y_m > 1e-12F)) {
      return fail(fmt::format("station {}: shears {} and {} m fold half-widths {} and {} m over; make them smaller", s,
                              c.shear_x_m, c.shear_y_m, c.semi_x_m, c.semi_y_m));
    }
    if (s > 0 && !(c.t > stations[s - 1].t)) {
      return fail(fmt::format("station {}: t = {} does not follow {}; sort the stations", s, c.t, stations[s - 1].t));
    }
  }
  if (stations.front().t != 0 || stations.back().t != 1) {
    return fail(fmt::format("stations run from t = {} to {}; they must run from 0 to 1", stations.front().t,
                            stations.back().t));
  }
  return {};
}

Result<void> check_grading(const Grading& grading) {
  for (const double ratio : {grading.across, grading.along}) {
    if (ratio >= 0.01 && ratio <= 100) continue;
    return fail(
        fmt::format("grading {} across and {} along: each must lie between 0.01 and 100 (1: all elements alike)",
                    grading.across, grading.along));
  }
  return {};
}

/// Returns the planes between `count` elements, in mean element lengths from the first. They are a function of only i /
/// count, so meshes nest, and are rounded, so machines whose logarithms differ make the same mesh.
std::vector<double> graded_planes(std::uint32_t count, double ratio) {
  std::vector<double> planes(count + 1);
  const double steepness = exact::log(ratio);
  for (std::uint32_t i = 0; i <= count / 2; ++i) {
    const double part = 2.0 * i / count;  // of the way to the middle
    const double share =
        ratio == 1 ? part : std::ldexp(std::round(std::ldexp(exact::expm1(part * steepness) / (ratio - 1), 40)), -40);
    planes[i] = 0.5 * count * share;
    planes[count - i] = count - planes[i];
  }
  return planes;
}

LatticeStation station_at(std::span<const LatticeStation> stations, double t) {
  std::size_t upper = 1;
  while (upper + 1 < stations.size() && t > static_cast<double>(stations[upper].t)) ++upper;
  const LatticeStation& a = stations[upper - 1];
  const LatticeStation& b = stations[upper];
  const auto s = static_cast<float>((t - static_cast<double>(a.t)) / static_cast<double>(b.t - a.t));
  const auto mix = [s](float p, float q) { return p + s * (q - p); };
  return {static_cast<float>(t),        mix(a.offset_x_m, b.offset_x_m), mix(a.offset_y_m, b.offset_y_m),
          mix(a.semi_x_m, b.semi_x_m),  mix(a.semi_y_m, b.semi_y_m),     mix(a.shear_x_m, b.shear_x_m),
          mix(a.shear_y_m, b.shear_y_m)};
}

/// A corner's three edges, right-handed: the corner, and its neighbours along x, y and z.
constexpr std::array<std::array<std::uint8_t, 4>, 8> corner_edges = {
    {{0, 1, 3, 4}, {1, 2, 0, 5}, {2, 3, 1, 6}, {3, 0, 2, 7}, {4, 7, 5, 0}, {5, 4, 6, 1}, {6, 5, 7, 2}, {7, 6, 4, 3}}};

}  // namespace

Result<void> check_cells(const Cells& cells) {
  for (const auto n : cells) {
    if (n < 1 || n > 256) {
      return fail(fmt::format("cells {}x{}x{}: each must be 1 to 256", cells[0], cells[1], cells[2]));
    }
  }
  if (node_count(cells) > largest_mesh_nodes) {
    return fail(fmt::format("cells {}x{}x{} make {} nodes; at most {} are taken, use fewer cells", cells[0], cells[1],
                            cells[2], node_count(cells), largest_mesh_nodes));
  }
  return {};
}

Hexahedron element_nodes(const Cells& cells, std::uint32_t element) {
  const std::uint32_t i = element % cells[0];
  const std::uint32_t j = element / cells[0] % cells[1];
  const std::uint32_t k = element / (cells[0] * cells[1]);
  const auto at = [&](std::uint32_t di, std::uint32_t dj, std::uint32_t dk) {
    return node_index(cells, i + di, j + dj, k + dk);
  };
  return {at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0), at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)};
}

std::vector<Quad> boundary_quads(const Cells& cells) {
  std::vector<Quad> quads;
  const auto [nx, ny, nz] = cells;
  const auto at = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) { return node_index(cells, i, j, k); };
  for (std::uint32_t j = 0; j < ny; ++j) {
    for (std::uint32_t i = 0; i < nx; ++i) {
      quads.push_back({at(i, j, 0), at(i, j + 1, 0), at(i + 1, j + 1, 0), at(i + 1, j, 0)});
    }
  }
  for (std::uint32_t k = 0; k < nz; ++k) {
    for (std::uint32_t i = 0; i < nx; ++i) {
      quads.push_back({at(i, 0, k), at(i + 1, 0, k), at(i + 1, 0, k + 1), at(i, 0, k + 1)});
      quads.push_back({at(i, ny, k), at(i, ny, k + 1), at(i + 1, ny, k + 1), at(i + 1, ny, k)});
    }
    for (std::uint32_t j = 0; j < ny; ++j) {
      quads.push_back({at(0, j, k), at(0, j, k + 1), at(0, j + 1, k + 1), at(0, j + 1, k)});
      quads.push_back({at(nx, j, k), at(nx, j + 1, k), at(nx, j + 1, k + 1), at(nx, j, k + 1)});
    }
  }
  const auto far = insertion_quads(cells);
  quads.insert(quads.end(), far.begin(), far.end());
  return quads;
}

std::vector<Quad> insertion_quads(const Cells& cells) {
  std::vector<Quad> quads;
  for (std::uint32_t e = element_count(cells) - cells[0] * cells[1]; e < element_count(cells); ++e) {
    const Hexahedron h = element_nodes(cells, e);
    quads.push_back({h[4], h[5], h[6], h[7]});
  }
  return quads;
}

std::vector<std::uint32_t> insertion_centre(const Cells& cells) {
  std::vector<std::uint32_t> nodes;
  for (std::uint32_t j = cells[1] / 2; j <= (cells[1] + 1) / 2; ++j) {
    for (std::uint32_t i = cells[0] / 2; i <= (cells[0] + 1) / 2; ++i) {
      nodes.push_back(node_index(cells, i, j, cells[2]));
    }
  }
  return nodes;
}

Result<HexahedralMesh> make_block(const Cells& cells, double cell_size_m, const Grading& grading) {
  if (auto ok = check_cells(cells); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_grading(grading); !ok) return tl::unexpected(ok.error());
  if (!(cell_size_m >= 1e-6 && cell_size_m <= 10)) {
    return fail(fmt::format("cell size {} m must lie between 1e-6 and 10 m", cell_size_m));
  }
  const auto x = graded_planes(cells[0], grading.across), y = graded_planes(cells[1], grading.across),
             z = graded_planes(cells[2], grading.along);
  HexahedralMesh mesh{cells, {}};
  mesh.node.reserve(node_count(cells));
  for (const double c : z) {
    for (const double b : y) {
      for (const double a : x) {
        mesh.node.push_back({(a - 0.5 * cells[0]) * cell_size_m, (b - 0.5 * cells[1]) * cell_size_m, c * cell_size_m});
      }
    }
  }
  return mesh;
}

Result<HexahedralMesh> bend_block(const Cells& cells, std::span<const LatticeStation> stations, double length_m,
                                  const Grading& grading) {
  if (auto ok = check_cells(cells); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_grading(grading); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_stations(stations); !ok) return tl::unexpected(ok.error());
  if (!(length_m >= 1e-6 && length_m <= 10)) {
    return fail(fmt::format("belly length {} m must lie between 1e-6 and 10 m", length_m));
  }
  // At three fifths the corner's scaled Jacobian tends to 0.58 as the grid is refined; a full disc's tends to 0.
  constexpr double roundness = 0.6;
  const auto columns = graded_planes(cells[0], grading.across), rows = graded_planes(cells[1], grading.across),
             planes = graded_planes(cells[2], grading.along);
  HexahedralMesh mesh{cells, {}};
  mesh.node.reserve(node_count(cells));
  for (const double plane : planes) {
    const double t = plane / cells[2];
    const LatticeStation s = station_at(stations, t);
    for (const double row : rows) {
      for (const double column : columns) {
        const double a = 2 * column / cells[0] - 1, b = 2 * row / cells[1] - 1;
        const double x = a * (1 + roundness * (std::sqrt(1 - 0.5 * b * b) - 1));
        const double y = b * (1 + roundness * (std::sqrt(1 - 0.5 * a * a) - 1));
        const auto reach = [x, y](float from, float along_x, float along_y) {
          return static_cast<double>(from) + static_cast<double>(along_x) * x + static_cast<double>(along_y) * y;
        };
        mesh.node.push_back(
            {reach(s.offset_x_m, s.semi_x_m, s.shear_x_m), reach(s.offset_y_m, s.shear_y_m, s.semi_y_m), t * length_m});
      }
    }
  }
  if (auto ok = check_elements(mesh); !ok) return tl::unexpected(ok.error());
  return mesh;
}

double volume(const HexahedralMesh& mesh) {
  double sum = 0;
  for (const Quad& q : boundary_quads(mesh.cells)) {
    const Vec &a = mesh.node[q[0]], &b = mesh.node[q[1]], &c = mesh.node[q[2]], &d = mesh.node[q[3]];
    // a bilinear patch sweeps the mean of its two triangulations
    sum += determinant(a, b - d, c) + determinant(d, a - c, b);
  }
  return sum / 12;
}

double scaled_jacobian(const HexahedralMesh& mesh, std::uint32_t element) {
  const Hexahedron h = element_nodes(mesh.cells, element);
  double smallest = 1;
  for (const auto& [corner, x, y, z] : corner_edges) {
    const Vec& p = mesh.node[h[corner]];
    const Vec a = mesh.node[h[x]] - p, b = mesh.node[h[y]] - p, c = mesh.node[h[z]] - p;
    const double edges = length(a) * length(b) * length(c);
    smallest = std::min(smallest, edges > 0 && std::isfinite(edges) ? determinant(a, b, c) / edges : 0.0);
  }
  return smallest;
}

double smallest_scaled_jacobian(const HexahedralMesh& mesh) {
  double smallest = 1;
  for (std::uint32_t e = 0; e < element_count(mesh.cells); ++e) smallest = std::min(smallest, scaled_jacobian(mesh, e));
  return smallest;
}

std::string element_label(const Cells& cells, std::uint32_t element) {
  const auto [nx, ny, nz] = cells;
  return fmt::format("element {} (cell {},{},{} of {}x{}x{})", element, element % nx, element / nx % ny,
                     element / (nx * ny), nx, ny, nz);
}

Result<void> check_elements(const HexahedralMesh& mesh) {
  if (mesh.node.size() != node_count(mesh.cells)) {
    return fail(fmt::format("cells {}x{}x{} need {} nodes, not {}", mesh.cells[0], mesh.cells[1], mesh.cells[2],
                            node_count(mesh.cells), mesh.node.size()));
  }
  for (std::uint32_t e = 0; e < element_count(mesh.cells); ++e) {
    const double quality = scaled_jacobian(mesh, e);
    if (quality >= min_scaled_jacobian) continue;
    return fail(fmt::format(
        "{} is {}: scaled Jacobian {:.3g}, must be at least {}; bring its stations closer together in offset or widen "
        "them",
        element_label(mesh.cells, e), quality > 0 ? "nearly flat" : "inverted or flat", quality, min_scaled_jacobian));
  }
  return {};
}

}  // namespace mobil::inline v0_3
