#include "assets/reduction/reduced_cholesky.h"

#include <algorithm>
#include <cmath>

namespace mobil {
namespace {

using Eigen::Index;

/// Lower factor of a small dense matrix in its lower half.
template <class Matrix>
bool factorise_dense(Matrix& a) {
  for (Index c = 0; c < a.cols(); ++c) {
    if (!(a(c, c) > 0)) return false;
    a(c, c) = std::sqrt(a(c, c));
    const Index below = a.rows() - c - 1;
    a.col(c).tail(below) /= a(c, c);
    for (Index other = c + 1; other < a.cols(); ++other) {
      a.col(other).tail(a.rows() - other) -= a(other, c) * a.col(c).tail(a.rows() - other);
    }
  }
  return true;
}

}  // namespace

BandCholesky::BandCholesky(std::size_t size, std::size_t reach)
    : size_(static_cast<Index>(size)),
      reach_(std::min(static_cast<Index>(reach), static_cast<Index>(size) - 1)),
      stride_(static_cast<std::size_t>(reach_ + block_width)),
      entry_((size + 1) * (stride_ + 1)) {}

bool BandCholesky::factorise() {
  const Eigen::OuterStride<> stride(static_cast<Index>(stride_));
  for (Index c = 0; c < size_; c += block_width) {
    const Index width = std::min(block_width, size_ - c), below = std::min(reach_, size_ - c - width);
    Block own(&at(static_cast<std::size_t>(c), static_cast<std::size_t>(c)), width, width, stride);
    if (!factorise_dense(own)) return false;
    if (below == 0) continue;
    const auto next = static_cast<std::size_t>(c + width);
    Block under(&at(next, static_cast<std::size_t>(c)), below, width, stride);
    own.transpose().triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(under);
    Block rest(&at(next, next), below, below, stride);
    rest.selfadjointView<Eigen::Lower>().rankUpdate(under, -1.0);
  }
  return true;
}

template <class Matrix>
void BandCholesky::solve_all(Matrix& columns) const {
  const Eigen::OuterStride<> stride(static_cast<Index>(stride_));
  const auto block = [&](Index row, Index column, Index rows, Index width) {
    return ConstBlock(entry_.data() + static_cast<std::size_t>(column) * stride_ + row, rows, width, stride);
  };
  for (Index c = 0; c < size_; c += block_width) {
    const Index width = std::min(block_width, size_ - c), below = std::min(reach_, size_ - c - width);
    auto own = columns.middleRows(c, width);
    block(c, c, width, width).template triangularView<Eigen::Lower>().solveInPlace(own);
    columns.middleRows(c + width, below).noalias() -= block(c + width, c, below, width) * own;
  }
  const Index last = (size_ - 1) / block_width * block_width;
  for (Index c = last; c >= 0; c -= block_width) {
    const Index width = std::min(block_width, size_ - c), below = std::min(reach_, size_ - c - width);
    auto own = columns.middleRows(c, width);
    // in pieces, or how a long sum is cut would be up to the machine's caches
    for (Index r = 0; r < below; r += block_width) {
      const Index rows = std::min(block_width, below - r);
      own.noalias() -= block(c + width + r, c, rows, width).transpose() * columns.middleRows(c + width + r, rows);
    }
    block(c, c, width, width).transpose().template triangularView<Eigen::Upper>().solveInPlace(own);
  }
}

void BandCholesky::solve(Eigen::Ref<Columns> columns) const {
  if (columns.cols() == 0) return;
  if (columns.cols() != 1) return solve_all(columns);
  // one alone is some times faster as a vector
  Eigen::VectorXd one = columns.col(0);
  solve_all(one);
  columns.col(0) = one;
}

}  // namespace mobil
