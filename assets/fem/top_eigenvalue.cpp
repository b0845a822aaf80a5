#include "assets/fem/top_eigenvalue.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>

#include <mobil/engine/interrupt.h>
#include "assets/fem/stiffness_terms.h"
#include "engine/exact_math.h"

namespace mobil::inline v0_3 {
namespace {

using Numbers = std::vector<double>;

/// Takes eight interleaved sums, because one would wait for itself; in this order on any machine.
double dot(const double* a, const double* b, std::size_t count) {
  constexpr std::size_t sums = 8;
  double sum[sums] = {}, rest = 0;
  std::size_t i = 0;
  for (; i + sums <= count; i += sums)
    for (std::size_t s = 0; s < sums; ++s) sum[s] += a[i + s] * b[i + s];
  for (; i < count; ++i) rest += a[i] * b[i];
  return ((sum[0] + sum[4]) + (sum[2] + sum[6])) + ((sum[1] + sum[5]) + (sum[3] + sum[7])) + rest;
}

double dot(const Numbers& a, const Numbers& b) {
  return dot(a.data(), b.data(), a.size());
}

/// Lower Cholesky factor of a symmetric matrix of half-width `band`, row by row. The last `kept` rows remain, row i at
/// i mod kept with column c at c + band − i.
class WindowCholesky {
 public:
  WindowCholesky(std::size_t size, std::size_t band, std::size_t kept)
      : band_(std::min(band, size - 1)), kept_(std::max(kept, band_ + 1)), factor_(kept_ * (band_ + 1)) {}

  std::size_t band() const { return band_; }
  double* row(std::size_t i) { return &factor_[i % kept_ * (band_ + 1)]; }
  const double* row(std::size_t i) const { return &factor_[i % kept_ * (band_ + 1)]; }

  /// Turns row i of the matrix, already in row(i), into the factor's. Returns false if it is not positive definite.
  bool eliminate(std::size_t i) {
    double* mine = row(i);
    const std::size_t first = i > band_ ? i - band_ : 0;
    std::size_t begin = first;
    while (begin < i && mine[begin + band_ - i] == 0) ++begin;  // zeros so far stay zero
    for (std::size_t c = begin; c < i; ++c) {
      const double* other = row(c);
      const std::size_t from = std::max(begin, c > band_ ? c - band_ : 0);
      mine[c + band_ - i] =
          (mine[c + band_ - i] - dot(mine + (from + band_ - i), other + (from + band_ - c), c - from)) / other[band_];
    }
    const double rest = mine[band_] - dot(mine + (begin + band_ - i), mine + (begin + band_ - i), i - begin);
    if (!(rest > 0)) return false;
    mine[band_] = std::sqrt(rest);
    return true;
  }

 private:
  std::size_t band_, kept_;
  Numbers factor_;
};

/// Factorises M = L·Lᵀ of one component of displacement over all nodes; the identity on those that do not move.
WindowCholesky mass_factor(const StencilPencil& pencil, std::size_t component) {
  const Cells& cells = pencil.cells;
  const std::size_t nodes = node_count(cells);
  WindowCholesky factor(nodes, plane_nodes(cells) + cells[0] + 2, nodes);
  for_each_node(cells, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    const std::uint32_t n = node_index(cells, i, j, k);
    double* row = factor.row(n);
    if (pencil.moving[3 * n + component]) {
      for_each_neighbour(cells, i, j, k, [&](std::uint32_t m, std::size_t slot) {
        if (m <= n && pencil.moving[3 * m + component]) {
          row[m + factor.band() - n] = pencil.mass[n * stencil_size + slot];
        }
      });
    } else {
      row[factor.band()] = 1;
    }
    factor.eliminate(n);
  });
  return factor;
}

/// v ↦ L⁻¹·K·L⁻ᵀ·v, which has the pencil's spectrum.
class SymmetricOperator {
 public:
  SymmetricOperator(const StencilPencil& pencil, StencilMatrix& stiffness)
      : stiffness_(stiffness), work_(pencil.moving.size()) {
    stiffness_.fill(pencil.cells, [&](std::uint32_t n, std::uint32_t, std::size_t slot) {
      return pencil.stiffness[n * stencil_size + slot];
    });
    if (pencil.mass.empty()) return;
    for (const std::size_t component : {std::size_t{0}, std::size_t{2}})
      factor_.push_back(mass_factor(pencil, component));
  }

