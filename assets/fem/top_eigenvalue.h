#pragma once
// A proven upper bound, tight, on the fastest free vibration of a stencil: the largest λ of K·x = λ·M·x.

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

/// Where Lanczos iteration starts: always the same direction, drawn from the sphere alike in all directions, over what
/// moves.
std::vector<double> lanczos_start(const std::vector<bool>& moving);

/// Never below the largest λ and at most 0.1 % above it, 1/s²; 0 where nothing moves, infinite where
/// an entry is not finite. Lanczos iteration estimates λ
/// from below, a banded Cholesky factor of σ·M − K proves that none reaches σ, and where it does not exist σ is raised
/// and then bisected. Beyond 2e10 operations for one factor (some 12000 nodes of usual shape) no proof is
/// attempted: Lanczos runs on for so long that its estimate, from a start drawn at random, lies 2 % too low with a
/// probability below 1e-12 whatever the spectrum (Kuczyński and Woźniakowski, SIAM J. Matrix Anal. Appl. 13, 1992);
/// 2 % are added. `start`: lanczos_start(pencil.moving), which takes longer than a Lanczos step.
/// `work`: memory that calls share.
double top_eigenvalue_bound(const StencilPencil& pencil, std::span<const double> start, StencilMatrix& work);

}  // namespace mobil::inline v0_3
