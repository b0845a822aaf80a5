#pragma once
// One hexahedron of finite strain: stable neo-Hookean tissue whose dilatation is the element's mean (Q1P0), fibres
// along the mesh's lines from origin to insertion. The energy is
//   W = μ/2 (I₁ − 3) − μ(J − 1) + κ'/2 (J̄ − 1)² + fibres,  J̄ = volume / volume at rest.
// The neo-Hookean part is a constant stiffness and a pressure κ'(J̄ − 1) − μ on the element's volume, which is a cubic
// polynomial of its corners; only fibres need the 2×2×2 points.

#include <array>
#include <cstddef>
#include <vector>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/engine/error.h>
#include "assets/fem/finite_tissue.h"

namespace mobil::inline v0_3 {

/// An element at rest. Pairs of corners a ≥ b are packed: a(a + 1)/2 + b.
struct FiniteElement {
  Hexahedron node{};
  double volume_m3 = 0;
  std::array<double, 36> stretch{};                // ∫ ∇N_a·∇N_b, m
  std::array<std::array<double, 8>, 8> fibre{};    // [point][corner] ∇N_a·a₀, 1/m
  std::array<double, 8> fibre_volume_m3{};         // volume of the point, times crowding
  std::array<std::array<double, 8>, 8> mass_kg{};  // consistent
};

using Corners = std::array<std::array<double, 3>, 8>;

/// K of an element: 3×3 blocks, row-major, of packed pairs. A row belongs to the corner with the higher number.
using ElementTangent = std::array<std::array<double, 9>, 36>;

constexpr std::size_t packed_pair(std::size_t a, std::size_t b) {
  return a >= b ? a * (a + 1) / 2 + b : b * (b + 1) / 2 + a;
}

/// Returns all elements of a mesh. Sections are its planes of equal k, their areas seen along z. Fails on an inverted
/// element, which the error names.
Result<std::vector<FiniteElement>> finite_elements(const HexahedralMesh& mesh, const FiniteTissue& tissue);

/// Returns the areas of the nz + 1 planes of nodes as seen along z, m². `displacement_m` has three a node, or is empty.
std::vector<double> section_areas(const HexahedralMesh& mesh, const std::vector<double>& displacement_m = {});

/// Returns the volume of a trilinear hexahedron, m³ (exact), and writes its gradient over the corners, m².
double hexahedron_volume(const Corners& at_m, Corners& gradient_m2);

/// Activity of an element's fibres.
struct Activity {
  double activation = 0, mean_stretch = 1;
};

/// Overwrites the elastic force at the corners, N, of an element whose corners are at `at_m`. `tangent` can be null.
void element_force(const FiniteElement& element, const FiniteTissue& tissue, const Activity& activity,
                   const Corners& at_m, Corners& force_n, ElementTangent* tangent);

}  // namespace mobil::inline v0_3
