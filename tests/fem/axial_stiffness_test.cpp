// Axial stiffness of a belly, compared with dense double-precision statics, energy bounds and bars of known stiffness.
#include "assets/fem/axial_stiffness.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <vector>

#include "tests/fem/oracle.h"

namespace mobil::axial_stiffness_test {
using oracle::Matrix;
using oracle::Vector;

/// Draws from the full range from the first try on.
template <class T>
T within(T low, T high) {
  return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(low, high));
}
double uniform(double low, double high) {
  return low + (high - low) * within(0, 10001) / 10000.0;
}

/// Returns a spindle whose sections are off its axis, small enough for dense matrices.
HexahedralMesh any_mesh() {
  const Cells cells = {within(1U, 4U), within(1U, 4U), within(2U, 7U)};
  const auto wide = [] { return static_cast<float>(uniform(0.02, 0.05)); };
  const auto off = [] { return static_cast<float>(uniform(-0.01, 0.01)); };
  const LatticeStation stations[] = {
      {0, off(), off(), wide(), wide()}, {0.5F, off(), off(), wide(), wide()}, {1, off(), off(), wide(), wide()}};
  return *bend_block(cells, stations, uniform(0.15, 0.4));
}

Material any_material() {
  return {1000, uniform(1e3, 1e5), uniform(0, 0.45)};
}

/// Returns the result of `static_stretch` from a dense factorisation of an independently assembled model.
StaticStretch dense_stretch(const HexahedralMesh& mesh, const Material& material, double across, double along) {
  const auto model = oracle::assemble(oracle::scaled(mesh, across, along), material);
  const auto moving = oracle::free_components(mesh.cells, FarEnd::held);
  Vector u = Vector::Zero(model.stiffness.rows()), pull = u;
  for (std::uint32_t n = first_insertion_node(mesh.cells); n < node_count(mesh.cells); ++n) pull(3 * n + 2) = 1;
  u = pull;
  const Vector load = -model.stiffness * pull;
  const Matrix inner = model.stiffness(moving, moving);
  const Vector inside = oracle::solve(inner, load(moving));
  for (std::size_t i = 0; i < moving.size(); ++i) u(moving[i]) = inside(static_cast<Eigen::Index>(i));
  return {{u.begin(), u.end()}, pull.dot(model.stiffness * u)};
}

RC_GTEST_PROP(AxialStiffness, MatchesADenseStaticSolve, ()) {
  const auto mesh = any_mesh();
  const auto material = any_material();
  const double across = uniform(0.6, 1.6), along = uniform(0.6, 1.6);
  const auto stretch = static_stretch(*assemble(mesh, material), across, along);
  const auto dense = dense_stretch(mesh, material, across, along);
  RC_ASSERT(std::abs(stretch.stiffness_n_per_m / dense.stiffness_n_per_m - 1) < 1e-8);
  RC_ASSERT(stretch.displacement.size() == dense.displacement.size());
  for (std::size_t i = 0; i < dense.displacement.size(); ++i) {
    RC_ASSERT(std::abs(stretch.displacement[i] - dense.displacement[i]) < 1e-7);
  }
}

// Uniform stretch is admissible and costs the constrained modulus. Free sides reduce the stiffness to E.
RC_GTEST_PROP(AxialStiffness, BarIsBetweenYoungsAndConstrainedModulus, ()) {
  const Cells cells = {within(1U, 4U), within(1U, 4U), within(2U, 13U)};
  const double edge = uniform(0.005, 0.05);
  const auto material = any_material();
  const double across = uniform(0.5, 2), along = uniform(0.5, 2), nu = material.poisson;
  const double k = static_stretch(*assemble(*make_block(cells, edge), material), across, along).stiffness_n_per_m;
  const double bar = material.young_pa * (cells[0] * cells[1] * edge * across * across) / (cells[2] * along);
  RC_ASSERT(k / bar > 1 - 1e-9);
  RC_ASSERT(k / bar < (1 - nu) / ((1 + nu) * (1 - 2 * nu)) + 1e-9);
}

TEST(AxialStiffness, BarWithoutLateralStrainIsExact) {
  const Material material{1000, 2e4, 0};
  for (const std::uint32_t length : {1U, 2U, 9U}) {
    const auto terms = assemble(*make_block({2, 3, length}, 0.01), material);
    const double bar = 2e4 * 6 * 0.01 / length;
    EXPECT_NEAR(static_stretch(*terms, 1, 1).stiffness_n_per_m / bar, 1, 1e-9) << length;
    EXPECT_NEAR(static_stretch(*terms, 1.5, 0.7).stiffness_n_per_m / (bar * 1.5 * 1.5 / 0.7), 1, 1e-9) << length;
  }
}

