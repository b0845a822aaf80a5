// The integrator of a step's equations against exact solutions, Boost.Odeint and the energy of the models.
#include "tests/gait/adams.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/engine/counting_heap.h"
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

/// Slope of the straight line through (log x, log y).
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

/// At times that are no multiples of the step, the states between the steps are as good as those at them.
TYPED_TEST(Adams, IsOfFourthOrderBetweenItsSteps) {
  constexpr std::size_t n = TypeParam::size;
  const TypeParam system;
  const Path<n> truth = reference(system);
  for (int count : {103, 301, 1003}) {
    const double there = distance(solve(system, fixed_step<n>(system.end / (count - count % 8 + 8))).path, truth);
    EXPECT_LT(distance(solve(system, fixed_step<n>(system.end / count)).path, truth), 1.5 * there);
  }
}

TYPED_TEST(Adams, ErrsInProportionToTheTolerance) {
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

TYPED_TEST(Adams, IsOfFifthOrderWhenItExtrapolates) {
  constexpr std::size_t n = TypeParam::size;
  const TypeParam system;
  const Path<n> truth = reference(system);
  std::vector<double> step, error;
  for (int count : {440, 544, 640, 800, 944}) {
    auto options = fixed_step<n>(system.end / count);
    options.extrapolate = true;
    step.push_back(system.end / count);
    error.push_back(distance(solve(system, options).path, truth));
  }
  EXPECT_NEAR(slope(step, error), 5.0, 0.3);
}

TYPED_TEST(Adams, ExtrapolatedErrsInProportionForFewerEvaluations) {
  constexpr std::size_t n = TypeParam::size;
  const TypeParam system;
  const Path<n> truth = reference(system);
  std::vector<double> allowed, error;
  for (double tol = 1e-5; tol > 0.5e-10; tol *= 0.1) {
    auto options = tolerance<n>(tol);
    const long plain = solve(system, options).result.counts.evaluations;
    options.extrapolate = true;
    const auto [path, result] = solve(system, options);
    EXPECT_LT(result.counts.evaluations, 0.8 * static_cast<double>(plain));
    allowed.push_back(tol);
    error.push_back(distance(path, truth));
    EXPECT_LT(error.back(), 5.0 * tol);
  }
  EXPECT_NEAR(slope(allowed, error), 1.0, 0.2);
}

TYPED_TEST(Adams, CountsItsEvaluationsAndSteps) {
  constexpr std::size_t n = TypeParam::size;
  const TypeParam system;
  long asked = 0, steps = 0;
  double time = 0.0, least = 1.0, greatest = 0.0;
  Unknowns<n> at = system.start;
  auto options = tolerance<n>(1e-7);
  options.greatest_step_s = 0.01;
  const auto result = integrate_adams<n>(
      [&](double t, const Unknowns<n>& y) {
        ++asked;
        return system(t, y);
      },
      system.start, 0.0, system.end, options,
      [&](const DenseStep<n>& step) {
        ++steps;
        EXPECT_EQ(step.begin_s, time);
        EXPECT_EQ(step.first, at);
        EXPECT_EQ(step.first_rate, system(step.begin_s, step.first));
        EXPECT_LT(distance(step.state(step.begin_s), step.first), 1e-14);
        EXPECT_LT(distance(step.state(step.end_s), step.last), 1e-14);
        time = step.end_s, at = step.last;
        least = std::fmin(least, step.end_s - step.begin_s);
        greatest = std::fmax(greatest, step.end_s - step.begin_s);
      });
  ASSERT_TRUE(result);
  EXPECT_EQ(time, system.end);
  EXPECT_EQ(at, result->state);
  EXPECT_EQ(result->counts.evaluations, asked);
  EXPECT_EQ(result->counts.accepted, steps);
  EXPECT_EQ(result->counts.least_step_s, least);
  EXPECT_EQ(result->counts.greatest_step_s, greatest);
  EXPECT_LE(greatest, 0.01 * (1.0 + 1e-12));
  EXPECT_GT(least, 0.0);
}

// What follows holds for systems of their own.

TEST(Adams, AStartIsJudgedByBothOfItsRules) {
  RungeKuttaStart<1> s{};
  EXPECT_EQ(start_error(s, 0.1)[0], 0.0);
  s.increment = {{{1.0}, {0.0}, {-1.0}}};  // three steps go nowhere, as the derivatives say, but two do not
  EXPECT_DOUBLE_EQ(start_error(s, 0.1)[0], 19.0 / 8.0);
  s.increment = {{{1.0}, {-1.0}, {1.0}}};
  EXPECT_DOUBLE_EQ(start_error(s, 0.1)[0], 19.0 / 27.0);
}

double pulse(double t) {
  return t < 0.3 || t > 0.7 ? 0.0 : 25.0;
}

/// y″ = −4y + pulse: exact by superposition of the responses to the two jumps.
double pulsed(double t) {
  auto response = [](double s) { return s > 0.0 ? 25.0 / 4.0 * (1.0 - std::cos(2.0 * s)) : 0.0; };
  return std::cos(2.0 * t) + response(t - 0.3) - response(t - 0.7);
}

TEST(AdamsBreaks, AreHitExactlyAndSeenFromTheirOwnSide) {
  const std::vector<double> breaks = {0.7, 0.3, 0.3, -1.0, 5.0, 0.0, 1.0};  // any order, doubles, outside
  for (double fixed : {0.0, 0.004}) {
    auto options = tolerance<2>(1e-9);
    options.fixed_step_s = fixed;
    options.breaks_s = breaks;
    std::vector<double> ends;
    const auto result = integrate_adams<2>(
        [&](double t, const Unknowns<2>& y) {
          EXPECT_NE(t, 0.3);
          EXPECT_NE(t, 0.7);
          return Unknowns<2>{y[1], -4.0 * y[0] + pulse(t)};
        },
        {1.0, 0.0}, 0.0, 1.0, options, [&](const DenseStep<2>& step) { ends.push_back(step.end_s); });
    ASSERT_TRUE(result) << result.error().message;
    for (double b : {0.3, 0.7, 1.0}) EXPECT_TRUE(std::ranges::find(ends, b) != ends.end()) << b;
    EXPECT_EQ(result->counts.starts, 3);
    EXPECT_NEAR(result->state[0], pulsed(1.0), fixed > 0.0 ? 1e-8 : 2e-9);
  }
}

TEST(AdamsBreaks, UnnamedJumpsCostStepsNotAccuracy) {
  auto f = [](double t, const Unknowns<2>& y) { return Unknowns<2>{y[1], -4.0 * y[0] + pulse(t)}; };
  const std::vector<double> breaks = {0.3, 0.7};
  for (double tol : {1e-5, 1e-7, 1e-9}) {
    const auto unnamed = integrate_adams<2>(f, {1.0, 0.0}, 0.0, 1.0, tolerance<2>(tol));
    ASSERT_TRUE(unnamed) << unnamed.error().message;
    EXPECT_NEAR(unnamed->state[0], pulsed(1.0), 10.0 * tol);
    auto options = tolerance<2>(tol);
    options.breaks_s = breaks;
    const auto named = integrate_adams<2>(f, {1.0, 0.0}, 0.0, 1.0, options);
    ASSERT_TRUE(named);
    EXPECT_LT(named->counts.evaluations, unnamed->counts.evaluations);
  }
}

/// ζ = 5, ω = 200/s: the fast mode dies within a millisecond and then only bounds the step.
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

TEST(AdamsFailures, NotFiniteDerivativeGivesAnError) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (double bad : {nan, inf, -inf}) {
    for (double since : {0.0, 1e-4, 0.4}) {
      for (double fixed : {0.0, 0.01}) {
        auto options = tolerance<2>(1e-6);
        options.fixed_step_s = fixed;
        double reached = 0.0;
        const auto result = integrate_adams<2>(
            [&](double t, const Unknowns<2>& y) {
              return Unknowns<2>{y[1], t >= since ? bad : -y[0]};
            },
            {1.0, 0.0}, 0.0, 1.0, options, [&](const DenseStep<2>& s) { reached = s.end_s; });
        ASSERT_FALSE(result);
        EXPECT_NE(result.error().message.find("not finite"), std::string::npos) << result.error().message;
        EXPECT_LE(reached, since);
      }
    }
  }
}

