#pragma once
// Cholesky factor of a banded matrix in double precision, with tens of thousands of rows and a thousand entries off the
// diagonal. It works in blocks, so that nearly all of it is products of small dense matrices.

#include <cstddef>
#include <vector>

#include "engine/eigen.h"

namespace mobil::inline v0_3 {

/// A few columns over the rows of a problem; a row's numbers are adjacent.
using Columns = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Lower half of a symmetric matrix whose entries are within `reach` of the diagonal, and then its factor in place. No
/// sum depends on the machine.
class BandCholesky {
 public:
  static constexpr std::size_t block_width = 48, max_strip = 16;

  BandCholesky(std::size_t size, std::size_t reach);

  /// Returns the entry on or below the diagonal, within reach. Zero at first.
  double& at(std::size_t row, std::size_t column) { return entry_[column * stride_ + row]; }

  /// Factorises in place; returns false if the matrix is not positive definite.
  bool factorise();

  /// Replaces the columns by matrix⁻¹ · columns.
  void solve(Eigen::Ref<Columns> columns) const;

 private:
  // Entry (row, column) is at column · stride + row, so that blocks of the band are dense matrices. Numbers that a
  // strip of rows writes above the diagonal are behind all that those blocks read.
  std::size_t size_, reach_, stride_;
  std::vector<double> entry_;
};

}  // namespace mobil::inline v0_3
