#include "assets/fem/element_size.h"

#include <algorithm>
#include <cmath>

#include <mobil/engine/geometry.h>
#include "assets/fem/stiffness_terms.h"

namespace mobil::inline v0_3 {
using namespace geometry;

double compression_wave_speed(const Material& m) {
  return std::sqrt(m.young_pa * (1 - m.poisson) / ((1 + m.poisson) * (1 - 2 * m.poisson) * m.density_kg_m3));
}

double largest_element_m(const Material& material) {
  return compression_wave_speed(material) / (elements_per_wavelength * highest_load_hz);
}

double longest_edge_m(const HexahedralMesh& mesh) {
  double longest = 0;
  const auto reach = [&](std::uint32_t from, std::uint32_t to) {
    longest = std::max(longest, length(mesh.node[to] - mesh.node[from]));
  };
  for_each_node(mesh.cells, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    const std::uint32_t n = node_index(mesh.cells, i, j, k);
    if (i < mesh.cells[0]) reach(n, n + 1);
    if (j < mesh.cells[1]) reach(n, node_index(mesh.cells, i, j + 1, k));
    if (k < mesh.cells[2]) reach(n, node_index(mesh.cells, i, j, k + 1));
  });
  return longest;
}

}  // namespace mobil::inline v0_3
