// The integrator of a step's equations, compared with exact solutions, Boost.Odeint and the energy of the models.
#include "tests/gait/adams.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <vector>

#include "tests/gait/adams_systems.h"

namespace mobil::step::adams_test {
template <std::size_t N>
AdamsOptions<N> tolerance(double value) {
  AdamsOptions<N> o;
  o.absolute = o.relative = alike<N>(value);
  return o;
}

template <std::size_t N>
AdamsOptions<N> fixed_step(double step) {
  AdamsOptions<N> o;
  o.fixed_step_s = step;
  return o;
}

template <std::size_t N>
struct Solution {
  Path<N> path;
  AdamsResult<N> result;
};

template <class System, std::size_t N = System::size>
Solution<N> solve(const System& system, const AdamsOptions<N>& options) {
  Path<N> path;
  int taken = 0;
  const auto result =
      integrate_adams<N>(system, system.start, 0.0, system.end, options,
                         at_equal_times<N>(0.0, system.end, samples, [&](int i, double t, const Unknowns<N>& y) {
                           EXPECT_EQ(i, taken++);
                           EXPECT_NEAR(t, system.end * i / (samples - 1), 1e-15);
                           path.at(static_cast<std::size_t>(i)) = y;
                         }));
  EXPECT_EQ(taken, samples);
  if (!result) {
    ADD_FAILURE() << result.error().message;
    return {path, {}};
  }
  EXPECT_EQ(path.back(), result->state);
  EXPECT_EQ(path.front(), system.start);
  return {path, *result};
}

/// Returns the slope of the line fitted to (log x, log y).
double slope(const std::vector<double>& x, const std::vector<double>& y) {
  double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  const double n = static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double a = std::log(x[i]), b = std::log(y[i]);
    sx += a, sy += b, sxx += a * a, sxy += a * b;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

template <class System>
class Adams : public testing::Test {};
using Systems = testing::Types<Oscillator, Pendulum, Support, Swing>;
TYPED_TEST_SUITE(Adams, Systems);

TYPED_TEST(Adams, IsOfFourthOrderWithFixedSteps) {
  constexpr std::size_t n = TypeParam::size;
  const TypeParam system;
  const Path<n> truth = reference(system);
  std::vector<double> step, error;
  for (int count : {200, 296, 440, 640, 944, 1360, 2000}) {
    const auto [path, result] = solve(system, fixed_step<n>(system.end / count));
    EXPECT_EQ(result.counts.accepted, count);
    EXPECT_EQ(result.counts.evaluations, 1 + 12 + 2 * (count - 3));
    EXPECT_EQ(result.counts.rejected, 0);
    step.push_back(system.end / count);
    error.push_back(distance(path, truth));
  }
  EXPECT_NEAR(slope(step, error), 4.0, 0.2);
}

/// At times that are not multiples of the step, states are as accurate as at its ends.
TYPED_TEST(Adams, IsOfFourthOrderBetweenItsSteps) {
  constexpr std::size_t n = TypeParam::size;
  const TypeParam system;
  const Path<n> truth = reference(system);
  for (int count : {103, 301, 1003}) {
    const double there = distance(solve(system, fixed_step<n>(system.end / (count - count % 8 + 8))).path, truth);
    EXPECT_LT(distance(solve(system, fixed_step<n>(system.end / count)).path, truth), 1.5 * there);
  }
}

TYPED_TEST(Adams, ErrorIsProportionalToTheTolerance) {
  constexpr std::size_t n = TypeParam::size;
  const TypeParam system;
  const Path<n> truth = reference(system);
  std::vector<double> allowed, error;
  for (double tol = 1e-4; tol > 0.5e-10; tol *= 0.1) {
    const auto [path, result] = solve(system, tolerance<n>(tol));
    allowed.push_back(tol);
    error.push_back(distance(path, truth));
    double largest = 0.0;
    for (const auto& y : path) largest = std::fmax(largest, distance(y, {}));
    const double thousandths = 1e-3 * static_cast<double>(result.counts.accepted);
    for (double estimated : result.error) EXPECT_LE(estimated, 1.5 * tol * (1.0 + largest) * (1.0 + thousandths));
    EXPECT_LT(error.back(), 5.0 * tol * (1.0 + largest));
  }
  EXPECT_NEAR(slope(allowed, error), 1.0, 0.15);
}

// The following tests have their own systems.

/// ζ = 5, ω = 200/s: the fast mode decays within a millisecond and then only limits the step.
TEST(Adams, AStiffDampedSpringDoesNotBlowUp) {
  for (double tol : {1e-3, 1e-6, 1e-9}) {
    double largest = 0.0;
    const auto result = integrate_adams<2>(
        [](double, const Unknowns<2>& y) {
          return Unknowns<2>{y[1], -4e4 * y[0] - 2e3 * y[1]};
        },
        {1.0, 0.0}, 0.0, 0.5, tolerance<2>(tol),
        [&](const DenseStep<2>& s) { largest = std::fmax(largest, std::fabs(s.last[0])); });
    ASSERT_TRUE(result) << result.error().message;
    const double root = std::sqrt(1e6 - 4e4), slow = -1e3 + root, fast = -1e3 - root;
    const double exact = (fast * std::exp(slow * 0.5) - slow * std::exp(fast * 0.5)) / (fast - slow);
    EXPECT_LE(largest, 1.0 + tol);
    EXPECT_NEAR(result->state[0], exact, 2.0 * tol);
    EXPECT_LT(result->counts.evaluations, 6000);
  }
}

RC_GTEST_PROP(AdamsModels, UnforcedSupportKeepsItsEnergy, ()) {
  auto in = [](double low, double high) { return low + (high - low) * *rc::gen::inRange(0, 1000001) * 1e-6; };
  Support s;
  s.strength = 0.0;
  s.start = {in(0.8, 1.0), in(-0.5, 0.5), in(-0.3, 0.3), in(-0.5, 0.5), in(-2.0, 2.0), in(-1.0, 1.0)};
  const double energy = s.energy(s.start), tol = std::pow(10.0, -in(5.0, 10.0));
  double worst = 0.0;
  const auto result = integrate_adams<6>(s, s.start, 0.0, 0.25, tolerance<6>(tol), [&](const DenseStep<6>& step) {
    worst = std::fmax(worst, std::fabs(s.energy(step.last) - energy));
  });
  RC_ASSERT(bool(result));
  RC_ASSERT(worst < 1000.0 * tol);  // J; the gradient of the energy reaches 1000 J a unit of the state
}

RC_GTEST_PROP(AdamsModels, UnforcedSwingKeepsItsEnergy, ()) {
  auto in = [](double low, double high) { return low + (high - low) * *rc::gen::inRange(0, 1000001) * 1e-6; };
  Swing s;
  s.strength = 0.0;
  s.start = {in(-1.0, 1.0), in(-1.5, 1.0), in(-4.0, 4.0), in(-6.0, 6.0)};
  const double energy = s.energy(s.start), tol = std::pow(10.0, -in(5.0, 10.0));
  double worst = 0.0;
  const auto result = integrate_adams<4>(s, s.start, 0.0, 2.0, tolerance<4>(tol), [&](const DenseStep<4>& step) {
    worst = std::fmax(worst, std::fabs(s.energy(step.last) - energy));
  });
  RC_ASSERT(bool(result));
  RC_ASSERT(worst < 100.0 * tol);
}

RC_GTEST_PROP(AdamsModels, AgreeWithDormandPrinceFromAnyState, ()) {
  auto in = [](double low, double high) { return low + (high - low) * *rc::gen::inRange(0, 1000001) * 1e-6; };
  Support s;
  s.start = {in(0.8, 1.0), in(-0.5, 0.5), in(-0.3, 0.3), in(-0.5, 0.5), in(-2.0, 2.0), in(-1.0, 1.0)};
  Swing w;
  w.start = {in(-1.0, 1.0), in(-1.5, 1.0), in(-4.0, 4.0), in(-6.0, 6.0)};
  RC_ASSERT(distance(solve(s, tolerance<6>(1e-8)).path, reference(s)) < 1e-7);
  RC_ASSERT(distance(solve(w, tolerance<4>(1e-8)).path, reference(w)) < 1e-6);
}

}  // namespace mobil::step::adams_test