/// y′ = −√y / 2 leaves the reals where a trial step overshoots; shorter steps do not.
TEST(AdamsFailures, ATrialOutsideTheDomainOnlyShortensTheStep) {
  auto options = tolerance<1>(1e-6);
  options.first_step_s = 1.0;
  const auto result = integrate_adams<1>(
      [](double, const Unknowns<1>& y) { return Unknowns<1>{-0.5 * std::sqrt(y[0])}; }, {1.0}, 0.0, 3.9, options);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_NEAR(result->state[0], 0.025 * 0.025, 1e-5);
}

TEST(AdamsFailures, StepUnderflowGivesAnError) {
  // y = 1 / (1 − t) ends at t = 1.
  const auto pole = integrate_adams<1>([](double, const Unknowns<1>& y) { return Unknowns<1>{y[0] * y[0]}; }, {1.0},
                                       0.0, 2.0, tolerance<1>(1e-6));
  ASSERT_FALSE(pole);
  auto options = tolerance<2>(1e-9);
  options.least_step_s = 0.05;
  const auto coarse = integrate_adams<2>(Pendulum{}, {2.0, 0.0}, 0.0, 2.0, options);
  ASSERT_FALSE(coarse);
  EXPECT_NE(coarse.error().message.find("step"), std::string::npos);
}

