// One body's motions: eigenvectors, numbers for the kernels, and states that are fitted and displayed.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <ctime>
#include <stdexcept>
#include <vector>

#include "assets/reduction/modal_basis.h"
#include "assets/reduction/modal_belly.h"
#include "assets/reduction/modal_eigen.h"
#include "assets/reduction/modal_rows.h"
#include "tests/engine/counting_heap.h"
#include "tests/fem/oracle.h"
#include "tests/fem/spindle.h"
#include "tests/refused.h"

namespace mobil::modal_belly_test {
using oracle::Matrix;

int whole(int low, int high) {
  return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(low, high));
}
double uniform(double low, double high) {
  return low + (high - low) * whole(0, 1000001) * 1e-6;
}

const ModalBasis& basis_of(FarEnd far_end, bool frame_loads) {
  static const auto make = [](FarEnd end, bool frame) {
    ModalBasisOptions o;
    o.modes = 16;
    o.far_end = end;
    o.frame_loads = frame;
    o.foundation_hz = frame ? 7 : 0;
    o.corrected = false;
    auto basis = make_modal_basis(wide_spindle({2, 2, 8}), Material{}, Element::full, o);
    if (!basis) throw std::runtime_error(basis.error().message);
    return *basis;
  };
  static const ModalBasis all[3][2] = {{make(FarEnd::held, false), make(FarEnd::held, true)},
                                       {make(FarEnd::sliding, false), make(FarEnd::sliding, true)},
                                       {make(FarEnd::free, false), make(FarEnd::free, true)}};
  return all[static_cast<std::size_t>(far_end)][frame_loads ? 1 : 0];
}

RC_GTEST_PROP(SmallEigen, TurnsAnySymmetricMatrixIntoItsEigenvalues, ()) {
  const auto size = static_cast<std::size_t>(whole(1, 33));
  double matrix[max_modes][max_modes];
  const auto n = static_cast<Eigen::Index>(size);
  Matrix dense = Matrix::Zero(n, n);
  const int kind = whole(0, 3);  // full, sparse, spread over many orders
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double x = uniform(-1, 1);
      if (kind == 1 && whole(0, 4) != 0) x = 0;
      if (kind == 2) x *= std::pow(10.0, -0.2 * static_cast<double>(i + j));
      dense(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = x;
      dense(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(i)) = x;
      matrix[i][j] = matrix[j][i] = x;
    }
  }
  SmallEigen eigen;
  RC_ASSERT(solve_small(matrix, size, eigen));
  Matrix modes(n, n), values = Matrix::Zero(n, n);
  for (std::size_t i = 0; i < size; ++i) {
    values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) = eigen.value[i];
    for (std::size_t j = 0; j < size; ++j) {
      modes(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(i)) = eigen.vector[i][j];
    }
  }
  const double scale = 1e-14 * static_cast<double>(size) * (1 + dense.norm());
  RC_ASSERT(std::is_sorted(eigen.value, eigen.value + size));
  RC_ASSERT((modes.transpose() * modes - Matrix::Identity(n, n)).norm() <= 1e-13 * static_cast<double>(size));
  RC_ASSERT((dense * modes - modes * values).norm() <= 10 * scale);
}

TEST(SmallEigen, ReportsNan) {
  double matrix[max_modes][max_modes] = {};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) matrix[i][j] = std::nan("");
  }
  SmallEigen eigen;
  EXPECT_FALSE(solve_small(matrix, 4, eigen));
}

// A tick applies [a b; −b a − g·b] to (Y, V). Its trace and determinant are those of e^(λ·h), λ² + α·λ + ω² = 0.
RC_GTEST_PROP(ModalMotion, IsTheExactFlowOfADampedOscillator, ()) {
  ModalBelly belly{};
  belly.modes = 1;
  belly.inputs = 1;
  const double omega = std::pow(10.0, uniform(-1, 4)), tick = std::pow(10.0, uniform(-4, 0));
  const double alpha = whole(0, 4) == 0 ? 0 : whole(0, 4) == 0 ? 2 * omega : std::pow(10.0, uniform(-2, 3));
  belly.omega_1_s[0] = omega;
  belly.participation[0][0] = 1;
  float motion[3];
  write_motion(belly, alpha, tick, motion);
  const auto a = static_cast<double>(motion[0]), b = static_cast<double>(motion[1]), g = static_cast<double>(motion[2]);
  using C = std::complex<long double>;
  const auto half = static_cast<long double>(alpha) / 2, w = static_cast<long double>(omega);
  const C root = std::sqrt(C(half * half - w * w, 0));
  const long double h = tick;
  const auto one = std::exp((-half + root) * h), other = std::exp((-half - root) * h);
  RC_ASSERT(std::abs(g - alpha / omega) <= 1e-6 * g);
  const double size = 1e-6 * (1 + g) * (1 + g);
  RC_ASSERT(std::abs(2 * a - g * b - static_cast<double>((one + other).real())) <= size);
  RC_ASSERT(std::abs(a * (a - g * b) + b * b - static_cast<double>((one * other).real())) <= size);
  RC_ASSERT(a * (a - g * b) + b * b <= 1.0);
  const double beginning = omega * tick * std::exp(-alpha * tick / 2);  // and b has the sign of the initial motion
  if (omega * tick < 3) RC_ASSERT((b > 0) == (beginning > 0) || b == 0);
}

TEST(ModalBelly, FailsInOneLineOutsideItsRange) {
  const auto& basis = basis_of(FarEnd::held, false);
  EXPECT_TRUE(make_modal_belly(basis, 1.05, 1));
  EXPECT_TRUE(make_modal_belly(basis, static_cast<double>(1.05F), 1));
  for (const auto& [across, along] :
       {std::pair{1.06, 1.0}, {1.0, 1.06}, {0.0, 1.0}, {-1.0, -1.0}, {std::nan(""), 1.0}}) {
    EXPECT_TRUE(is_refused(make_modal_belly(basis, across, along), "0.9524 and 1.05"));
  }
}

