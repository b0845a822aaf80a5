#pragma once
// The arrays of a belly's solver in order, for fingerprints and files.

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include "assets/fem/belly_solver.h"

namespace mobil::inline v0_3 {

/// Calls f(array, length) with each array of a solver (const or not) for bellies of those cells. The length follows
/// from the cells and from the couplings, which are first.
template <class Solver, class F>
void each_array(Solver& solver, const Cells& cells, F&& f) {
  auto& factor = solver.factor;
  const std::size_t nodes = factor.nodes, block = std::size_t{factor.components} * factor.components;
  f(factor.before, nodes);
  f(factor.after, nodes);
  const auto total = [](const std::vector<std::uint32_t>& counts) {
    return std::accumulate(counts.begin(), counts.end(), std::size_t{0});
  };
  f(factor.forward, total(factor.before) * block);
  f(factor.backward, total(factor.after) * block);
  f(factor.inverse_diagonal, nodes * (factor.components == 3 ? 6 : 1));
  f(solver.moment_kg_m, 3 * std::size_t{node_count(cells)});
  f(solver.far_mass_kg, plane_nodes(cells));
}

}  // namespace mobil::inline v0_3
