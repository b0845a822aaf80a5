// Stiffness, mass, their affine scaling and the critical step, against dense double-precision assembly.
#include "assets/stiffness_terms.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "assets/critical_step.h"
#include "tests/oracle.h"

namespace mobil {
namespace {

using oracle::Matrix;
using oracle::Vector;

double any_between(double low, double high) {
  return low + (high - low) * *rc::gen::inRange(0, 10001) * 1e-4;
}

HexahedralMesh any_belly(const Cells& cells) {
  std::vector<CageStation> stations;
  for (const float t : {0.0F, 0.4F, 1.0F}) {
    stations.push_back({t, static_cast<float>(any_between(-0.01, 0.01)), static_cast<float>(any_between(-0.01, 0.01)),
                        static_cast<float>(any_between(0.02, 0.04)), static_cast<float>(any_between(0.02, 0.04))});
  }
  return *bend_block(cells, stations, 0.2);
}

Material any_material() {
  return {any_between(500, 2000), any_between(1e3, 1e5), any_between(-0.3, 0.47)};
}

/// The stencil written out as a dense matrix.
Matrix dense(const StiffnessTerms& terms, double across, double along) {
  const auto size = static_cast<Eigen::Index>(3 * terms.lumped_mass_kg.size());
  Matrix k = Matrix::Zero(size, size);
  for_each_node(terms.cells, [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    const std::uint32_t n = node_index(terms.cells, x, y, z);
    for_each_neighbour(terms.cells, x, y, z, [&](std::uint32_t m, std::size_t slot) {
      const auto block = stiffness_block(terms.pair[n * stencil_size + slot], across, along);
      for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t c = 0; c < 3; ++c) {
          k(static_cast<Eigen::Index>(3 * n + r), static_cast<Eigen::Index>(3 * m + c)) = block[3 * r + c];
        }
      }
    });
  });
  return k;
}

Vector lumped(const StiffnessTerms& terms) {
  Vector m(static_cast<Eigen::Index>(3 * terms.lumped_mass_kg.size()));
  for (Eigen::Index i = 0; i < m.size(); ++i) m(i) = terms.lumped_mass_kg[static_cast<std::size_t>(i / 3)];
  return m;
}

RC_GTEST_PROP(StiffnessTerms, AffineSplitEqualsAssemblyOnTheScaledMesh, ()) {
  const HexahedralMesh mesh = any_belly({2, 2, 4});
  const Material material = any_material();
  const double across = any_between(0.5, 2), along = any_between(0.5, 2);
  const auto terms = assemble(mesh, material);
  RC_ASSERT(terms.has_value());
  const auto direct = oracle::assemble(oracle::scaled(mesh, across, along), material);
  const Matrix split = dense(*terms, across, along);
  RC_ASSERT((split - direct.stiffness).norm() < 1e-12 * direct.stiffness.norm());
  const double mass_scale = across * across * along;
  RC_ASSERT((mass_scale * lumped(*terms) - direct.lumped).norm() < 1e-12 * direct.lumped.norm());
}

RC_GTEST_PROP(StiffnessTerms, ConsistentMassEqualsDirectAssembly, ()) {
  const HexahedralMesh mesh = any_belly({2, 3, 3});
  const Material material = any_material();
  const auto terms = assemble(mesh, material);
  const auto direct = oracle::assemble(mesh, material);
  double worst = 0;
  for_each_node(terms->cells, [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    const std::uint32_t n = node_index(terms->cells, x, y, z);
    for_each_neighbour(terms->cells, x, y, z, [&](std::uint32_t m, std::size_t slot) {
      const double mine = terms->consistent_mass_kg[n * stencil_size + slot];
      worst = std::max(worst, std::abs(mine - direct.mass(3 * n, 3 * m)));
    });
  });
  RC_ASSERT(worst < 1e-12 * direct.mass.norm());
}

RC_GTEST_PROP(StiffnessTerms, TotalMassIsDensityTimesVolume, ()) {
  const HexahedralMesh mesh = any_belly({3, 2, 5});
  const Material material = any_material();
  const auto terms = assemble(mesh, material);
  double lump = 0, consistent = 0;
  for (const double m : terms->lumped_mass_kg) {
    RC_ASSERT(m > 0);
    lump += m;
  }
  for (const double m : terms->consistent_mass_kg) consistent += m;
  const double exact = material.density_kg_m3 * volume(mesh);
  RC_ASSERT(std::abs(lump / exact - 1) < 1e-13);
  RC_ASSERT(std::abs(consistent / exact - 1) < 1e-12);
}

