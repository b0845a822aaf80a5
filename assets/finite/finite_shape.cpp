#include "assets/finite/finite_shape.h"

#include <algorithm>
#include <cmath>

#include "assets/finite/shape_tables.h"

namespace mobil::inline v0_3 {
namespace {

constexpr Cells tabled_cells = {2, 2, 8};

/// Weights of a table's points along one direction.
template <std::size_t points>
using PointWeights = std::array<double, points>;

/// Returns the weights of Lagrange's polynomial through `count` of the places from `first` on.
template <std::size_t points>
PointWeights<points> through(const std::array<double, points>& places, std::size_t first, std::size_t count, double x) {
  PointWeights<points> weight{};
  for (std::size_t i = first; i < first + count; ++i) {
    weight[i] = 1;
    for (std::size_t j = first; j < first + count; ++j) {
      if (j != i) weight[i] *= (x - places[j]) / (places[i] - places[j]);
    }
  }
  return weight;
}

PointWeights<3> across(std::uint32_t node, std::uint32_t cells) {
  return through<3>({0, 1, 2}, 0, 3, 2.0 * node / cells);
}

PointWeights<9> along(const std::array<double, 9>& sections, double z) {
  const auto above = std::ranges::upper_bound(sections, z) - sections.begin();
  return through(sections, static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(above - 2, 0, 5)), 4, z);
}

/// Returns the positions of the table's sections in the template, over its length.
std::array<double, 9> tabled_sections(Muscle muscle) {
  const HexahedralMesh mesh = finite_mesh(muscle, tabled_cells);
  std::array<double, 9> z{};
  for (std::uint32_t k = 0; k < z.size(); ++k)
    z[k] = mesh.node[node_index(tabled_cells, 0, 0, k)].z / mesh.node.back().z;
  return z;
}

}  // namespace

FiniteShape make_finite_shape(Muscle muscle, const HexahedralMesh& mesh, const StaticStretch& stretch) {
  const ShapeTable table = shape_table(muscle);
  const std::array<double, 9> sections = tabled_sections(muscle);
  const double first_z = mesh.node.front().z, length = mesh.node.back().z - first_z;
  const std::size_t components = 3 * mesh.node.size();
  FiniteShape shape;
  shape.cells = mesh.cells;
  shape.length_m = static_cast<float>(length);
  shape.vector.resize(shape_modes * components);
  shape.even.resize(components);
  shape.stretch.assign(stretch.displacement.begin(), stretch.displacement.end());
  const auto& [nx, ny, nz] = mesh.cells;
  for (std::uint32_t k = 0, n = 0; k <= nz; ++k) {
    for (std::uint32_t j = 0; j <= ny; ++j) {
      for (std::uint32_t i = 0; i <= nx; ++i, ++n) {
        const double part = (mesh.node[n].z - first_z) / length;
        shape.even[std::size_t{3} * n + 2] = static_cast<float>(part);
        if (k == 0 || k == nz) continue;  // both ends move as one
        const auto x = across(i, nx), y = across(j, ny);
        const auto z = along(sections, part);
        for (std::size_t c = 0; c < 3; ++c) {
          for (std::size_t v = 0; v < shape_modes; ++v) {
            double sum = 0;
            for (std::uint32_t kk = 1; kk < 8; ++kk) {  // the table has no ends: they are zero
              for (std::uint32_t at = 0; at < 9; ++at)
                sum += z[kk] * y[at / 3] * x[at % 3] * table.vector[v][3 * (9 * (kk - 1) + at) + c];
            }
            shape.vector[(std::size_t{3} * n + c) * shape_modes + v] = static_cast<float>(sum);
          }
        }
      }
    }
  }
  for (std::size_t v = 0; v < shape_modes; ++v) {
    for (std::size_t f = 0; f < shape_amount_count; ++f) {
      for (std::size_t t = 0; t < shape_ratio_terms; ++t)
        shape.coefficient[v][f][t] = static_cast<float>(table.coefficient[t][v][f]);
    }
  }
  return shape;
}

}  // namespace mobil::inline v0_3
