// Sixteen bodies' motions solved together: right for each, and the same whoever shares the block.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "assets/fem/hexahedral_mesh.h"
#include "assets/reduction/reduced_basis.h"
#include "assets/reduction/reduced_rows.h"
#include "tests/reduction/scalar_belly.h"

namespace mobil::reduced_bellies_test {
const ReducedBasis& basis_of(int kind) {
  static const auto make = [](FarEnd end, bool frame, std::uint32_t vectors) {
    const std::vector<CageStation> stations = {
        {0, 0, 0, 0.02F, 0.018F}, {0.4F, 0.008F, -0.01F, 0.036F, 0.03F}, {1, 0, 0, 0.014F, 0.012F}};
    ReducedOptions o;
    o.vectors = vectors;
    o.far_end = end;
    o.frame_loads = frame;
    o.foundation_hz = frame ? 7 : 0;
    auto basis = make_reduced_basis(*bend_block({2, 2, 8}, stations, 0.24), Material{}, Element::full, o);
    if (!basis) throw std::runtime_error(basis.error().message);
    return *basis;
  };
  static const ReducedBasis all[] = {make(FarEnd::held, false, 12),   make(FarEnd::held, true, 12),
                                     make(FarEnd::sliding, false, 7), make(FarEnd::free, true, 5),
                                     make(FarEnd::held, false, 1),    make(FarEnd::sliding, true, 16)};
  return all[kind];
}

BellyScale<float> random_scale(const ReducedBasis& basis) {
  const double part = *rc::gen::inRange(0, 1001) * 1e-3, size = 0.7 + *rc::gen::inRange(0, 601) * 1e-3;
  const double ratio = basis.lowest_ratio * std::pow(basis.highest_ratio / basis.lowest_ratio, part);
  return {static_cast<float>(size * std::sqrt(ratio)), static_cast<float>(size / std::sqrt(ratio))};
}

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](T x, T y) {
           return std::bit_cast<std::uint32_t>(x) == std::bit_cast<std::uint32_t>(y);
         });
}

struct Rows {
  std::vector<float> motion, shape;
};

std::vector<Rows> rows_of(const ReducedBasis& basis, const std::vector<BellyScale<float>>& bodies, double damping,
                          ReducedBellies& bellies) {
  const auto solved = solve_bellies(basis, bodies, bellies);
  if (!solved) throw std::runtime_error(solved.error().message);
  const std::size_t motion = reduced_motion_width(basis.vectors, basis.inputs);
  const std::size_t shape = reduced_shape_width(basis.vectors, basis.inputs);
  std::vector<Lanes<float>> motions(motion), shapes(shape);
  write_motions(bellies, damping, 1.0 / 60, motions[0].lane);
  write_shapes(bellies, damping, shapes[0].lane);
  std::vector<Rows> rows(bodies.size());
  for (std::size_t l = 0; l < bodies.size(); ++l) {
    for (const auto& word : motions) rows[l].motion.push_back(word[l]);
    for (const auto& word : shapes) rows[l].shape.push_back(word[l]);
  }
  return rows;
}

RC_GTEST_PROP(ReducedBellies, WhatALaneGetsDoesNotDependOnTheOthers, ()) {
  const ReducedBasis& basis = basis_of(*rc::gen::inRange(0, 6));
  const double damping = *rc::gen::element(0.0, 8.0, 500.0);
  std::vector<BellyScale<float>> bodies(static_cast<std::size_t>(*rc::gen::inRange(1, 17)));
  for (auto& body : bodies) body = random_scale(basis);
  ReducedBellies together, alone;
  const auto rows = rows_of(basis, bodies, damping, together);
  for (std::size_t l = 0; l < bodies.size(); ++l) {
    const auto own = rows_of(basis, {bodies[l]}, damping, alone);
    RC_ASSERT(same_bits(own[0].motion, rows[l].motion));
    RC_ASSERT(same_bits(own[0].shape, rows[l].shape));
  }
}

