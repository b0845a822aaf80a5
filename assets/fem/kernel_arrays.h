#pragma once
// A template's operators in single precision, in the order in which the kernels walk.

#include <cstddef>
#include <vector>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include "assets/fem/stiffness_terms.h"

namespace mobil::inline v0_3 {

/// Rows are the nodes from the second plane to the last, x fastest; a row's neighbours are those that exist, except in
/// the (fixed) first plane, x fastest.
///
/// The rounded operator is symmetric, or bellies would gain energy as they circle. What rounding a node's coupling to
/// itself takes along x, y or z its weakest coupling makes up for, so that a translation costs no force: else slender
/// bellies would bend to a wrong beat.
struct KernelArrays {
  static constexpr std::size_t individual_words = 12;  // a pair's A, B, C, as in StencilPair
  static constexpr std::size_t shared_words = 9;       // a pair's 3×3 block at S = l = 1, row-major
  std::vector<float> individual, shared;
  std::vector<float> consistent_mass_kg;     // one a pair
  std::vector<std::size_t> plane_pair;       // first pair of each plane k, 0 for the planes 0 and 1
  std::vector<float> mass_kg, inverse_mass;  // lumped, one a node
  std::vector<float> far_share;              // part of a uniform traction on each node of the far face; sum 1
  std::vector<float> rest_m;                 // three a node
  std::vector<Quad> skin;                    // boundary, wound outwards
  float volume_m3 = 0;
};

/// ∫N dA of each node of the far face, as parts of their sum (2×2 Gauss points on each quadrilateral): what a uniform
/// traction puts on each.
std::vector<double> far_shares(const HexahedralMesh& mesh);

KernelArrays make_kernel_arrays(const HexahedralMesh& mesh, const StiffnessTerms& terms);

}  // namespace mobil::inline v0_3
