#include "assets/finite/finite_sections.h"

namespace mobil::inline v0_3 {

using Eigen::Index;

Corners corners_of(const FiniteBelly& belly, const FiniteElement& element, const std::vector<double>& displacement_m) {
  Corners at;
  for (std::size_t a = 0; a < 8; ++a) {
    const std::size_t n = element.node[a];
    const auto& x = belly.mesh.node[n];
    at[a] = {x.x + displacement_m[3 * n], x.y + displacement_m[3 * n + 1], x.z + displacement_m[3 * n + 2]};
  }
  return at;
}

Activity activity_of(const FiniteBelly& belly, double shortening, double activation) {
  return {pulling_activation(belly.tissue, shortening, activation), 1 - shortening};
}

void assemble_elements(const FiniteBelly& belly, const Activity& activity, const std::vector<double>& displacement_m,
                       double stiffening, double pull_m, FiniteScratch& scratch) {
  const std::size_t plane = plane_nodes(belly.mesh.cells), layers = belly.mesh.cells[2];
  const std::size_t rows = 3 * plane;
  scratch.residual_n.setZero();
  clear(scratch.chain);
  const double shear = stiffening * belly.tissue.shear_pa;
  Corners force;
  ElementTangent tangent;
  const auto moves = [&](std::size_t section) { return section > 0 && section < layers; };
  for (std::size_t e = 0; e < belly.elements.size(); ++e) {
    const FiniteElement& element = belly.elements[e];
    element_force(element, belly.tissue, activity, corners_of(belly, element, displacement_m), force, &tangent);
    for (std::size_t a = 0; a < 8; ++a) {
      const std::size_t section = element.node[a] / plane;
      if (!moves(section)) continue;
      const auto row = static_cast<Index>(3 * (element.node[a] % plane));
      const Index at = static_cast<Index>((section - 1) * rows) + row;
      for (std::size_t d = 0; d < 3; ++d) scratch.residual_n[at + static_cast<Index>(d)] -= force[a][d];
      for (std::size_t b = 0; b < 8; ++b) {
        const auto& block = tangent[packed_pair(a, b)];
        const auto entry = [&](std::size_t r, std::size_t c) { return a >= b ? block[3 * r + c] : block[3 * c + r]; };
        const std::size_t other = element.node[b] / plane;
        if (other == layers) {
          for (std::size_t r = 0; r < 3; ++r) scratch.residual_n[at + static_cast<Index>(r)] -= entry(r, 2) * pull_m;
          continue;
        }
        if (!moves(other) || other > section) continue;
        auto& into = other == section ? scratch.chain.own[section - 1] : scratch.chain.below[other - 1];
        const auto column = static_cast<Index>(3 * (element.node[b] % plane));
        for (std::size_t c = 0; c < 3; ++c) {
          double* const to = &into(row, column + static_cast<Index>(c));
          for (std::size_t r = 0; r < 3; ++r) to[r] += entry(r, c);
          if (a == b) to[c] += shear * element.stretch[packed_pair(a, a)];
        }
      }
    }
  }
}

}  // namespace mobil::inline v0_3
