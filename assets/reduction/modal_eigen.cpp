#include "assets/reduction/modal_eigen.h"

#include <algorithm>
#include <cmath>

namespace mobil::inline v0_3 {
namespace {

constexpr std::size_t most = max_modes;

/// Writes diagonal and off-diagonal of QᵀAQ, and Q to `q`. All sums run along rows, which compilers vectorise.
void make_tridiagonal(double (*__restrict a)[most], std::size_t n, double* diagonal, double* beside,
                      double (*__restrict q)[most]) {
  double scale[most];  // reflection k is 1 − scale·v·vᵀ, v in row k of `a` from k + 1 on
  for (std::size_t k = 0; k + 2 < n; ++k) {
    double* const v = a[k];
    double square = 0;
    for (std::size_t i = k + 2; i < n; ++i) square += v[i] * v[i];
    if (square == 0) {
      scale[k] = 0;
      beside[k] = v[k + 1];
      continue;
    }
    const double length = std::sqrt(square + v[k + 1] * v[k + 1]);
    beside[k] = v[k + 1] > 0 ? -length : length;
    v[k + 1] -= beside[k];
    const double factor = 2 / (square + v[k + 1] * v[k + 1]);
    scale[k] = factor;
    double p[most] = {};
    for (std::size_t j = k + 1; j < n; ++j) {
      const double* const row = a[j];
      for (std::size_t i = k + 1; i < n; ++i) p[i] += v[j] * row[i];
    }
    double along = 0;
    for (std::size_t i = k + 1; i < n; ++i) along += v[i] * p[i];
    const double half = 0.5 * factor * along;
    for (std::size_t i = k + 1; i < n; ++i) p[i] = factor * (p[i] - half * v[i]);
    for (std::size_t j = k + 1; j < n; ++j) {
      double* const row = a[j];
      for (std::size_t i = k + 1; i < n; ++i) row[i] -= v[j] * p[i] + p[j] * v[i];
    }
  }
  if (n >= 2) beside[n - 2] = a[n - 2][n - 1];
  for (std::size_t k = 0; k < n; ++k) {
    diagonal[k] = a[k][k];
    for (std::size_t i = 0; i < n; ++i) q[k][i] = i == k ? 1 : 0;
  }
  for (std::size_t k = n < 2 ? 0 : n - 2; k-- > 0;) {
    const double* const v = a[k];
    double w[most] = {};
    for (std::size_t j = k + 1; j < n; ++j) {
      for (std::size_t i = k + 1; i < n; ++i) w[i] += v[j] * q[j][i];
    }
    for (std::size_t j = k + 1; j < n; ++j) {
      const double factor = scale[k] * v[j];
      for (std::size_t i = k + 1; i < n; ++i) q[j][i] -= factor * w[i];
    }
  }
}

/// Rotates two rows.
void rotate(double* __restrict low, double* __restrict high, std::size_t n, double c, double s) {
  for (std::size_t i = 0; i < n; ++i) {
    const double a = low[i], b = high[i];
    high[i] = s * a + c * b;
    low[i] = c * a - s * b;
  }
}

/// Diagonalises, and rotates the rows of `rows` as well.
bool diagonalise(double* d, double* e, std::size_t n, double (*rows)[most]) {
  e[n - 1] = 0;
  for (std::size_t l = 0; l < n; ++l) {
    for (int sweep = 0;; ++sweep) {
      std::size_t m = l;
      // (NaN never ends it)
      while (m + 1 < n && !(std::abs(e[m]) <= 1e-16 * (std::abs(d[m]) + std::abs(d[m + 1])))) ++m;
      if (m == l) break;
      if (sweep == 50) return false;
      const double g0 = (d[l + 1] - d[l]) / (2 * e[l]);
      const double r0 = std::sqrt(g0 * g0 + 1);
      double g = d[m] - d[l] + e[l] / (g0 + (g0 >= 0 ? r0 : -r0));
      double s = 1, c = 1, p = 0;
      std::size_t i = m;
      bool split = false;
      while (i-- > l) {
        const double f = s * e[i], b = c * e[i];
        const double r = std::sqrt(f * f + g * g);
        e[i + 1] = r;
        if (r == 0) {
          d[i + 1] -= p;
          e[m] = 0;
          split = true;
          break;
        }
        const double over = 1 / r;
        s = f * over;
        c = g * over;
        g = d[i + 1] - p;
        const double t = (d[i] - g) * s + 2 * c * b;
        p = s * t;
        d[i + 1] = g + p;
        g = c * t - b;
        rotate(rows[i], rows[i + 1], n, c, s);
      }
      if (split) continue;
      d[l] -= p;
      e[l] = g;
      e[m] = 0;
    }
  }
  return true;
}

}  // namespace

bool solve_small(double (*matrix)[max_modes], std::size_t size, SmallEigen& result) {
  double beside[most] = {}, q[most][most];
  make_tridiagonal(matrix, size, result.value, beside, q);
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < size; ++j) result.vector[i][j] = q[j][i];
  }
  if (!diagonalise(result.value, beside, size, result.vector)) return false;
  for (std::size_t i = 0; i + 1 < size; ++i) {
    const auto least = static_cast<std::size_t>(std::min_element(result.value + i, result.value + size) - result.value);
    if (least == i) continue;
    std::swap(result.value[i], result.value[least]);
    std::swap_ranges(result.vector[i], result.vector[i] + size, result.vector[least]);
  }
  return true;
}

}  // namespace mobil::inline v0_3
