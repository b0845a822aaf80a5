#pragma once
// What is computed once per basis for the bounds of tests/reduction/bound/reduction_bound.h.

#include "assets/reduction/reduced_basis.h"
#include "engine/eigen.h"
#include "tests/reduction/bound/reduction_constants.h"

namespace mobil {

/// Terms of residuals, in the order of the Gram matrices' rows: K₀·W, then A, C, M₁ and (with a foundation) F times W,
/// the same five of ψ (where there is a lift), then the loads.
struct TermOrder {
  Eigen::Index space = 0, kinds = 4, lifts = 0, loads = 0;

  enum Kind : Eigen::Index { whole, a, c, mass, brace };
  Eigen::Index of_space(Kind kind) const { return kind * space; }
  Eigen::Index of_lift(Kind kind) const { return kinds * space + kind; }
  Eigen::Index of_loads() const { return kinds * (space + lifts); }
  Eigen::Index count() const { return of_loads() + loads; }
};

struct ReductionTables {
  ReducedOptions options;
  double lowest_ratio = 1, highest_ratio = 1, foundation_1_s2 = 0;
  Eigen::Index vectors = 0;  // of the basis: W's first
  double mass_kg = 0;        // of the template
  StiffnessConstants constants;
  TermOrder order;

  // Of W (ψ before it where there is a lift), in M₁ orthonormal: whole products with themselves and with the loads.
  Eigen::MatrixXd a, b, c, foundation, mass, loads;
  double unseen_square =
      0;  // |M₁⁻¹(M₁ψ) − W·Wᵀ(M₁ψ)|²_M over what moves: the jump that a unit change of rate makes outside W

  Eigen::MatrixXd stiffness_gram, mass_gram;  // of K₀⁻¹·terms, in K₀ and in M₁
};

}  // namespace mobil
