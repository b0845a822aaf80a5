#pragma once
// Factorised operators of the implicit methods, each shared by all bellies of about one size. A body of exactly the
// solver's size is solved exactly. Others precondition a few sweeps of conjugate gradients in their lanes with it.

#include <cstdint>
#include <vector>

#include <mobil/components/muscle.h>
#include <mobil/engine/error.h>
#include "assets/fem/muscle_template.h"

namespace mobil::inline v0_3 {

/// Lower Cholesky factor G of a symmetric banded matrix over the moving planes of nodes, in the kernels' order. Every
/// node has `components` rows (3, or 1 where x, y and z are alike). Its coupling to another node is a square block of
/// that size, row-major. Components that do not move are solved to zero.
struct BandFactor {
  std::uint32_t components = 3;
  std::uint32_t first_node = 0, nodes = 0;
  std::vector<std::uint32_t> before,
      after;                            // a node's couplings: to the nodes just before it, in G, and after it, in Gᵀ
  std::vector<float> forward;           // blocks of G, nodes ascending, and in each from the farthest node on
  std::vector<float> backward;          // blocks of Gᵀ, nodes descending, and in each from the farthest node on
  std::vector<float> inverse_diagonal;  // inverse of G's own block: xx, yx, yy, zx, zy, zz
};

/// A solver serves bellies whose S/l is within 6 % of its own and whose S·l is within 12 %. Their worst relative errors
/// of displacement over a driven second at 81 nodes and a step of 1/60 s, for two, three and four sweeps, are 4e-3,
/// 3e-4, 1e-5 (undamped; about a fifth with α = 8 1/s). Within 12 % and 25 % they are 2e-2, 2e-3, 2e-4. Static
/// solutions, without mass to hold them, have 2e-2, 4e-3, 7e-5, 2e-5. Bodies of exactly its size are solved to
/// rounding.
struct BellySolver {
  Method method = Method::newmark;
  Mass mass = Mass::lumped;
  double dt_s = 0;
  double across = 1, along = 1;   // the body that it solves exactly
  std::uint32_t sweeps = 3;       // of conjugate gradients, for bodies of other sizes
  std::uint32_t refinements = 1;  // solutions for bodies of its size, each for the last residual
  float correction = 1;           // part of CAA's velocity change that is applied; below 1 at many critical steps
  BandFactor factor;
  std::vector<float> moment_kg_m;  // ∑ mass·(rest position) over a node's row of the mass matrix, three a node
  std::vector<float> far_mass_kg;  // coupling by mass of a node of the last plane but one to the whole insertion face
};

/// Makes a solver for bellies scaled by about `across` and `along` in steps of `dt_s` (ignored by static). CAA has the
/// operator (2/Δt + α)·M + (Δt/2 + β)·K with the requested mass, ICD the consistent mass (exact for every body), static
/// K. CAA and static include the sideways foundation. Fails, naming the range, on ECD, a step outside 1e-9–100 s,
/// scales outside 1e-3–1e3 or a ratio of theirs outside the template's range. Also fails if the factor would exceed
/// `largest_band_factor` numbers.
Result<BellySolver> make_belly_solver(const MuscleTemplate& muscle, Method method, Mass mass, double dt_s,
                                      double across = 1, double along = 1);

inline constexpr std::size_t largest_band_factor = 50'000'000;

/// Checks the size of the factor in advance.
Result<void> check_belly_solver(const Cells& cells, Method method);

}  // namespace mobil::inline v0_3
