#pragma once
// Cholesky factor of a banded matrix in double precision, of tens of thousands of rows with a thousand beside the
// diagonal: in blocks, so that nearly all of it is products of small dense matrices.

#include <cstddef>
#include <vector>

#include "engine/eigen.h"

namespace mobil::inline v0_3 {

/// A few columns over the rows of a problem, a row's numbers side by side.
using Columns = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Lower half of a symmetric matrix whose entries lie within `reach` of the diagonal, and then its factor in its place.
/// No sum depends on the machine.
class BandCholesky {
 public:
  static constexpr std::size_t block_width = 48, max_strip = 16;

  BandCholesky(std::size_t size, std::size_t reach);

  /// Entry on or below the diagonal, within reach. Zero at first.
  double& at(std::size_t row, std::size_t column) { return entry_[column * stride_ + row]; }

  /// In place; false where the matrix is not positive definite.
  bool factorise();

  /// matrix⁻¹ · columns, in place.
  void solve(Eigen::Ref<Columns> columns) const;

 private:
  // Entry (row, column) stands at column · stride + row, so that blocks of the band are dense matrices. What a strip of
  // rows writes above the diagonal lies behind all that those blocks read.
  std::size_t size_, reach_, stride_;
  std::vector<double> entry_;
};

}  // namespace mobil::inline v0_3
