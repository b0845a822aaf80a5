#pragma once
// A template's operators in single precision, in the kernels' order.

#include <cstddef>
#include <vector>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include "assets/fem/stiffness_terms.h"

namespace mobil::inline v0_3 {

/// Rows are the nodes from the second plane to the last, x fastest. A row's neighbours are the existing ones outside of
/// the (fixed) first plane, x fastest.
///
/// The rounded operator is symmetric, because asymmetric ones let circling bellies gain energy. A node's weakest
/// coupling makes up for the rounding of its coupling to itself along x, y or z, so a translation costs no force.
/// Without that, slender bellies would bend at a wrong frequency.
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

/// Returns ∫N dA of each node of the far face, as parts of their sum (2×2 Gauss points on each quadrilateral). They are
/// the nodes' shares of a uniform traction.
std::vector<double> far_shares(const HexahedralMesh& mesh);

KernelArrays make_kernel_arrays(const HexahedralMesh& mesh, const StiffnessTerms& terms);

}  // namespace mobil::inline v0_3