RC_GTEST_PROP(ReducedBellies, MatchTheScalarSolver, ()) {
  const ReducedBasis& basis = basis_of(*rc::gen::inRange(0, 6));
  const double damping = *rc::gen::element(0.0, 8.0, 500.0);
  std::vector<BellyScale<float>> bodies(16);
  for (auto& body : bodies) body = random_scale(basis);
  ReducedBellies bellies;
  const auto rows = rows_of(basis, bodies, damping, bellies);
  for (std::size_t l = 0; l < bodies.size(); ++l) {
    const auto expected =
        oracle::make_reduced_belly(basis, static_cast<double>(bodies[l].across), static_cast<double>(bodies[l].along))
            .value();
    const ReducedBelly own = belly_of(bellies, l);
    for (std::size_t j = 0; j < basis.vectors; ++j) {
      RC_ASSERT(std::abs(own.omega_1_s[j] / expected.omega_1_s[j] - 1) < 1e-9);
      if (j > 0) RC_ASSERT(own.omega_1_s[j] >= own.omega_1_s[j - 1]);
      for (std::size_t k = 0; k <= j; ++k) {
        double product = 0;
        for (std::size_t i = 0; i < basis.vectors; ++i) product += own.eigenvector[i][j] * own.eigenvector[i][k];
        RC_ASSERT(std::abs(product - (j == k ? 1 : 0)) < 1e-11);
      }
    }
    for (std::size_t k = 0; k < basis.inputs; ++k) {
      RC_ASSERT(std::abs(own.reaction[k] - expected.reaction[k]) <= 1e-7 * (1 + std::abs(expected.reaction[k])));
      // Where a motion's sign is free, what all of them come to is not.
      for (std::size_t i = 0; i < basis.vectors; ++i) {
        double rest = 0, should = 0, most = 0;
        for (std::size_t j = 0; j < basis.vectors; ++j) {
          rest += own.eigenvector[i][j] * own.participation[j][k];
          should += expected.eigenvector[i][j] * expected.participation[j][k];
          most = std::max(most, std::abs(expected.participation[j][k]));
        }
        RC_ASSERT(std::abs(rest - should) <= 1e-8 * most);
      }
    }
    std::vector<float> motion(rows[l].motion.size()), shape(rows[l].shape.size());
    oracle::write_motion(own, damping, 1.0 / 60, motion);
    oracle::write_shape(own, damping, shape);
    const std::size_t stride = motion.size() / basis.vectors;
    for (std::size_t w = 0; w < motion.size(); ++w) {
      if (w % stride < 3) {
        RC_ASSERT(std::abs(motion[w] - rows[l].motion[w]) <= 2e-7F * (1 + std::abs(motion[w])));
      } else {
        RC_ASSERT(std::bit_cast<std::uint32_t>(motion[w]) == std::bit_cast<std::uint32_t>(rows[l].motion[w]));
      }
    }
    for (std::size_t w = 0; w < shape.size(); ++w) {
      RC_ASSERT(std::abs(shape[w] - rows[l].shape[w]) <= 1e-6F * (1e-3F + std::abs(shape[w])));
    }
  }
}

RC_GTEST_PROP(ReducedBellies, RestWhereTheirStaticAnswerIs, ()) {
  const ReducedBasis& basis = basis_of(*rc::gen::element(0, 2, 4));
  std::vector<BellyScale<float>> bodies(static_cast<std::size_t>(*rc::gen::inRange(1, 17)));
  for (auto& body : bodies) body = random_scale(basis);
  ReducedBellies bellies;
  RC_ASSERT(solve_bellies(basis, bodies, bellies).has_value());
  Lanes<float> input{};
  for (std::size_t l = 0; l < bodies.size(); ++l) input[l] = 1e-4F * static_cast<float>(*rc::gen::inRange(-300, 301));
  const std::size_t rows = 3 * basis.control_weight.size();
  std::vector<Lanes<float>> placed(rows);
  place_at_rest(basis, bellies, input, placed[0].lane);
  for (std::size_t l = 0; l < bodies.size(); ++l) {
    const double inputs[] = {static_cast<double>(input[l])}, rates[] = {0};
    const std::vector<float> still(reduced_state_width(basis.vectors));
    std::vector<float> displacement(rows), velocity(rows);
    show_state(basis, belly_of(bellies, l), inputs, rates, still, displacement, velocity);
    for (std::size_t r = 0; r < rows; ++r) {
      RC_ASSERT(std::abs(placed[r][l] - displacement[r]) <= 1e-6F * (1e-3F + std::abs(displacement[r])));
    }
  }
}

TEST(ReducedBellies, RefuseBodiesOutsideTheRangeInOneLine) {
  const ReducedBasis& basis = basis_of(0);
  ReducedBellies bellies;
  std::vector<BellyScale<float>> bodies(5, {1, 1});
  EXPECT_TRUE(solve_bellies(basis, bodies, bellies));
  for (const BellyScale<float> wrong : {BellyScale<float>{1.2F, 1}, {1, 1.2F}, {0, 1}, {1, -1}, {NAN, 1}}) {
    bodies[3] = wrong;
    const auto solved = solve_bellies(basis, bodies, bellies);
    ASSERT_FALSE(solved);
    EXPECT_EQ(solved.error().message.find('\n'), std::string::npos);
  }
}

}  // namespace mobil::reduced_bellies_test