  void apply(const Numbers& x, Numbers& y) {
    if (factor_.empty()) {
      stiffness_.multiply(x, y);
      return;
    }
    work_ = x;
    for (std::size_t c = 0; c < 3; ++c) solve_transposed(factor_[c / 2], c, work_);
    stiffness_.multiply(work_, y);
    for (std::size_t c = 0; c < 3; ++c) solve(factor_[c / 2], c, y);
  }

 private:
  static void solve(const WindowCholesky& factor, std::size_t component, Numbers& x) {
    const std::size_t nodes = x.size() / 3, band = factor.band();
    for (std::size_t i = 0; i < nodes; ++i) {
      const double* row = factor.row(i);
      double sum = x[3 * i + component];
      for (std::size_t c = i > band ? i - band : 0; c < i; ++c) sum -= row[c + band - i] * x[3 * c + component];
      x[3 * i + component] = sum / row[band];
    }
  }

  static void solve_transposed(const WindowCholesky& factor, std::size_t component, Numbers& x) {
    const std::size_t nodes = x.size() / 3, band = factor.band();
    for (std::size_t i = nodes; i-- > 0;) {
      const double* row = factor.row(i);
      const double value = x[3 * i + component] /= row[band];
      for (std::size_t c = i > band ? i - band : 0; c < i; ++c) x[3 * c + component] -= row[c + band - i] * value;
    }
  }

  StencilMatrix& stiffness_;
  std::vector<WindowCholesky> factor_;  // of x and y, of z
  Numbers work_;
};

/// Returns the largest eigenvalue of a symmetric tridiagonal matrix by bisection on Sturm's count, to 1e-9 of itself.
double tridiagonal_top(const Numbers& diagonal, const Numbers& off) {
  double low = 0, high = 0;
  for (std::size_t i = 0; i < diagonal.size(); ++i) {
    low = std::max(low, diagonal[i]);
    high = std::max(high, diagonal[i] + (i > 0 ? off[i - 1] : 0) + (i + 1 < diagonal.size() ? off[i] : 0));
  }
  while (high - low > 1e-9 * high) {
    const double x = 0.5 * (low + high);
    double d = 1;
    bool above = false;  // true if an eigenvalue exceeds x
    for (std::size_t i = 0; i < diagonal.size() && !above; ++i) {
      d = x - diagonal[i] - (i > 0 ? off[i - 1] * off[i - 1] / d : 0.0);
      above = !(d > 0);
    }
    (above ? low : high) = x;
  }
  return low;
}

/// Returns the largest Ritz value, never above the largest eigenvalue. If `patient` is false, stops early once it has
/// hardly moved over sixteen steps.
double lanczos_top(SymmetricOperator& op, const Numbers& start, std::size_t longest, bool patient) {
  Numbers now = start, before(now.size()), next(now.size()), diagonal, off;
  double top = 0;
  longest = std::min(longest, now.size());
  for (std::size_t step = 1; step <= longest; ++step) {
    check_interrupt();
    op.apply(now, next);
    const double a = dot(now, next);
    diagonal.push_back(a);
    const double back = off.empty() ? 0 : off.back();
    for (std::size_t i = 0; i < now.size(); ++i) next[i] -= a * now[i] + back * before[i];
    const double b = std::sqrt(dot(next, next));
    const bool exhausted = b < 1e-12 * std::abs(a);
    if (step % 16 == 0 || step == longest || exhausted) {
      const double last = top;
      top = tridiagonal_top(diagonal, off);
      if (exhausted || (!patient && top - last < 1e-5 * top)) break;
    }
    off.push_back(b);
    before.swap(now);
    for (std::size_t i = 0; i < now.size(); ++i) now[i] = next[i] / b;
  }
  return top;
}

std::size_t pencil_band(const Cells& cells) {
  return 3 * (plane_nodes(cells) + cells[0] + 2) + 2;
}

/// True if σ·M − K has a Cholesky factor; then no eigenvalue reaches σ.
bool exceeds_spectrum(const StencilPencil& pencil, double sigma) {
  const Cells& cells = pencil.cells;
  WindowCholesky factor(pencil.moving.size(), pencil_band(cells), 0);
  bool positive = true;
  for_each_node(cells, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    check_interrupt();
    const std::uint32_t n = node_index(cells, i, j, k);
    for (std::size_t r = 0; r < 3 && positive; ++r) {
      const std::size_t at = 3 * n + r;
      double* row = factor.row(at);
      std::fill(row, row + factor.band() + 1, 0.0);
      if (!pencil.moving[at] || pencil.mass.empty()) row[factor.band()] = sigma;
      for_each_neighbour(cells, i, j, k, [&](std::uint32_t m, std::size_t slot) {
        const std::size_t pair = n * stencil_size + slot;
        for (std::size_t c = 0; c < 3; ++c) {
          if (3 * m + c > at) continue;
          double& entry = row[3 * m + c + factor.band() - at];
          entry -= pencil.stiffness[pair][3 * r + c];
          const bool both_move = pencil.moving[at] && pencil.moving[3 * m + c];
          if (r == c && both_move && !pencil.mass.empty()) entry += sigma * pencil.mass[pair];
        }
      });
      positive = factor.eliminate(at);
    }
  });
  return positive;
}

}  // namespace

