#pragma once
// What the implicit methods solve with: a factorised operator that all bellies of about one size share. A body of just
// the solver's size is solved exactly; others use it to precondition a few sweeps of conjugate gradients in their
// lanes.

#include <cstdint>
#include <vector>

#include <mobil/components/muscle.h>
#include <mobil/engine/error.h>
#include "assets/fem/muscle_template.h"

namespace mobil::inline v0_3 {

/// Lower Cholesky factor G of a symmetric banded matrix over the planes of nodes that move, as the kernels walk through
/// it. Every node has `components` rows (3, or 1 where x, y and z are alike), its coupling to another is a square block
/// of that many, row-major. Components that do not move are solved to zero.
struct BandFactor {
  std::uint32_t components = 3;
  std::uint32_t first_node = 0, nodes = 0;
  std::vector<std::uint32_t> before,
      after;                            // a node's couplings: to the nodes just before it, in G, and after it, in Gᵀ
  std::vector<float> forward;           // blocks of G, nodes ascending, and in each from the farthest node on
  std::vector<float> backward;          // blocks of Gᵀ, nodes descending, and in each from the farthest node on
  std::vector<float> inverse_diagonal;  // inverse of G's own block: xx, yx, yy, zx, zy, zz
};

/// One serves bellies whose S/l lies within 6 % of its own and whose S·l within 12 %. Worst relative error of their
/// displacements over a driven second at 81 nodes and a step of 1/60 s (undamped; some five times less with α = 8 1/s),
/// by sweeps from two on: 4e-3, 3e-4, 1e-5. Within 12 % and 25 %: 2e-2, 2e-3, 2e-4. Of static answers, which have no
/// mass to hold them, 2e-2, 4e-3, 7e-5 and 2e-5. Bodies of just its size are solved to rounding.
struct BellySolver {
  Method method = Method::newmark;
  Mass mass = Mass::lumped;
  double dt_s = 0;
  double across = 1, along = 1;   // the body it solves exactly
  std::uint32_t sweeps = 3;       // of conjugate gradients, for bodies of other sizes
  std::uint32_t refinements = 1;  // solutions, each for what the last left, of bodies of just its size
  float correction = 1;           // part of CAA's change of velocity that is taken; below 1 at many critical steps
  BandFactor factor;
  std::vector<float> moment_kg_m;  // ∑ mass·(rest position) over a node's row of the mass matrix, three a node
  std::vector<float> far_mass_kg;  // coupling by mass of a node of the last plane but one to the whole insertion face
};

/// For bellies scaled by about `across` and `along` in steps of `dt_s` (ignored by static): of CAA the operator
/// (2/Δt + α)·M + (Δt/2 + β)·K with the mass asked for, of ICD the consistent mass (exact for every body), of static K;
/// of CAA and static with the sideways foundation. Fails, naming the range, on ECD, a step outside 1e-9–100 s, scales
/// outside 1e-3–1e3 or a ratio of theirs outside the template's range, and where the factor would exceed
/// `largest_band_factor` numbers.
Result<BellySolver> make_belly_solver(const MuscleTemplate& muscle, Method method, Mass mass, double dt_s,
                                      double across = 1, double along = 1);

inline constexpr std::size_t largest_band_factor = 50'000'000;

/// The last of these refusals, ahead of all work.
Result<void> check_belly_solver(const Cells& cells, Method method);

}  // namespace mobil::inline v0_3
