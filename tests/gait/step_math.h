#pragma once
// Double-precision functions for set-up whose bits are independent of the C library and the instruction set. They use
// only additions, multiplications, divisions and square roots.

#include <cmath>

namespace mobil::step {

inline constexpr double pi = 3.14159265358979323846;
inline constexpr double gravity = 9.81;

struct SinCos {
  double sine, cosine;
};

/// Returns sine and cosine for |x| < 1000 rad, error below 1e-13: reduction to ±π/4, Taylor series.
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

}  // namespace mobil::step