std::vector<double> lanczos_start(const std::vector<bool>& moving) {
  std::mt19937 bits;  // NOLINT: always the same draw
  const auto uniform = [&] { return (static_cast<double>(bits()) + 0.5) / 4294967296.0; };
  Numbers v(moving.size());
  for (std::size_t i = 0; i < v.size(); ++i) {
    const double radius = std::sqrt(-2 * exact::log(uniform())), angle = 2 * std::numbers::pi * uniform();
    if (moving[i]) v[i] = radius * exact::cos(angle);
  }
  const double norm = std::sqrt(dot(v, v));
  for (double& x : v) x /= norm;
  return v;
}

double top_eigenvalue_bound(const StencilPencil& pencil, std::span<const double> start, StencilMatrix& work) {
  if (std::find(pencil.moving.begin(), pencil.moving.end(), true) == pencil.moving.end()) return 0;
  SymmetricOperator op(pencil, work);
  const auto size = static_cast<double>(pencil.moving.size());
  const auto band = static_cast<double>(pencil_band(pencil.cells));
  constexpr double rounding = 1 + 1e-9;
  if (size * band * band > 2e10) {
    constexpr double share = 0.02, risk = 1e-12;
    const double steps = 0.5 * (1 + exact::log(1.648 * std::sqrt(size) / risk) / std::sqrt(share));
    return lanczos_top(op, Numbers(start.begin(), start.end()), static_cast<std::size_t>(std::ceil(steps)), true) /
           (1 - share);
  }
  const double below = lanczos_top(op, Numbers(start.begin(), start.end()), 240, false);
  constexpr double first_margin = 2e-4, tight = 1e-3;
  double low = below, high = below * (1 + first_margin);
  for (double margin = first_margin; std::isfinite(high) && !exceeds_spectrum(pencil, high); margin *= 2) {
    low = high;
    high = below * (1 + 2 * margin);
  }
  if (!std::isfinite(high)) return std::numeric_limits<double>::infinity();
  while (low > below && high > low * (1 + tight)) {
    const double middle = 0.5 * (low + high);
    (exceeds_spectrum(pencil, middle) ? high : low) = middle;
  }
  return high * rounding;
}

}  // namespace mobil::inline v0_3