// The clamped ends stiffen a fixed length of bar, so their share is proportional to one over its slenderness.
TEST(AxialStiffness, SlenderBarApproachesYoungsModulus) {
  const Material material;
  double before = 0;
  for (const std::uint32_t length : {4U, 8U, 16U, 32U}) {
    const auto terms = assemble(*make_block({2, 2, length}, 0.01), material);
    const double excess = static_stretch(*terms, 1, 1).stiffness_n_per_m / (material.young_pa * 4 * 0.01 / length) - 1;
    EXPECT_GT(excess, 0);
    if (before > 0) {
      EXPECT_NEAR(before / excess, 2, 0.25) << length;
    }
    before = excess;
  }
  EXPECT_LT(before, 0.02);
}

RC_GTEST_PROP(AxialStiffness, IsTwiceTheEnergyOfAUnitStretch, ()) {
  const auto mesh = any_mesh();
  const auto material = any_material();
  const auto stretch = static_stretch(*assemble(mesh, material), 1, 1);
  const auto model = oracle::assemble(mesh, material);
  const Eigen::Map<const Vector> u(stretch.displacement.data(), static_cast<Eigen::Index>(stretch.displacement.size()));
  RC_ASSERT(std::abs(u.dot(model.stiffness * u) / stretch.stiffness_n_per_m - 1) < 1e-8);
}

std::vector<float> far_shares(const HexahedralMesh& mesh) {
  const Vector share = oracle::far_shares(mesh);
  return {share.begin() + first_insertion_node(mesh.cells), share.end()};
}

RC_GTEST_PROP(AxialStiffness, UniformPullMatchesADenseStaticSolve, ()) {
  const auto mesh = any_mesh();
  const auto material = any_material();
  const double across = uniform(0.6, 1.6), along = uniform(0.6, 1.6);
  const double k = pulled_stiffness(*assemble(mesh, material), far_shares(mesh), across, along);
  const auto model = oracle::assemble(oracle::scaled(mesh, across, along), material);
  const auto moving = oracle::free_components(mesh.cells, FarEnd::sliding);
  Vector load = Vector::Zero(model.stiffness.rows());
  const Vector share = oracle::far_shares(mesh);
  for (Eigen::Index n = 0; n < share.size(); ++n) load(3 * n + 2) = share(n);
  const Matrix inner = model.stiffness(moving, moving);
  const Vector at = load(moving);
  RC_ASSERT(std::abs(at.dot(oracle::solve(inner, at)) * k - 1) < 1e-6);
  // By Castigliano's theorem a face that can warp yields at least as much as a rigid one.
  RC_ASSERT(k <= static_stretch(*assemble(mesh, material), across, along).stiffness_n_per_m * (1 + 1e-6));
}

RC_GTEST_PROP(AxialStiffness, TableMatchesTheDirectSolveWithinAPercent, ()) {
  const auto mesh = any_mesh();
  const auto share = far_shares(mesh);
  const auto terms = *assemble(mesh, any_material());
  const auto table = tabulate_axial_stiffness(terms, share, 0.5, 2);
  for (std::size_t i = 1; i < table.ratio.size(); ++i) RC_ASSERT(table.ratio[i] / table.ratio[i - 1] < 1.2 + 1e-9);
  RC_ASSERT(std::abs(table.ratio.front() - 0.5) < 1e-12 && std::abs(table.ratio.back() - 2) < 1e-12);
  const double along = uniform(0.5, 2), across = along * uniform(0.5, 2);
  const double direct = pulled_stiffness(terms, share, across, along);
  RC_ASSERT(std::abs(axial_stiffness(table, across, along) / direct - 1) < 0.01);
  for (const double ratio : table.ratio) {
    const double at = pulled_stiffness(terms, share, ratio * along, along);
    RC_ASSERT(std::abs(axial_stiffness(table, ratio * along, along) / at - 1) < 1e-6);
  }
}

TEST(AxialStiffness, BeyondTheTableItsEndIsUsed) {
  const auto mesh = *make_block({2, 2, 8}, 0.015);
  const auto table = tabulate_axial_stiffness(*assemble(mesh, Material{}), far_shares(mesh), 0.5, 2);
  for (const double ratio : {1e-3, 0.4, 2.0, 3.0, 1e3}) {
    const double end = ratio < 1 ? table.per_ratio.front() : table.per_ratio.back();
    EXPECT_NEAR(axial_stiffness(table, ratio, 1) / (ratio * ratio * end), 1, 1e-12) << ratio;
  }
}

}  // namespace mobil::axial_stiffness_test
