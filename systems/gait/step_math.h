#pragma once
// Double-precision functions for set-up whose bits do not depend on the C library or the instruction set: only
// additions, multiplications, divisions and square roots.

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace mobil::step {

inline constexpr double pi = 3.14159265358979323846;
inline constexpr double degree = pi / 180.0;
inline constexpr double gravity = 9.81;

struct SinCos {
  double sine, cosine;
};

/// |x| < 1000 rad, error below 1e-13: reduction to ±π/4, Taylor series.
inline SinCos sin_cos(double x) {
  const double quadrant = std::floor(x * (2.0 / pi) + 0.5);
  const double r = (x - quadrant * 1.5707963267948966) - quadrant * 6.123233995736766e-17;
  const double r2 = r * r;
  const double s =
      r * (1.0 + r2 * (-1.0 / 6 +
                       r2 * (1.0 / 120 +
                             r2 * (-1.0 / 5040 + r2 * (1.0 / 362880 + r2 * (-1.0 / 39916800 +
                                                                            r2 * (1.0 / 6227020800.0 +
                                                                                  r2 * (-1.0 / 1307674368000.0))))))));
  const double c =
      1.0 +
      r2 * (-1.0 / 2 +
            r2 * (1.0 / 24 +
                  r2 * (-1.0 / 720 +
                        r2 * (1.0 / 40320 +
                              r2 * (-1.0 / 3628800 + r2 * (1.0 / 479001600 + r2 * (-1.0 / 87178291200.0 +
                                                                                   r2 * (1.0 / 20922789888000.0))))))));
  switch (static_cast<int>(quadrant - 4.0 * std::floor(quadrant * 0.25))) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

/// Angle of (x, y) in (−π, π], error below 1e-13: two halvings of the angle, then the series.
inline double arc_tangent(double y, double x) {
  const double ax = std::fabs(x), ay = std::fabs(y);
  if (ax + ay == 0.0) return 0.0;
  double t = ax > ay ? ay / ax : ax / ay;
  t = t / (1.0 + std::sqrt(1.0 + t * t));
  t = t / (1.0 + std::sqrt(1.0 + t * t));
  const double t2 = t * t;
  const double sum =
      1.0 + t2 * (-1.0 / 3 +
                  t2 * (1.0 / 5 +
                        t2 * (-1.0 / 7 +
                              t2 * (1.0 / 9 +
                                    t2 * (-1.0 / 11 +
                                          t2 * (1.0 / 13 + t2 * (-1.0 / 15 + t2 * (1.0 / 17 + t2 * (-1.0 / 19)))))))));
  double angle = 4.0 * t * sum;
  if (ay > ax) angle = pi / 2 - angle;
  if (x < 0.0) angle = pi - angle;
  return y < 0.0 ? -angle : angle;
}

inline double arc_cosine(double c) {
  return arc_tangent(std::sqrt(std::fmax(1.0 - c * c, 0.0)), c);
}

/// 0 below a, 1 above b, with continuous slope between.
inline double smooth_step(double t, double a, double b) {
  const double u = std::fmin(std::fmax((t - a) / (b - a), 0.0), 1.0);
  return u * u * (3.0 - 2.0 * u);
}

/// Solves A x = b by elimination with pivoting; false where A is singular to working precision.
template <std::size_t N>
bool solve(std::array<std::array<double, N>, N> a, std::array<double, N> b, std::array<double, N>& x) {
  for (std::size_t k = 0; k < N; ++k) {
    std::size_t p = k;
    for (std::size_t i = k + 1; i < N; ++i)
      if (std::fabs(a[i][k]) > std::fabs(a[p][k])) p = i;
    if (!(std::fabs(a[p][k]) > 1e-14)) return false;
    std::swap(a[p], a[k]);
    std::swap(b[p], b[k]);
    for (std::size_t i = k + 1; i < N; ++i) {
      const double f = a[i][k] / a[k][k];
      for (std::size_t j = k; j < N; ++j) a[i][j] -= f * a[k][j];
      b[i] -= f * b[k];
    }
  }
  for (std::size_t k = N; k-- > 0;) {
    double sum = b[k];
    for (std::size_t j = k + 1; j < N; ++j) sum -= a[k][j] * x[j];
    x[k] = sum / a[k][k];
  }
  return true;
}

/// Newton's method with a difference quotient for the Jacobian and halving of steps that do not improve. `residual`
/// takes N unknowns and gives N residuals, both scaled to order one. True when the largest residual fell below
/// `tolerance`; `x` then holds the solution.
template <std::size_t N, class Residual>
bool shoot(Residual residual, std::array<double, N>& x, double tolerance, int most_iterations = 40) {
  auto size = [](const std::array<double, N>& r) {
    double worst = 0.0;
    for (double v : r) worst = v == v ? std::fmax(worst, std::fabs(v)) : 1e300;
    return worst;
  };
  std::array<double, N> r = residual(x);
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const double now = size(r);
    if (now < tolerance) return true;
    if (!(now < 1e6)) return false;
    std::array<std::array<double, N>, N> jacobian;
    for (std::size_t j = 0; j < N; ++j) {
      std::array<double, N> moved = x;
      const double h = 1e-6;
      moved[j] += h;
      const std::array<double, N> there = residual(moved);
      for (std::size_t i = 0; i < N; ++i) jacobian[i][j] = (there[i] - r[i]) / h;
    }
    std::array<double, N> step{};
    if (!solve(jacobian, r, step)) return false;
    double scale = 1.0;
    bool better = false;
    for (int halving = 0; halving < 12 && !better; ++halving, scale *= 0.5) {
      std::array<double, N> trial = x;
      for (std::size_t j = 0; j < N; ++j) trial[j] -= scale * step[j];
      const std::array<double, N> there = residual(trial);
      if (size(there) < now) {
        x = trial;
        r = there;
        better = true;
      }
    }
    if (!better) return false;
  }
  return size(r) < tolerance;
}

}  // namespace mobil::step
