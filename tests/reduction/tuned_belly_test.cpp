// Effect of active fibres on modal bellies, compared with the tangent of finite strain and dense matrices.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <stdexcept>
#include <vector>

#include "assets/fem/finite_element.h"
#include "assets/reduction/modal_rows.h"
#include "assets/reduction/modal_tension.h"
#include "engine/eigen.h"
#include "tests/fem/spindle.h"

namespace mobil::tuned_belly_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using Square = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;

const ModalBasis& basis_of(bool frame) {
  static const auto make = [](bool loads) {
    ModalBasisOptions o;
    o.frame_loads = loads;
    o.foundation_hz = loads ? 7 : 0;
    o.middle_ratio = 1.1;
    auto basis = make_modal_basis(wide_spindle({4, 4, 16}), Material{}, Element::full, o);
    if (!basis) throw std::runtime_error(basis.error().message);
    return *basis;
  };
  static const ModalBasis both[] = {make(false), make(true)};
  return both[frame ? 1 : 0];
}

Columns random_fields(const HexahedralMesh& mesh, Index count) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> even(-1, 1);
  Columns fields(3 * static_cast<Index>(mesh.node.size()), count);
  for (Index i = 0; i < fields.size(); ++i) fields.data()[i] = even(random);
  return fields;
}

/// Returns the force of fully active fibres at a displacement `u` of the nodes.
VectorXd fibre_force(const HexahedralMesh& mesh, const VectorXd& u) {
  const FiniteTissue tissue;
  VectorXd sum = VectorXd::Zero(u.size());
  const auto elements = finite_elements(mesh, tissue);
  for (const FiniteElement& element : *elements) {
    Corners at, slack, taut;
    for (std::size_t a = 0; a < 8; ++a) {
      const auto& x = mesh.node[element.node[a]];
      const Index row = 3 * Index{element.node[a]};
      at[a] = {x.x + u(row), x.y + u(row + 1), x.z + u(row + 2)};
    }
    element_force(element, tissue, {0, 1}, at, slack, nullptr);
    element_force(element, tissue, {1, 1}, at, taut, nullptr);
    for (std::size_t a = 0; a < 8; ++a) {
      for (std::size_t d = 0; d < 3; ++d)
        sum(3 * Index{element.node[a]} + static_cast<Index>(d)) += taut[a][d] - slack[a][d];
    }
  }
  return sum;
}

TEST(TunedBelly, TensionIsTheTangentOfActiveFibres) {
  const HexahedralMesh mesh = wide_spindle({2, 2, 8});
  const Columns fields = random_fields(mesh, 3);
  const MatrixXd stiffness = tension_stiffness(mesh, FiniteTissue{}.shear_pa, fields);
  constexpr double step_m = 1e-6;
  for (Index c = 0; c < fields.cols(); ++c) {
    const VectorXd moved = step_m * fields.col(c);
    const VectorXd tangent = (fibre_force(mesh, moved) - fibre_force(mesh, -moved)) / (2 * step_m);
    for (Index r = 0; r < fields.cols(); ++r)
      EXPECT_NEAR(fields.col(r).dot(tangent), stiffness(r, c), 1e-6 * stiffness(c, c));
  }
  const MatrixXd stiffer = tension_stiffness(mesh, 2 * FiniteTissue{}.shear_pa, fields);
  EXPECT_NEAR((stiffer - 2 * stiffness).norm() / stiffness.norm(), 0, 1e-12);
}

