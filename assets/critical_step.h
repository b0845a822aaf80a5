#pragma once
// The largest stable step of explicit central differences, 2 / ω_max, for a belly of any size.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "assets/stiffness_terms.h"

namespace mobil {

/// What the insertion face may do; the origin face is always fixed. `held`: every displacement of it is prescribed.
/// `sliding`: held sideways, free along z. `free`: free in all directions.
enum class FarEnd : std::uint8_t { held, sliding, free };

/// Whether a component (0 x, 1 y, 2 z) of a node moves freely.
constexpr bool moves(const Cells& cells, FarEnd end, std::uint32_t node, std::size_t component) {
  if (node < plane_nodes(cells)) return false;
  if (node < first_insertion_node(cells)) return true;
  return end == FarEnd::free || (end == FarEnd::sliding && component == 2);
}

/// 2 / ω_max (s) of the lumped-mass belly scaled by `across` and `along`: never above the exact value, and within
/// 0.1 % below it. ω² comes from Lanczos iteration (from below); a Cholesky factorisation of ω²·M − K then proves the
/// bound, which is raised until it holds and is capped by Gershgorin's. Where that would take more than some 6e9
/// operations (beyond about 8000 nodes of usual shape) 2 % are added to ω² instead. Deterministic.
double critical_step(const StiffnessTerms& terms, double across, double along, FarEnd end);

/// 2 / max ω_e over the elements (s): no free vibration of an assembly is faster than its fastest element (Irons), so
/// this is safe under any constraints, and some quarter too careful on a 3×3×9-node block.
double element_critical_step(const HexahedralMesh& mesh, const Material& material, double across, double along);

/// The critical step of every individual of a template, from a table over r = across / along. g(r) = λ_max of
/// M₁^{-½}(A + r·B + r²·C)M₁^{-½} is tabulated; C is positive semidefinite and λ_max convex, so interpolating g
/// linearly in r never falls below it: the step is safe between the entries too.
struct CriticalSteps {
  std::vector<double> ratio;  // ascending
  std::vector<double> top;    // g there, 1/s²
};

/// Tabulates r from `lowest` to `highest` (0 < lowest ≤ highest) in steps of at most 6 %.
CriticalSteps tabulate_critical_steps(const StiffnessTerms& terms, FarEnd end, double lowest, double highest);

/// Critical step (s) of a body scaled by `across` and `along`; fails, naming the range, where their ratio is outside
/// the table. At most 1 % below the exact one.
Result<double> critical_step(const CriticalSteps& table, double across, double along);

/// Smallest number of equal substeps of a tick that keeps each within 0.9 of the critical step; both s, positive.
std::uint32_t substeps_within(double critical_step_s, double tick_s);

}  // namespace mobil