RC_GTEST_PROP(StiffnessTerms, SymmetricWithSixRigidModesAndNoOther, ()) {
  const HexahedralMesh mesh = any_belly({2, 2, 3});
  const auto terms = assemble(mesh, any_material());
  const Matrix k = dense(*terms, any_between(0.5, 2), any_between(0.5, 2));
  RC_ASSERT((k - k.transpose()).norm() < 1e-13 * k.norm());
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(k, Eigen::EigenvaluesOnly);
  const auto& w = solver.eigenvalues();
  RC_ASSERT(w.head(6).cwiseAbs().maxCoeff() < 1e-11 * w(w.size() - 1));
  RC_ASSERT(w(6) > 1e-7 * w(w.size() - 1));
}

// A linear displacement strains every element alike: no force on inner nodes, σ·n·A on the faces.
RC_GTEST_PROP(StiffnessTerms, PatchTestGivesTheExactConstantStress, ()) {
  const Cells cells = {3, 2, 4};
  HexahedralMesh mesh = *make_block(cells, 0.01);
  for_each_node(cells, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    if (i == 0 || i == cells[0] || j == 0 || j == cells[1] || k == 0 || k == cells[2]) return;
    auto& p = mesh.node[node_index(cells, i, j, k)];
    p = {p.x + any_between(-0.002, 0.002), p.y + any_between(-0.002, 0.002), p.z + any_between(-0.002, 0.002)};
  });
  const Material material = any_material();
  const double across = any_between(0.5, 2), along = any_between(0.5, 2);
  const Matrix k = dense(*assemble(mesh, material), across, along);
  Eigen::Matrix3d gradient;
  for (int i = 0; i < 9; ++i) gradient(i / 3, i % 3) = any_between(-1, 1);
  const HexahedralMesh body = oracle::scaled(mesh, across, along);
  Vector u(k.rows());
  for (std::size_t n = 0; n < body.node.size(); ++n) {
    const auto& p = body.node[n];
    u.segment<3>(static_cast<Eigen::Index>(3 * n)) = gradient * Eigen::Vector3d(p.x, p.y, p.z);
  }
  const Vector f = k * u;
  const double lambda = material.young_pa * material.poisson / ((1 + material.poisson) * (1 - 2 * material.poisson));
  const double mu = material.young_pa / (2 * (1 + material.poisson));
  const Eigen::Matrix3d strain = 0.5 * (gradient + gradient.transpose());
  const Eigen::Matrix3d stress = lambda * strain.trace() * Eigen::Matrix3d::Identity() + 2 * mu * strain;
  const double scale = f.norm();
  for_each_node(cells, [&](std::uint32_t i, std::uint32_t j, std::uint32_t kk) {
    const bool inside = i > 0 && i < cells[0] && j > 0 && j < cells[1] && kk > 0 && kk < cells[2];
    const Eigen::Vector3d force = f.segment<3>(3 * node_index(cells, i, j, kk));
    if (inside) RC_ASSERT(force.norm() < 1e-12 * scale);
  });
  // virial: the sum of f ⊗ x over all nodes is σ·V
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
  for (std::size_t n = 0; n < body.node.size(); ++n) {
    const auto& p = body.node[n];
    moment += f.segment<3>(static_cast<Eigen::Index>(3 * n)) * Eigen::RowVector3d(p.x, p.y, p.z);
  }
  RC_ASSERT((moment - stress * volume(body)).norm() < 1e-11 * stress.norm() * volume(body));
}

TEST(StiffnessTerms, NonsenseMaterialIsRefused) {
  const auto mesh = make_block({2, 2, 2}, 0.01);
  const auto with = [&](double density, double young, double poisson) {
    return assemble(*mesh, Material{density, young, poisson}).has_value();
  };
  EXPECT_TRUE(with(1000, 1e4, 0.3));
  for (const double bad : {0.0, -1.0, std::nan(""), double{INFINITY}}) {
    EXPECT_FALSE(with(bad, 1e4, 0.3));
    EXPECT_FALSE(with(1000, bad, 0.3));
  }
  for (const double bad : {-1.0, 0.5, 0.7, std::nan("")}) EXPECT_FALSE(with(1000, 1e4, bad));
}