TEST(TunedBelly, MotionsAreThoseOfSlightTension) {
  for (const bool frame : {false, true}) {
    const ModalBasis& basis = basis_of(frame);
    const auto n = Index{basis.modes};
    for (const double ratio : {basis.lowest_ratio, 1.1, basis.highest_ratio}) {
      const double along = 0.93, across = ratio * along, size = across * along;
      const auto belly = make_modal_belly(basis, across, along, true);
      ASSERT_TRUE(belly) << belly.error().message;
      const Square a(basis.a.data(), n, n), b(basis.b.data(), n, n), c(basis.c.data(), n, n);
      const Square tension(basis.tension.data(), n, n);
      MatrixXd slack = (a / ratio + b + ratio * c) / size;
      if (frame) slack += basis.foundation_1_s2 * Square(basis.foundation.data(), n, n);
      const MatrixXd toned = slack + tuned_activation / (along * along) * tension;
      MatrixXd e(n, n);
      for (Index i = 0; i < n; ++i) {
        for (Index j = 0; j < n; ++j) e(i, j) = belly->eigenvector[i][j];
      }
      const MatrixXd diagonal = e.transpose() * toned * e, taut = e.transpose() * tension * e / (along * along);
      for (Index j = 0; j < n; ++j) {
        const double square = belly->omega_1_s[j] * belly->omega_1_s[j];
        EXPECT_NEAR(diagonal(j, j) / square, 1, 1e-9);
        EXPECT_NEAR(belly->tension_1_s2[j] / taut(j, j), 1, 1e-9);
        EXPECT_GT(belly->tension_1_s2[j], 0);
        for (Index k = 0; k < j; ++k) EXPECT_NEAR(diagonal(j, k), 0, 1e-9 * square);
      }
    }
  }
}

/// If only the end moves a belly, tension changes neither its rest shape nor the force for it.
TEST(TunedBelly, EndDisplacementHasTheUntensionedStaticSolution) {
  for (const bool frame : {false, true}) {
    const ModalBasis& basis = basis_of(frame);
    const auto slack = make_modal_belly(basis, 1.1, 1.02), tuned = make_modal_belly(basis, 1.1, 1.02, true);
    ASSERT_TRUE(slack && tuned);
    EXPECT_FALSE(slack->tuned);
    EXPECT_TRUE(tuned->tuned);
    EXPECT_NEAR(tuned->reaction[0] / slack->reaction[0], 1, 1e-9);
    double largest = 0;
    for (std::size_t i = 0; i < basis.modes; ++i) {
      double rest[2] = {};
      for (std::size_t j = 0; j < basis.modes; ++j) {
        rest[0] += slack->eigenvector[i][j] * (slack->participation[j][0] - slack->lift_share[j]);
        rest[1] += tuned->eigenvector[i][j] * (tuned->participation[j][0] - tuned->lift_share[j]);
      }
      largest = std::max(largest, std::abs(rest[0]));
      EXPECT_NEAR(rest[1], rest[0], 1e-9 * (1e-3 + largest));
    }
    EXPECT_GT(largest, 1e-6);
  }
}

TEST(TunedBelly, LanesAreIndependent) {
  const ModalBasis& basis = basis_of(true);
  std::vector<BellyScale<float>> bodies;
  for (int i = 0; i < 16; ++i)
    bodies.push_back({1.1F + 0.004F * static_cast<float>(i % 5), 1 + 0.003F * static_cast<float>(i % 7)});
  const std::size_t width = modal_motion_width(basis.modes, basis.inputs);
  ModalBellies together, alone;
  together.tuned = alone.tuned = true;
  ASSERT_TRUE(solve_bellies(basis, bodies, together));
  std::vector<Lanes<float>> all(width), own(width);
  write_motions(together, 8, 1.0 / 60, all[0].lane);
  for (std::size_t l = 0; l < bodies.size(); ++l) {
    ASSERT_TRUE(solve_bellies(basis, std::span(&bodies[l], 1), alone));
    write_motions(alone, 8, 1.0 / 60, own[0].lane);
    for (std::size_t w = 0; w < width; ++w)
      EXPECT_EQ(std::bit_cast<std::uint32_t>(own[w][0]), std::bit_cast<std::uint32_t>(all[w][l]));
  }
}

TEST(TunedBelly, SingleBellyMatchesTheBlock) {
  const ModalBasis& basis = basis_of(true);
  const BellyScale<float> body{1.1F, 1};
  const std::size_t width = modal_motion_width(basis.modes, basis.inputs);
  ModalBellies block;
  block.tuned = true;
  ASSERT_TRUE(solve_bellies(basis, std::span(&body, 1), block));
  std::vector<Lanes<float>> words(width);
  write_motions(block, 8, 1.0 / 60, words[0].lane);
  std::vector<float> own(width);
  write_motion(belly_of(block, 0), 8, 1.0 / 60, own);
  for (std::size_t w = 0; w < width; ++w)
    EXPECT_EQ(std::bit_cast<std::uint32_t>(own[w]), std::bit_cast<std::uint32_t>(words[w][0])) << w;
}

}  // namespace
}  // namespace mobil::tuned_belly_test