TEST(AdamsFailures, EvaluationsAreLimited) {
  auto options = tolerance<2>(1e-9);
  options.most_evaluations = 200;
  long asked = 0;
  auto f = [&](double t, const Unknowns<2>& y) {
    ++asked;
    return Pendulum{}(t, y);
  };
  EXPECT_FALSE(integrate_adams<2>(f, {2.0, 0.0}, 0.0, 10.0, options));
  EXPECT_LE(asked, 215);
  options.fixed_step_s = 1e-12;
  EXPECT_FALSE(integrate_adams<2>(f, {2.0, 0.0}, 0.0, 10.0, options));
}

TEST(AdamsFailures, BadRequestsGiveAnError) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const Pendulum p;
  EXPECT_FALSE(integrate_adams<2>(p, {0.0, 0.0}, 1.0, 0.0));
  EXPECT_FALSE(integrate_adams<2>(p, {0.0, 0.0}, nan, 0.0));
  EXPECT_FALSE(integrate_adams<2>(p, {0.0, 0.0}, 0.0, std::numeric_limits<double>::infinity()));
  EXPECT_FALSE(integrate_adams<2>(p, {nan, 0.0}, 0.0, 1.0));
  for (auto spoil :
       {+[](AdamsOptions<2>& o) { o.absolute[1] = 0.0; }, +[](AdamsOptions<2>& o) { o.relative[0] = -1.0; },
        +[](AdamsOptions<2>& o) { o.absolute[0] = nan; }, +[](AdamsOptions<2>& o) { o.fixed_step_s = -1.0; },
        +[](AdamsOptions<2>& o) { o.greatest_step_s = 0.0; }, +[](AdamsOptions<2>& o) { o.first_step_s = nan; },
        +[](AdamsOptions<2>& o) { o.least_step_s = 1.0, o.greatest_step_s = 0.1; }}) {
    AdamsOptions<2> options;
    spoil(options);
    EXPECT_FALSE(integrate_adams<2>(p, {0.0, 0.0}, 0.0, 1.0, options));
  }
  const auto nothing = integrate_adams<2>(p, {0.3, 0.1}, 1.0, 1.0);
  ASSERT_TRUE(nothing);
  EXPECT_EQ(nothing->state, (Unknowns<2>{0.3, 0.1}));
  EXPECT_EQ(nothing->counts.evaluations, 0);
}

TEST(Adams, AnUncontrolledComponentDoesNotBoundTheStep) {
  auto f = [](double t, const Unknowns<3>& y) { return Unknowns<3>{y[1], -y[0], std::sin(300.0 * t)}; };
  auto options = tolerance<3>(1e-8);
  const auto all = integrate_adams<3>(f, {1.0, 0.0, 0.0}, 0.0, 1.0, options);
  options.absolute[2] = std::numeric_limits<double>::infinity();
  const auto two = integrate_adams<3>(f, {1.0, 0.0, 0.0}, 0.0, 1.0, options);
  ASSERT_TRUE(all && two);
  EXPECT_LT(5 * two->counts.evaluations, all->counts.evaluations);
  EXPECT_NEAR(two->state[0], std::cos(1.0), 1e-7);
}

TEST(Adams, NeedsNoHeap) {
  const Support s;
  const std::size_t before = heap_requests;
  const auto result = integrate_adams<6>(s, s.start, 0.0, s.end, tolerance<6>(1e-8));
  EXPECT_EQ(heap_requests, before);
  EXPECT_TRUE(result);
}

/// Sums and products only, so every compiler, width and processor must give these very bits.
TEST(Adams, BitsAreTheSameEverywhere) {
  const std::vector<double> breaks = {0.7};
  auto options = tolerance<2>(1e-7);
  options.breaks_s = breaks;
  const auto duffing = integrate_adams<2>(
      [](double t, const Unknowns<2>& y) {
        return Unknowns<2>{y[1], y[0] - y[0] * y[0] * y[0] - 0.2 * y[1] + (t < 0.7 ? 0.5 : -0.5)};
      },
      {1.0, 0.0}, 0.0, 5.0, options);
  ASSERT_TRUE(duffing);
  EXPECT_EQ(duffing->state, (Unknowns<2>{-0x1.94ee69a069745p+0, -0x1.ba6d88c7e4ae4p-1}));
  EXPECT_EQ(duffing->counts.evaluations, 717);
}

}  // namespace mobil::step::adams_test
