#include "assets/reduction/modal_cholesky.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include <algorithm>
#include <cmath>

#include <mobil/engine/interrupt.h>
#include "assets/reduction/double_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace {

// Every entry is one sum in the order of its terms, whatever the width of the vectors.

/// Updates so many vectors of rows from `row` on, and so many columns from `column` on, of rest −= under·underᵀ.
template <std::size_t modes, std::size_t columns>
HWY_INLINE void update_tile(const double* under, std::size_t terms, double* rest, std::size_t stride, std::size_t row,
                            std::size_t column) {
  V sum[columns][modes];
  for (std::size_t c = 0; c < columns; ++c)
    for (std::size_t v = 0; v < modes; ++v) sum[c][v] = load_any(rest + (column + c) * stride + row + v * width);
  for (std::size_t k = 0; k < terms; ++k, under += stride) {
    V left[modes];
    for (std::size_t v = 0; v < modes; ++v) left[v] = load_any(under + row + v * width);
    for (std::size_t c = 0; c < columns; ++c) {
      const V right = all(under[column + c]);
      for (std::size_t v = 0; v < modes; ++v) sum[c][v] = sub(sum[c][v], mul(left[v], right));
    }
  }
  for (std::size_t c = 0; c < columns; ++c)
    for (std::size_t v = 0; v < modes; ++v) store_any(sum[c][v], rest + (column + c) * stride + row + v * width);
}

/// Updates entries on and below the diagonal. A tile can write above it, where nothing is stored.
void update(const double* under, std::size_t rows, std::size_t terms, double* rest, std::size_t stride) {
  constexpr std::size_t modes = 2, strip = modes * width, together = 4;
  static_assert(strip <= BandCholesky::max_strip);
  std::size_t row = 0;
  for (; row + strip <= rows; row += strip) {
    std::size_t column = 0;
    for (; column + together <= row + strip; column += together)
      update_tile<modes, together>(under, terms, rest, stride, row, column);
    for (; column < row + strip; ++column) update_tile<modes, 1>(under, terms, rest, stride, row, column);
  }
  for (; row < rows; ++row) {
    for (std::size_t column = 0; column <= row; ++column) {
      double sum = rest[column * stride + row];
      for (std::size_t k = 0; k < terms; ++k) sum -= under[k * stride + row] * under[k * stride + column];
      rest[column * stride + row] = sum;
    }
  }
}

/// Computes so many vectors of rows of under·own⁻ᵀ, from `row` on.
template <std::size_t modes>
HWY_INLINE void divide_strip(const double* own, std::size_t terms, double* under, std::size_t stride, std::size_t row) {
  for (std::size_t c = 0; c < terms; ++c) {
    V sum[modes];
    for (std::size_t v = 0; v < modes; ++v) sum[v] = load_any(under + c * stride + row + v * width);
    for (std::size_t k = 0; k < c; ++k) {
      const V right = all(own[k * stride + c]);
      for (std::size_t v = 0; v < modes; ++v)
        sum[v] = sub(sum[v], mul(load_any(under + k * stride + row + v * width), right));
    }
    const V by = all(own[c * stride + c]);
    for (std::size_t v = 0; v < modes; ++v) store_any(dn::Div(sum[v], by), under + c * stride + row + v * width);
  }
}

void divide(const double* own, std::size_t rows, std::size_t terms, double* under, std::size_t stride) {
  constexpr std::size_t modes = 6;
  std::size_t row = 0;
  for (; row + modes * width <= rows; row += modes * width) divide_strip<modes>(own, terms, under, stride, row);
  for (; row + width <= rows; row += width) divide_strip<1>(own, terms, under, stride, row);
  for (; row < rows; ++row) {
    for (std::size_t c = 0; c < terms; ++c) {
      double sum = under[c * stride + row];
      for (std::size_t k = 0; k < c; ++k) sum -= under[k * stride + row] * own[k * stride + c];
      under[c * stride + row] = sum / own[c * stride + c];
    }
  }
}

/// Writes the lower factor of a small dense matrix to its lower half.
bool factorise_dense(double* own, std::size_t size, std::size_t stride) {
  for (std::size_t c = 0; c < size; ++c) {
    double* const column = own + c * stride;
    if (!(column[c] > 0)) return false;
    column[c] = std::sqrt(column[c]);
    for (std::size_t r = c + 1; r < size; ++r) column[r] /= column[c];
    for (std::size_t other = c + 1; other < size; ++other) {
      double* const to = own + other * stride;
      const double by = column[other];
      for (std::size_t r = other; r < size; ++r) to[r] -= by * column[r];
    }
  }
  return true;
}

bool factorise_all(double* entry, std::size_t size, std::size_t reach, std::size_t stride) {
  constexpr std::size_t block = BandCholesky::block_width;
  for (std::size_t c = 0; c < size; c += block) {
    check_interrupt();
    const std::size_t terms = std::min(block, size - c), next = c + terms, below = std::min(reach, size - next);
    double *const own = entry + c * stride + c, *const under = entry + c * stride + next;
    if (!factorise_dense(own, terms, stride)) return false;
    divide(own, below, terms, under, stride);
    update(under, below, terms, entry + next * stride + next, stride);
  }
  return true;
}