constexpr FarEnd any_end[] = {FarEnd::held, FarEnd::sliding, FarEnd::free};

TEST(CriticalStep, ClampedBlockOfThePaperHas3point48Milliseconds) {
  const auto terms = assemble(*make_block({2, 2, 8}, 0.015), Material{});
  EXPECT_NEAR(critical_step(*terms, 1, 1, FarEnd::free), 3.48e-3, 0.005e-3);
  EXPECT_NEAR(element_critical_step(*make_block({2, 2, 8}, 0.015), Material{}, 1, 1), 2.65e-3, 0.005e-3);
}

RC_GTEST_PROP(CriticalStep, NeverAboveTheExactLimitAndWithinATenthOfAPercent, ()) {
  const HexahedralMesh mesh = any_belly({2, 2, 8});
  const Material material = any_material();
  const double across = any_between(0.5, 2), along = any_between(0.5, 2);
  const FarEnd end = any_end[*rc::gen::inRange(0, 3)];
  const auto terms = assemble(mesh, material);
  const auto model = oracle::assemble(oracle::scaled(mesh, across, along), material);
  const double exact = 2 / oracle::highest_frequency(model, oracle::free_components(mesh.cells, end));
  const double step = critical_step(*terms, across, along, end);
  RC_ASSERT(step <= exact);
  RC_ASSERT(step > 0.999 * exact);
  RC_ASSERT(element_critical_step(mesh, material, across, along) <= exact * (1 + 1e-9));
}

RC_GTEST_PROP(CriticalStep, TableIsSafeBetweenItsEntriesAndWithinOnePercent, ()) {
  const HexahedralMesh mesh = any_belly({2, 2, 6});
  const Material material = any_material();
  const FarEnd end = any_end[*rc::gen::inRange(0, 3)];
  const auto terms = assemble(mesh, material);
  const CriticalSteps table = tabulate_critical_steps(*terms, end, 0.5, 2);
  const double across = any_between(0.7, 1.4), along = across / any_between(0.5, 2);
  const auto model = oracle::assemble(oracle::scaled(mesh, across, along), material);
  const double exact = 2 / oracle::highest_frequency(model, oracle::free_components(mesh.cells, end));
  const auto step = critical_step(table, across, along);
  RC_ASSERT(step.has_value());
  RC_ASSERT(*step <= exact);
  RC_ASSERT(*step > 0.99 * exact);
}

TEST(CriticalStep, TableRefusesWhatItDoesNotCover) {
  const auto terms = assemble(*make_block({1, 1, 2}, 0.015), Material{});
  const auto table = tabulate_critical_steps(*terms, FarEnd::held, 0.8, 1.25);
  EXPECT_TRUE(critical_step(table, 1, 1));
  EXPECT_FALSE(critical_step(table, 1, 2));
  EXPECT_FALSE(critical_step(table, 2, 1));
  EXPECT_FALSE(critical_step(table, 0, 1));
  EXPECT_FALSE(critical_step(table, std::nan(""), 1));
}

TEST(CriticalStep, LongestMeshesGetASafeStepToo) {
  // too wide to factorise: the margin replaces the proof. The exact limit of a block of cubes hardly depends on how
  // many there are once there are several, so a smaller block, whose ω is lower, bounds it from one side.
  const auto large = assemble(*make_block({16, 16, 34}, 0.005), Material{});
  const auto small = assemble(*make_block({6, 6, 12}, 0.005), Material{});
  const double step = critical_step(*large, 1, 1, FarEnd::free);
  EXPECT_LT(step, critical_step(*small, 1, 1, FarEnd::free));
  EXPECT_GE(step, 0.999 * element_critical_step(*make_block({1, 1, 1}, 0.005), Material{}, 1, 1));
}

RC_GTEST_PROP(CriticalStep, SubstepsAreTheFewestThatFit, ()) {
  const double limit = any_between(1e-4, 1e-2), tick = 1.0 / 60;
  const auto n = substeps_within(limit, tick);
  RC_ASSERT(tick / n <= 0.9 * limit * (1 + 1e-12));
  RC_ASSERT(n == 1U || tick / (n - 1) > 0.9 * limit);
}

}  // namespace
}  // namespace mobil
