#pragma once
// A proven, tight upper bound on the fastest free vibration of a stencil: the largest λ of K·x = λ·M·x.

#include <array>
#include <span>
#include <vector>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include "assets/fem/stencil_matrix.h"

namespace mobil::inline v0_3 {

/// K and M over all displacements of a mesh, both multiplied by D^{-½} from either side, D the lumped mass. Rows and
/// columns of displacements that do not move are zero.
struct StencilPencil {
  Cells cells{};
  std::vector<std::array<double, 9>> stiffness;  // 27 couplings a node, row-major, 1/s²
  std::vector<double> mass;                      // 27 a node, alike in x, y and z; empty: M = D
  std::vector<bool> moving;                      // three a node
};

/// Returns the start of Lanczos iteration over the moving displacements: always the same direction, drawn uniformly
/// from the sphere.
std::vector<double> lanczos_start(const std::vector<bool>& moving);

/// Returns a bound that is never below the largest λ and at most 0.1 % above it, 1/s²; 0 if nothing moves, infinite if
/// an entry is not finite. Lanczos iteration estimates λ from below. A banded Cholesky factor of σ·M − K proves that no
/// λ reaches σ; if it does not exist, σ is raised and then bisected. Beyond 2e10 operations for one factor (about 12000
/// nodes of usual shape) no proof is attempted. Lanczos then runs until its estimate, from a random start, is 2 % too
/// low with a probability below 1e-12 for any spectrum (Kuczyński and Woźniakowski, SIAM J. Matrix Anal. Appl. 13,
/// 1992), and 2 % are added. `start` is lanczos_start(pencil.moving), which takes longer than a Lanczos step. `work` is
/// memory that calls share.
double top_eigenvalue_bound(const StencilPencil& pencil, std::span<const double> start, StencilMatrix& work);

}  // namespace mobil::inline v0_3