// One body that is spawned in a running crowd.
TEST(ModalBellies, AllocateNothingTheSecondTime) {
  const auto& basis = basis_of(FarEnd::held, true);
  const std::vector<BellyScale<float>> first(lane_count, {1, 1}), second = {{1.01F, 0.99F}};
  std::vector<Lanes<float>> motion(modal_motion_width(basis.modes, basis.inputs)),
      shape(modal_shape_width(basis.modes, basis.inputs));
  ModalBellies bellies;
  ASSERT_TRUE(solve_bellies(basis, first, bellies));
  const std::size_t before = heap_requests;
  const auto solved = solve_bellies(basis, second, bellies);
  write_motions(bellies, 8, 1.0 / 60, motion[0].lane);
  write_shapes(bellies, 8, shape[0].lane);
  EXPECT_EQ(heap_requests, before);
  EXPECT_TRUE(solved);
  EXPECT_TRUE(std::all_of(shape.begin(), shape.end(), [](const Lanes<float>& x) { return std::isfinite(x[0]); }));
}

// This test only prints.
TEST(ModalBelly, DISABLED_Microseconds) {
  for (const bool frame : {false, true}) {
    for (const std::uint32_t modes : {8U, 12U, 16U}) {
      const auto basis = truncated(basis_of(FarEnd::held, frame), modes);
      constexpr int bellies = 20000;
      double sum = 0;
      const std::clock_t begin = std::clock();  // of this process only
      for (int i = 0; i < bellies; ++i) sum += make_modal_belly(basis, 1 + 1e-6 * i, 1)->omega_1_s[0];
      const double took_us = 1e6 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
      fmt::print("{} modes, {} inputs: {:.2f} us a belly ({:.3g} Hz)\n", modes, basis.inputs, took_us / bellies,
                 sum / bellies / 6.283);
    }
  }
}

RC_GTEST_PROP(ModalState, FitOfADisplayedStateIsTheState, ()) {
  const auto& basis = basis_of(static_cast<FarEnd>(whole(0, 3)), whole(0, 2) == 1);
  const double ratio = uniform(0.96, 1.04), product = uniform(0.8, 1.1);
  const auto belly = make_modal_belly(basis, std::sqrt(ratio * product), std::sqrt(product / ratio)).value();
  std::vector<double> input(basis.inputs), rate(basis.inputs);
  for (std::size_t k = 0; k < input.size(); ++k) {
    input[k] = uniform(-0.02, 0.02);
    rate[k] = uniform(-0.2, 0.2);
  }
  std::vector<float> state(modal_state_width(basis.modes)), again(state.size());
  for (std::size_t j = 0; j < basis.modes; ++j) {
    // divided by P with one input: equally large displacements in all motions
    const double unit = basis.inputs == 1 ? std::max(1e-4, std::abs(belly.participation[j][0])) : 1;
    state[2 * j] = static_cast<float>(uniform(-0.05, 0.05) * belly.omega_1_s[j] / unit);
    state[2 * j + 1] = static_cast<float>(uniform(-0.5, 0.5) / unit);
  }
  const std::size_t width = 3 * basis.control_weight.size();
  std::vector<float> u(width), v(width), u2(width), v2(width);
  show_state(basis, belly, input, rate, state, u, v);
  fit_state(basis, belly, input, rate, u, v, again);
  show_state(basis, belly, input, rate, again, u2, v2);
  const auto off = [](const std::vector<float>& a, const std::vector<float>& b) {
    double error = 0, norm = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      error += std::pow(static_cast<double>(a[i]) - static_cast<double>(b[i]), 2);
      norm += std::pow(static_cast<double>(a[i]), 2);
    }
    return std::sqrt(error / norm);
  };
  RC_ASSERT(off(u, u2) < 1e-4);
  RC_ASSERT(off(v, v2) < 1e-4);
}

// At rest, all of a state is zero, and its displacement is that placed by `shape`.
RC_GTEST_PROP(ModalState, IsZeroAtRest, ()) {
  const auto& basis = basis_of(static_cast<FarEnd>(whole(0, 3)), whole(0, 2) == 1);
  const auto belly = make_modal_belly(basis, 1.0, uniform(0.96, 1.04)).value();
  std::vector<double> input(basis.inputs);
  const std::vector<double> rate(basis.inputs, 0.0);
  for (double& x : input) x = uniform(-0.02, 0.02);
  const std::size_t n = basis.modes, width = 3 * basis.control_weight.size(), row = n + basis.inputs;
  std::vector<float> zero(modal_state_width(basis.modes)), u(width), v(width),
      shape(modal_shape_width(basis.modes, basis.inputs));
  show_state(basis, belly, input, rate, zero, u, v);
  write_shape(belly, 8, shape);
  double largest = 0;
  for (const float x : u) largest = std::max(largest, std::abs(static_cast<double>(x)));
  for (std::size_t i = 0; i < width; ++i) {
    double placed = static_cast<double>(basis.shape[i * (n + 1)]) * input[0];
    for (std::size_t k = 0; k < n; ++k) {
      double q = 0;
      for (std::size_t m = 0; m < basis.inputs; ++m) q += static_cast<double>(shape[k * row + n + m]) * input[m];
      placed += static_cast<double>(basis.shape[i * (n + 1) + 1 + k]) * q;
    }
    RC_ASSERT(std::abs(placed - static_cast<double>(u[i])) <= 1e-5 * largest);
    RC_ASSERT(v[i] == 0.0F);
  }
}

}  // namespace mobil::modal_belly_test
