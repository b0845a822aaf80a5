// Motions of sixteen bodies solved together: correct for each, and independent of the other lanes.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "assets/reduction/modal_basis.h"
#include "assets/reduction/modal_rows.h"
#include "tests/fem/spindle.h"
#include "tests/refused.h"

namespace mobil::modal_bellies_test {
const ModalBasis& basis_of(int kind) {
  static const auto make = [](FarEnd end, bool frame, std::uint32_t modes) {
    ModalBasisOptions o;
    o.modes = modes;
    o.far_end = end;
    o.frame_loads = frame;
    o.foundation_hz = frame ? 7 : 0;
    auto basis = make_modal_basis(wide_spindle({2, 2, 8}), Material{}, Element::full, o);
    if (!basis) throw std::runtime_error(basis.error().message);
    return *basis;
  };
  static const ModalBasis all[] = {make(FarEnd::held, false, 12),   make(FarEnd::held, true, 12),
                                   make(FarEnd::sliding, false, 7), make(FarEnd::free, true, 5),
                                   make(FarEnd::held, false, 1),    make(FarEnd::sliding, true, 16)};
  return all[kind];
}

BellyScale<float> random_scale(const ModalBasis& basis) {
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

std::vector<Rows> rows_of(const ModalBasis& basis, const std::vector<BellyScale<float>>& bodies, double damping,
                          ModalBellies& bellies) {
  const auto solved = solve_bellies(basis, bodies, bellies);
  if (!solved) throw std::runtime_error(solved.error().message);
  const std::size_t motion = modal_motion_width(basis.modes, basis.inputs);
  const std::size_t shape = modal_shape_width(basis.modes, basis.inputs);
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

RC_GTEST_PROP(ModalBellies, LanesAreIndependent, ()) {
  const ModalBasis& basis = basis_of(*rc::gen::inRange(0, 6));
  const double damping = *rc::gen::element(0.0, 8.0, 500.0);
  std::vector<BellyScale<float>> bodies(static_cast<std::size_t>(*rc::gen::inRange(1, 17)));
  for (auto& body : bodies) body = random_scale(basis);
  ModalBellies together, alone;
  const auto rows = rows_of(basis, bodies, damping, together);
  for (std::size_t l = 0; l < bodies.size(); ++l) {
    const auto own = rows_of(basis, {bodies[l]}, damping, alone);
    RC_ASSERT(same_bits(own[0].motion, rows[l].motion));
    RC_ASSERT(same_bits(own[0].shape, rows[l].shape));
  }
}

RC_GTEST_PROP(ModalBellies, RestInTheirStaticSolution, ()) {
  const ModalBasis& basis = basis_of(*rc::gen::element(0, 2, 4));
  std::vector<BellyScale<float>> bodies(static_cast<std::size_t>(*rc::gen::inRange(1, 17)));
  for (auto& body : bodies) body = random_scale(basis);
  ModalBellies bellies;
  RC_ASSERT(solve_bellies(basis, bodies, bellies).has_value());
  Lanes<float> input{};
  for (std::size_t l = 0; l < bodies.size(); ++l) input[l] = 1e-4F * static_cast<float>(*rc::gen::inRange(-300, 301));
  const std::size_t rows = 3 * basis.control_weight.size();
  std::vector<Lanes<float>> placed(rows);
  place_at_rest(basis, bellies, input, placed[0].lane);
  for (std::size_t l = 0; l < bodies.size(); ++l) {
    const double inputs[] = {static_cast<double>(input[l])}, rates[] = {0};
    const std::vector<float> still(modal_state_width(basis.modes));
    std::vector<float> displacement(rows), velocity(rows);
    show_state(basis, belly_of(bellies, l), inputs, rates, still, displacement, velocity);
    for (std::size_t r = 0; r < rows; ++r) {
      RC_ASSERT(std::abs(placed[r][l] - displacement[r]) <= 1e-6F * (1e-3F + std::abs(displacement[r])));
    }
  }
}

TEST(ModalBellies, RefuseBodiesOutsideTheRangeInOneLine) {
  const ModalBasis& basis = basis_of(0);
  ModalBellies bellies;
  std::vector<BellyScale<float>> bodies(5, {1, 1});
  EXPECT_TRUE(solve_bellies(basis, bodies, bellies));
  for (const BellyScale<float> wrong : {BellyScale<float>{1.2F, 1}, {1, 1.2F}, {0, 1}, {1, -1}, {NAN, 1}}) {
    bodies[3] = wrong;
    EXPECT_TRUE(is_refused(solve_bellies(basis, bodies, bellies)));
  }
}

}  // namespace mobil::modal_bellies_test
