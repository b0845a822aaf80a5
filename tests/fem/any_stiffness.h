#pragma once
// Random bellies, materials and elements, and the stencil as a dense matrix, for tests of stiffness and critical steps.

#include <rapidcheck.h>

#include <vector>

#include "assets/fem/stiffness_terms.h"
#include "tests/fem/oracle.h"

namespace mobil {

inline double any_between(double low, double high) {
  return low + (high - low) * *rc::gen::inRange(0, 10001) * 1e-4;
}

inline HexahedralMesh any_belly(const Cells& cells) {
  std::vector<LatticeStation> stations;
  for (const float t : {0.0F, 0.4F, 1.0F}) {
    stations.push_back({t, static_cast<float>(any_between(-0.01, 0.01)), static_cast<float>(any_between(-0.01, 0.01)),
                        static_cast<float>(any_between(0.02, 0.04)), static_cast<float>(any_between(0.02, 0.04))});
  }
  return *bend_block(cells, stations, 0.2);
}

inline Material any_material() {
  return {any_between(500, 2000), any_between(1e3, 1e5), any_between(-0.3, 0.47)};
}

inline Element any_element() {
  return static_cast<Element>(*rc::gen::inRange(0, 3));
}

/// Returns a block whose inner nodes are displaced by up to a fifth of a cell.
inline HexahedralMesh any_distorted_block(const Cells& cells, double cell_size_m) {
  HexahedralMesh mesh = *make_block(cells, cell_size_m);
  const double most = 0.2 * cell_size_m;
  for_each_node(cells, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    if (i == 0 || i == cells[0] || j == 0 || j == cells[1] || k == 0 || k == cells[2]) return;
    auto& p = mesh.node[node_index(cells, i, j, k)];
    p = {p.x + any_between(-most, most), p.y + any_between(-most, most), p.z + any_between(-most, most)};
  });
  return mesh;
}

/// Returns the stencil as a dense matrix.
inline oracle::Matrix dense(const StiffnessTerms& terms, double across, double along) {
  const auto size = static_cast<Eigen::Index>(3 * terms.lumped_mass_kg.size());
  oracle::Matrix k = oracle::Matrix::Zero(size, size);
  for_each_node(terms.cells, [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    const std::uint32_t n = node_index(terms.cells, x, y, z);
    for_each_neighbour(terms.cells, x, y, z, [&](std::uint32_t m, std::size_t slot) {
      const auto block = stiffness_block(terms.pair[n * stencil_size + slot], across, along);
      for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t c = 0; c < 3; ++c) {
          k(static_cast<Eigen::Index>(3 * n + r), static_cast<Eigen::Index>(3 * m + c)) = block[3 * r + c];
        }
      }
    });
  });
  return k;
}

inline oracle::Vector lumped(const StiffnessTerms& terms) {
  oracle::Vector m(static_cast<Eigen::Index>(3 * terms.lumped_mass_kg.size()));
  for (Eigen::Index i = 0; i < m.size(); ++i) m(i) = terms.lumped_mass_kg[static_cast<std::size_t>(i / 3)];
  return m;
}

}  // namespace mobil
