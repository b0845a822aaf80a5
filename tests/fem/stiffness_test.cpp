// Stiffness, mass and their affine scaling, compared with dense double-precision assembly.
#include "assets/fem/stiffness_terms.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numeric>

#include "assets/fem/critical_step.h"
#include "tests/fem/any_stiffness.h"

namespace mobil::stiffness_test {
using oracle::Matrix;
using oracle::Vector;

RC_GTEST_PROP(StiffnessTerms, AffineSplitEqualsAssemblyOnTheScaledMesh, ()) {
  const HexahedralMesh mesh = any_belly({2, 2, 4});
  const Material material = any_material();
  const Element kind = any_element();
  const double across = any_between(0.5, 2), along = any_between(0.5, 2);
  const auto terms = assemble(mesh, material, kind);
  RC_ASSERT(terms.has_value());
  const auto direct = oracle::assemble(oracle::scaled(mesh, across, along), material, kind);
  const Matrix split = dense(*terms, across, along);
  RC_ASSERT((split - direct.stiffness).norm() < 1e-12 * direct.stiffness.norm());
  const double mass_scale = across * across * along;
  RC_ASSERT((mass_scale * lumped(*terms) - direct.lumped).norm() < 1e-12 * direct.lumped.norm());
}

RC_GTEST_PROP(StiffnessTerms, ConsistentMassEqualsDirectAssembly, ()) {
  const HexahedralMesh mesh = any_belly({2, 3, 3});
  const Material material = any_material();
  const auto terms = assemble(mesh, material, any_element());
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
  const auto terms = assemble(mesh, material, any_element());
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
  const auto terms = assemble(mesh, any_material(), any_element());
  const Matrix k = dense(*terms, any_between(0.5, 2), any_between(0.5, 2));
  RC_ASSERT((k - k.transpose()).norm() < 1e-13 * k.norm());
  const Vector w = oracle::eigenvalues(k);
  RC_ASSERT(w.head(6).cwiseAbs().maxCoeff() < 1e-11 * w(w.size() - 1));
  RC_ASSERT(w(6) > 1e-7 * w(w.size() - 1));
}

// A linear displacement strains every element equally: no force on inner nodes, σ·n·A on the faces.
RC_GTEST_PROP(StiffnessTerms, PatchTestGivesTheExactConstantStress, ()) {
  const Cells cells = {3, 2, 4};
  const HexahedralMesh mesh = any_distorted_block(cells, 0.01);
  const Material material = any_material();
  const double across = any_between(0.5, 2), along = any_between(0.5, 2);
  const Matrix k = dense(*assemble(mesh, material, any_element()), across, along);
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

/// Returns the deflection of a clamped block's far face under a unit force sideways, relative to Timoshenko's beam.
double bending_flexibility(const Cells& cells, double cell_size_m, double poisson, Element kind) {
  const Material material{1000, 1e4, poisson};
  const HexahedralMesh mesh = *make_block(cells, cell_size_m);
  const auto moving = oracle::free_components(cells, FarEnd::free);
  const Matrix k = dense(*assemble(mesh, material, kind), 1, 1)(moving, moving);
  Vector load = Vector::Zero(3 * static_cast<Eigen::Index>(mesh.node.size()));
  const Vector share = oracle::far_shares(mesh);
  for (Eigen::Index n = 0; n < share.size(); ++n) load(3 * n) = share(n);
  const Vector inner = load(moving);
  const double deflection = inner.dot(k.llt().solve(inner));
  const double length = cells[2] * cell_size_m, width = cells[0] * cell_size_m;
  const double area = width * width, shear = material.young_pa / (2 * (1 + poisson));
  const double beam =
      length * length * length / (material.young_pa * area * area / 4) + length / (5.0 / 6 * shear * area);
  return deflection / beam;
}

TEST(StiffnessTerms, OnlyFullIntegrationLocksNearIncompressibility) {
  for (const double poisson : {0.3333, 0.45, 0.49, 0.4999}) {
    EXPECT_NEAR(bending_flexibility({2, 2, 8}, 0.015, poisson, Element::bbar), 1, 0.15) << poisson;
    EXPECT_NEAR(bending_flexibility({2, 2, 8}, 0.015, poisson, Element::one_point), 1, 0.15) << poisson;
  }
  EXPECT_NEAR(bending_flexibility({2, 2, 8}, 0.015, 0.3333, Element::full), 0.87, 0.05);
  EXPECT_LT(bending_flexibility({2, 2, 8}, 0.015, 0.4999, Element::full), 0.2);
}

TEST(StiffnessTerms, CubesVibrateAtMostAtTheirDilatationFrequency) {
  const double size = 0.015;
  const HexahedralMesh cube = *make_block({1, 1, 1}, size);
  const std::vector<Eigen::Index> all = [] {
    std::vector<Eigen::Index> index(24);
    std::iota(index.begin(), index.end(), 0);
    return index;
  }();
  for (const double poisson : {0.0, 0.3333, 0.49, 0.4999}) {
    const Material material{1000, 1e4, poisson};
    const double exact = 2 / size * std::sqrt(material.young_pa / (material.density_kg_m3 * (1 - 2 * poisson)));
    for (const Element kind : {Element::full, Element::bbar, Element::one_point}) {
      oracle::Model model = oracle::assemble(cube, material, kind);
      model.stiffness = dense(*assemble(cube, material, kind), 1, 1);
      EXPECT_NEAR(oracle::highest_frequency(model, all) / exact, 1, 1e-9) << poisson;
    }
  }
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

}  // namespace mobil::stiffness_test
