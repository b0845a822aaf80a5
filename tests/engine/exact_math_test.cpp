// Elementary functions return the double nearest to a result of thirty-three digits.

#include "engine/exact_math.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

// gcc's libquadmath. Other compilers do not find its header.
using Long = __float128;
extern "C" {
Long expq(Long);
Long expm1q(Long);
Long logq(Long);
Long cbrtq(Long);
Long sinq(Long);
Long cosq(Long);
Long asinq(Long);
Long acosq(Long);
Long atan2q(Long, Long);
Long powq(Long, Long);
}

namespace mobil {
namespace {

/// Compares random numbers of a range, half of them uniform in the logarithm of their size.
template <class Ours, class Theirs>
void expect_nearest(double low, double high, Ours ours, Theirs theirs) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> even(low, high), part(-40, 0);
  for (int i = 0; i < 1500; ++i) {
    double x = even(random);
    if (i % 2 == 0) x *= std::exp2(part(random));
    if (x < low || x > high) continue;
    const double expected = static_cast<double>(theirs(Long(x)));
    ASSERT_EQ(ours(x), expected) << std::hexfloat << x;
  }
}

TEST(ExactMath, ReturnsTheNearestDouble) {
  expect_nearest(
      -700, 700, [](double x) { return exact::exp(x); }, expq);
  expect_nearest(
      -30, 30, [](double x) { return exact::expm1(x); }, expm1q);
  expect_nearest(
      1e-9, 1e9, [](double x) { return exact::log(x); }, logq);
  expect_nearest(
      0.9, 1.1, [](double x) { return exact::log(x); }, logq);
  expect_nearest(
      1e-9, 1e9, [](double x) { return exact::cbrt(x); }, cbrtq);
  expect_nearest(
      -100, 100, [](double x) { return exact::sin(x); }, sinq);
  expect_nearest(
      -1e5, 1e5, [](double x) { return exact::cos(x); }, cosq);
  expect_nearest(
      -1, 1, [](double x) { return exact::asin(x); }, asinq);
  expect_nearest(
      -1, 1, [](double x) { return exact::acos(x); }, acosq);
  for (const double other : {-3.0, -1e-3, 0.7, 1e6}) {
    expect_nearest(
        -10, 10, [&](double x) { return exact::atan2(x, other); }, [&](Long x) { return atan2q(x, other); });
  }
  for (const double power : {-2.5, 1.0 / 3, 0.1, 7.0}) {
    expect_nearest(
        1e-3, 1e3, [&](double x) { return exact::pow(x, power); }, [&](Long x) { return powq(x, power); });
  }
}

TEST(ExactMath, SpecialValuesMatchTheStandardLibrary) {
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(exact::exp(-inf), 0);
  EXPECT_EQ(exact::exp(inf), inf);
  EXPECT_EQ(exact::exp(0.0), 1);
  EXPECT_EQ(exact::expm1(0.0), 0);
  EXPECT_EQ(exact::log(0.0), -inf);
  EXPECT_EQ(exact::log(inf), inf);
  EXPECT_EQ(exact::log(1.0), 0);
  EXPECT_TRUE(std::isnan(exact::log(-1.0)));
  EXPECT_TRUE(std::isnan(exact::sin(inf)));
  EXPECT_TRUE(std::isnan(exact::exp(std::nan(""))));
  EXPECT_TRUE(std::isnan(exact::acos(1.5)));
  EXPECT_EQ(exact::acos(1.0), 0);
  EXPECT_EQ(exact::acos(-1.0), std::acos(-1.0));
  EXPECT_EQ(exact::asin(-1.0), std::asin(-1.0));
  EXPECT_EQ(exact::atan2(0.0, -2.0), std::atan2(0.0, -2.0));
  EXPECT_EQ(exact::sin(0.0), 0);
  EXPECT_EQ(exact::cos(0.0), 1);
}

}  // namespace
}  // namespace mobil
