#pragma once
// The largest stable step of explicit central differences for a belly of any size.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <mobil/components/muscle.h>
#include "assets/fem/stiffness_terms.h"

namespace mobil::inline v0_3 {

/// True if a component (0 x, 1 y, 2 z) of a node moves freely.
constexpr bool moves(const Cells& cells, FarEnd end, std::uint32_t node, std::size_t component) {
  if (node < plane_nodes(cells)) return false;
  if (node < first_insertion_node(cells)) return true;
  return end == FarEnd::free || (end == FarEnd::sliding && component == 2);
}

/// Limits on the step of explicit central differences other than the body. `stiffness_damping_s` is β of the damping C
/// = β·K, whose force is taken half a step late (mass damping, taken implicitly, does not change the limit).
/// `foundation_1_s` is ω_f of a lateral foundation: ω_f² times the mass (of kind `mass`) is added to the stiffness in x
/// and y. Both are finite and at least 0.
struct StepCase {
  // NOLINTNEXTLINE(google-explicit-constructor): most callers set only the end
  constexpr StepCase(FarEnd far_end = FarEnd::held, Mass mass_kind = Mass::lumped, double beta_s = 0,
                     double omega_f_1_s = 0)
      : end(far_end), mass(mass_kind), stiffness_damping_s(beta_s), foundation_1_s(omega_f_1_s) {}

  FarEnd end;
  Mass mass;
  double stiffness_damping_s;
  double foundation_1_s;
};

/// Returns the largest stable step (s) if no free vibration has ω² above `top_1_s2`: (2/ω)·(√(1 + ξ²) − ξ), ξ = β·ω/2
/// (Belytschko, Liu and Moran, Nonlinear Finite Elements, 2000, section 6.2). Infinite for 0.
double central_difference_limit(double top_1_s2, double stiffness_damping_s);

/// Returns the limit (s) of the belly scaled by `across` and `along`. It is never above the exact one and within 0.1 %
/// below it, 0.2 % where β dominates. Beyond about 12000 nodes it is within 1 % and 2 % (top_eigenvalue.h).
/// Deterministic.
double critical_step(const StiffnessTerms& terms, double across, double along, const StepCase& step_case);

/// The critical step of every individual of a template, from a table over r = across / along. With q = S²·ω_f², h(r, q)
/// = S²·ω_max² is the largest eigenvalue of A + r·B + r²·C + q·P·M₁·P against M₁, P picking x and y. C is positive
/// semidefinite and the largest eigenvalue convex, so linear interpolation of h in r and in q never falls below it. The
/// step is therefore safe between the entries as well.
struct CriticalSteps {
  std::vector<double> ratio;       // r, ascending
  std::vector<double> foundation;  // q, ascending from 0, 1/s²; only 0 without a foundation
  std::vector<double> top;         // h(r, q), 1/s², [foundation][ratio]
  double stiffness_damping_s = 0;
  double foundation_1_s2 = 0;  // ω_f²
};

/// Tabulates r from `lowest` to `highest` (0 < lowest ≤ highest) in steps of at most 12 %, and q for bodies up to four
/// times as wide as the template. Both are finer where another mode of vibration takes over.
CriticalSteps tabulate_critical_steps(const StiffnessTerms& terms, const StepCase& step_case, double lowest,
                                      double highest);

/// Returns the critical step (s) of a body scaled by `across` and `along`. Fails, naming the range, if their ratio is
/// outside the table. At most 1 % below the exact one, 2 % where β dominates or a foundation is as stiff as the tissue.
Result<double> critical_step(const CriticalSteps& table, double across, double along);

/// Returns the smallest number of equal substeps of a tick that are within 0.9 of the critical step; both s, positive.
std::uint32_t substeps_within(double critical_step_s, double tick_s);

}  // namespace mobil::inline v0_3