/// x −= columns·by for so many adjacent columns, one term after the other.
template <std::size_t columns>
HWY_INLINE void subtract(const double* first, std::size_t stride, const double* by, std::size_t rows, double* x) {
  V factor[columns];
  for (std::size_t c = 0; c < columns; ++c) factor[c] = all(by[c]);
  std::size_t i = 0;
  for (; i + width <= rows; i += width) {
    V sum = load_any(x + i);
    for (std::size_t c = 0; c < columns; ++c) sum = sub(sum, mul(load_any(first + c * stride + i), factor[c]));
    store_any(sum, x + i);
  }
  for (; i < rows; ++i)
    for (std::size_t c = 0; c < columns; ++c) x[i] -= first[c * stride + i] * by[c];
}

/// Writes each column's inner product with x: eight interleaved sums, then the remainder.
template <std::size_t columns>
HWY_INLINE void inner_of(const double* first, std::size_t stride, const double* x, std::size_t rows, double* inner) {
  constexpr std::size_t sums = 8, modes = sums / width;
  V sum[columns][modes];
  for (auto& of_column : sum)
    for (V& one : of_column) one = all(0);
  std::size_t i = 0;
  for (; i + sums <= rows; i += sums)
    for (std::size_t v = 0; v < modes; ++v) {
      const V right = load_any(x + i + v * width);
      for (std::size_t c = 0; c < columns; ++c)
        sum[c][v] = add(sum[c][v], mul(load_any(first + c * stride + i + v * width), right));
    }
  for (std::size_t c = 0; c < columns; ++c) {
    double part[sums], rest = 0;
    for (std::size_t v = 0; v < modes; ++v) store_any(sum[c][v], part + v * width);
    for (std::size_t apart = sums / 2; apart > 0; apart /= 2)
      for (std::size_t s = 0; s < apart; ++s) part[s] += part[s + apart];
    for (std::size_t j = i; j < rows; ++j) rest += first[c * stride + j] * x[j];
    inner[c] = part[0] + rest;
  }
}

/// Solves the columns from `c` on together; entries beyond a column's reach are zero.
template <std::size_t columns>
HWY_INLINE void solve_down(const double* entry, std::size_t stride, std::size_t reach, std::size_t size, std::size_t c,
                           double* x) {
  const auto at = [&](std::size_t row, std::size_t column) { return entry[column * stride + row]; };
  for (std::size_t k = c; k < c + columns; ++k) {
    for (std::size_t j = c; j < k; ++j) x[k] -= at(k, j) * x[j];
    x[k] /= at(k, k);
  }
  const std::size_t next = c + columns;
  subtract<columns>(entry + c * stride + next, stride, x + c, std::min(reach, size - next), x + next);
}
template <std::size_t columns>
HWY_INLINE void solve_up(const double* entry, std::size_t stride, std::size_t reach, std::size_t size, std::size_t c,
                         double* x) {
  const auto at = [&](std::size_t row, std::size_t column) { return entry[column * stride + row]; };
  const std::size_t next = c + columns;
  double inner[columns];
  inner_of<columns>(entry + c * stride + next, stride, x + next, std::min(reach, size - next), inner);
  for (std::size_t k = next; k-- > c;) {
    x[k] -= inner[k - c];
    for (std::size_t j = k + 1; j < next; ++j) x[k] -= at(j, k) * x[j];
    x[k] /= at(k, k);
  }
}

void solve_one(const double* entry, std::size_t size, std::size_t reach, std::size_t stride, double* x) {
  constexpr std::size_t together = 4;
  const std::size_t fours = size / together * together;
  for (std::size_t c = 0; c < fours; c += together) solve_down<together>(entry, stride, reach, size, c, x);
  for (std::size_t c = fours; c < size; ++c) solve_down<1>(entry, stride, reach, size, c, x);
  for (std::size_t c = size; c > fours; --c) solve_up<1>(entry, stride, reach, size, c - 1, x);
  for (std::size_t c = fours; c > 0; c -= together) solve_up<together>(entry, stride, reach, size, c - together, x);
}

}  // namespace
}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {
namespace {
HWY_EXPORT(factorise_all);
HWY_EXPORT(solve_one);
}  // namespace

BandCholesky::BandCholesky(std::size_t size, std::size_t reach)
    : size_(size),
      reach_(std::min(reach, size - 1)),
      stride_(reach_ + block_width + max_strip),
      entry_((size + 1) * (stride_ + 1)) {}

bool BandCholesky::factorise() {
  return HWY_DYNAMIC_DISPATCH(factorise_all)(entry_.data(), size_, reach_, stride_);
}

void BandCholesky::solve(Eigen::Ref<Columns> columns) const {
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {
    check_interrupt();
    Eigen::VectorXd one = columns.col(c);
    HWY_DYNAMIC_DISPATCH(solve_one)(entry_.data(), size_, reach_, stride_, one.data());
    columns.col(c) = one;
  }
}

}  // namespace mobil::inline v0_3
#endif
