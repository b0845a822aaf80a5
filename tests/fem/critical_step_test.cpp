// The critical step of every body, compared with eigenvalue solves: never above the exact one, and close to it.
#include "assets/fem/critical_step.h"

#include "engine/eigen.h"

#include <Spectra/MatOp/SparseCholesky.h>
#include <Spectra/MatOp/SparseSymMatProd.h>
#include <Spectra/SymEigsSolver.h>
#include <Spectra/SymGEigsSolver.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/SparseCore>
#include <cmath>

#include "tests/fem/any_stiffness.h"

namespace mobil::critical_step_test {
using oracle::Matrix;
using oracle::Vector;
using Sparse = Eigen::SparseMatrix<double>;

FarEnd any_end() {
  constexpr FarEnd ends[] = {FarEnd::held, FarEnd::sliding, FarEnd::free};
  return ends[*rc::gen::inRange(0, 3)];
}

Mass any_mass() {
  return *rc::gen::arbitrary<bool>() ? Mass::consistent : Mass::lumped;
}

/// Mass and stiffness of the moving components, including the foundation.
struct Pencil {
  Matrix mass, stiffness;
};

Pencil dense_pencil(const oracle::Model& model, const Cells& cells, const StepCase& step_case) {
  const Matrix mass = step_case.mass == Mass::lumped ? Matrix(model.lumped.asDiagonal()) : model.mass;
  Matrix stiffness = model.stiffness;
  for (Eigen::Index i = 0; i < mass.rows(); ++i) {
    for (Eigen::Index j = 0; j < mass.cols(); ++j) {
      if (i % 3 < 2 && i % 3 == j % 3) stiffness(i, j) += std::pow(step_case.foundation_1_s, 2) * mass(i, j);
    }
  }
  const auto moving = oracle::free_components(cells, step_case.end);
  return {mass(moving, moving), stiffness(moving, moving)};
}

double exact_limit(const oracle::Model& model, const Cells& cells, const StepCase& step_case) {
  const Pencil p = dense_pencil(model, cells, step_case);
  const double omega = std::sqrt(oracle::eigenvalues(p.stiffness, p.mass).maxCoeff());
  const double xi = step_case.stiffness_damping_s * omega / 2;
  return 2 / omega * (std::sqrt(1 + xi * xi) - xi);
}

TEST(CriticalStep, ClampedBlockOfThePaperHas3point48Milliseconds) {
  const auto block = make_block({2, 2, 8}, 0.015);
  const auto terms = assemble(*block, Material{});
  EXPECT_NEAR(critical_step(*terms, 1, 1, FarEnd::free), 3.48e-3, 0.005e-3);
  EXPECT_NEAR(critical_step(*terms, 1, 1, {FarEnd::free, Mass::consistent}), 1.629e-3, 0.005e-3);
}

RC_GTEST_PROP(CriticalStep, NeverAboveTheExactLimitAndWithinTwoTenthsOfAPercent, ()) {
  const HexahedralMesh mesh = any_belly({2, 2, 5});
  const Material material = any_material();
  const Element kind = any_element();
  const double across = any_between(0.5, 2), along = any_between(0.5, 2);
  const StepCase step_case{any_end(), any_mass(), any_between(0, 1e-3), any_between(0, 100)};
  const auto terms = assemble(mesh, material, kind);
  const auto model = oracle::assemble(oracle::scaled(mesh, across, along), material, kind);
  const double exact = exact_limit(model, mesh.cells, step_case);
  const double step = critical_step(*terms, across, along, step_case);
  RC_ASSERT(step <= exact);
  RC_ASSERT(step > 0.998 * exact);
}

// Slivers with a scaled Jacobian down to 2e-3, and aspect ratios to 100.
RC_GTEST_PROP(CriticalStep, SafeAndCloseOnSliversAndNeedles, ()) {
  const bool sheared = *rc::gen::arbitrary<bool>();
  const auto shift = static_cast<float>(sheared ? any_between(0.5, 4) : 0);
  const auto thin = static_cast<float>(sheared ? 0.02 : 0.02 / any_between(1, 100));
  const auto mesh =
      bend_block({2, 2, 4}, std::vector<LatticeStation>{{0, 0, 0, 0.02F, thin}, {1, shift, 0, 0.02F, thin}}, 0.08,
                 {any_between(0.2, 5), any_between(0.2, 5)});
  RC_ASSERT(mesh.has_value());
  const Material material = any_material();
  const Element kind = any_element();
  const StepCase step_case{any_end(), any_mass()};
  const auto terms = assemble(*mesh, material, kind);
  RC_ASSERT(terms.has_value());
  const double exact = exact_limit(oracle::assemble(*mesh, material, kind), mesh->cells, step_case);
  const double step = critical_step(*terms, 1, 1, step_case);
  RC_ASSERT(step <= exact * (1 + 1e-9));
  RC_ASSERT(step > 0.998 * exact);
}

/// Largest growth in one step of M·(uₙ₊₁ − 2uₙ + uₙ₋₁)/Δt² + α·M·(uₙ₊₁ − uₙ₋₁)/(2Δt) + β·K·(uₙ − uₙ₋₁)/Δt + K·uₙ = 0.
double growth(const Pencil& p, double alpha, double beta, double dt) {
  const auto n = p.mass.rows();
  const Matrix k = p.mass.llt().solve(p.stiffness);
  const double share = 1 / (1 + 0.5 * alpha * dt);
  Matrix advance = Matrix::Zero(2 * n, 2 * n);
  const Matrix unit = Matrix::Identity(n, n);
  advance.topLeftCorner(n, n) = share * (2 * unit - dt * dt * k - beta * dt * k);
  advance.topRightCorner(n, n) = share * (beta * dt * k - (1 - 0.5 * alpha * dt) * unit);
  advance.bottomLeftCorner(n, n) = unit;
  double log_growth = 0;  // of the norm of the 2^i-th power, divided by 2^i
  for (int i = 0; i < 40; ++i) {
    const double norm = advance.norm();
    log_growth += std::ldexp(std::log(norm), -i);
    advance = (advance / norm) * (advance / norm);
  }
  return std::exp(log_growth);
}

RC_GTEST_PROP(CriticalStep, NoGrowthJustBelowAndGrowthJustAbove, ()) {
  const HexahedralMesh mesh = any_belly({1, 1, 3});
  const Material material = any_material();
  const double alpha = any_between(0, 50);
  const StepCase step_case{any_end(), any_mass(), any_between(0, 2e-3), any_between(0, 100)};
  const double step = critical_step(*assemble(mesh, material), 1, 1, step_case);
  const Pencil p = dense_pencil(oracle::assemble(mesh, material), mesh.cells, step_case);
  RC_ASSERT(growth(p, alpha, step_case.stiffness_damping_s, step) < 1 + 1e-7);
  RC_ASSERT(growth(p, alpha, step_case.stiffness_damping_s, 1.003 * step) > 1.0001);
}

RC_GTEST_PROP(CriticalStep, TableIsSafeBetweenItsEntriesAndWithinOnePercent, ()) {
  const HexahedralMesh mesh = any_belly({2, 2, 6});
  const Material material = any_material();
  const FarEnd end = any_end();
  const auto terms = assemble(mesh, material);
  const CriticalSteps table = tabulate_critical_steps(*terms, end, 0.5, 2);
  const double across = any_between(0.7, 1.4), along = across / any_between(0.5, 2);
  const double exact = exact_limit(oracle::assemble(oracle::scaled(mesh, across, along), material), mesh.cells, end);
  const auto step = critical_step(table, across, along);
  RC_ASSERT(step.has_value());
  RC_ASSERT(*step <= exact);
  RC_ASSERT(*step > 0.99 * exact);
}

RC_GTEST_PROP(CriticalStep, TableServesMassDampingAndFoundationWithinTwoPercent, ()) {
  const HexahedralMesh mesh = any_belly({2, 2, 4});
  const Material material = any_material();
  const Element kind = any_element();
  const StepCase step_case{any_end(), any_mass(), any_between(0, 1e-3), any_between(0, 60)};
  const CriticalSteps table = tabulate_critical_steps(*assemble(mesh, material, kind), step_case, 0.7, 1.5);
  const double across = any_between(0.3, 3), along = across / any_between(0.7, 1.5);
  const auto model = oracle::assemble(oracle::scaled(mesh, across, along), material, kind);
  const double exact = exact_limit(model, mesh.cells, step_case);
  const auto step = critical_step(table, across, along);
  RC_ASSERT(step.has_value());
  RC_ASSERT(*step <= exact);
  RC_ASSERT(*step > 0.98 * exact);
}

/// The foundation is about as stiff as the tissue. As the body gets wider, the fastest mode changes from stretching
/// along the belly to swaying across it, so h(r, q) has a corner in q.
TEST(CriticalStep, TableFollowsTheChangeToAFoundationMode) {
  const auto terms = assemble(*make_block({2, 2, 4}, 0.03), Material{1000, 1e3, 0.3});
  const StepCase step_case{FarEnd::held, Mass::lumped, 1e-3, 60};
  const CriticalSteps table = tabulate_critical_steps(*terms, step_case, 0.7, 1.5);
  for (double across = 0.25; across <= 4; across *= 1.05) {
    for (const double ratio : {0.7, 0.93, 1.21, 1.5}) {
      const double exact = critical_step(*terms, across, across / ratio, step_case);
      const auto step = critical_step(table, across, across / ratio);
      ASSERT_TRUE(step);
      EXPECT_LE(*step, 1.003 * exact) << across << ' ' << ratio;  // `exact` itself can be as much below the true limit
      EXPECT_GT(*step, 0.98 * exact) << across << ' ' << ratio;
    }
  }
}

TEST(CriticalStep, TableRefusesBodiesOutsideItsRange) {
  const auto terms = assemble(*make_block({1, 1, 2}, 0.015), Material{});
  const auto table = tabulate_critical_steps(*terms, FarEnd::held, 0.8, 1.25);
  EXPECT_TRUE(critical_step(table, 1, 1));
  EXPECT_FALSE(critical_step(table, 1, 2));
  EXPECT_FALSE(critical_step(table, 2, 1));
  EXPECT_FALSE(critical_step(table, 0, 1));
  EXPECT_FALSE(critical_step(table, std::nan(""), 1));
}

TEST(CriticalStep, FullyHeldBlockHasNoLimit) {
  const auto terms = assemble(*make_block({2, 2, 1}, 0.015), Material{});
  EXPECT_TRUE(std::isinf(critical_step(*terms, 1, 1, FarEnd::held)));
  EXPECT_EQ(substeps_within(critical_step(*terms, 1, 1, FarEnd::held), 1.0 / 60), 1U);
}

/// Returns 2/ω_max of a large belly with a free end, from an independent restarted Lanczos iteration.
double sparse_limit(const HexahedralMesh& mesh, const Material& material, Mass kind) {
  std::vector<Eigen::Index> place(3 * mesh.node.size(), -1);
  const auto moving = oracle::free_components(mesh.cells, FarEnd::free);
  for (std::size_t i = 0; i < moving.size(); ++i)
    place[static_cast<std::size_t>(moving[i])] = static_cast<Eigen::Index>(i);
  std::vector<Eigen::Triplet<double>> k, m;
  for (std::uint32_t e = 0; e < element_count(mesh.cells); ++e) {
    const Hexahedron h = element_nodes(mesh.cells, e);
    const auto [stiffness, mass] = oracle::element_matrices(mesh, h, material);
    for (std::size_t i = 0; i < 24; ++i) {
      for (std::size_t j = 0; j < 24; ++j) {
        const auto row = place[3 * h[i / 3] + i % 3], column = place[3 * h[j / 3] + j % 3];
        const auto a = static_cast<Eigen::Index>(i), b = static_cast<Eigen::Index>(j);
        if (row >= 0 && column >= 0) k.emplace_back(row, column, stiffness(a, b));
        if (row < 0 || i % 3 != j % 3) continue;
        if (kind == Mass::lumped) m.emplace_back(row, row, mass(a / 3, b / 3));
        if (kind == Mass::consistent && column >= 0) m.emplace_back(row, column, mass(a / 3, b / 3));
      }
    }
  }
  const auto size = static_cast<Eigen::Index>(moving.size());
  Sparse stiffness(size, size), mass(size, size);
  stiffness.setFromTriplets(k.begin(), k.end());
  mass.setFromTriplets(m.begin(), m.end());
  Spectra::SparseSymMatProd<double> product(stiffness);
  Spectra::SparseCholesky<double> factor(mass);
  Spectra::SymGEigsSolver<Spectra::SparseSymMatProd<double>, Spectra::SparseCholesky<double>,
                          Spectra::GEigsMode::Cholesky>
      solver(product, factor, 1, 40);
  solver.init();
  solver.compute(Spectra::SortRule::LargestAlge, 1000, 1e-9);
  return solver.info() == Spectra::CompInfo::Successful ? 2 / std::sqrt(solver.eigenvalues()(0)) : NAN;
}

HexahedralMesh fine_belly(const Cells& cells) {
  return *bend_block(
      cells,
      std::vector<LatticeStation>{{0, 0, 0, 0.02F, 0.03F}, {0.4F, 0.01F, 0, 0.03F, 0.02F}, {1, 0, 0, 0.02F, 0.02F}},
      0.2);
}

TEST(CriticalStep, LargeBelliesAgreeWithAnotherEigenSolver) {
  const HexahedralMesh mesh = fine_belly({8, 8, 32});
  const auto terms = assemble(mesh, Material{});
  for (const Mass mass : {Mass::lumped, Mass::consistent}) {
    const double exact = sparse_limit(mesh, Material{}, mass), step = critical_step(*terms, 1, 1, {FarEnd::free, mass});
    EXPECT_LE(step, exact * (1 + 1e-7));
    EXPECT_GT(step, 0.999 * exact);
  }
}

TEST(CriticalStep, BelliesTooLargeForAProofAreSafeWithinTwoPercent) {
  const HexahedralMesh mesh = fine_belly({16, 16, 34});
  const double exact = sparse_limit(mesh, Material{}, Mass::lumped);
  const double step = critical_step(*assemble(mesh, Material{}), 1, 1, FarEnd::free);
  EXPECT_LE(step, exact);
  EXPECT_GT(step, 0.98 * exact);
}

RC_GTEST_PROP(CriticalStep, SubstepsAreTheFewestThatFit, ()) {
  const double limit = any_between(1e-4, 1e-2), tick = 1.0 / 60;
  const auto n = substeps_within(limit, tick);
  RC_ASSERT(tick / n <= 0.9 * limit * (1 + 1e-12));
  RC_ASSERT(n == 1U || tick / (n - 1) > 0.9 * limit);
}

}  // namespace mobil::critical_step_test
