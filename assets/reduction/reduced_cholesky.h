#pragma once
// Cholesky factor of a banded matrix in double precision, of tens of thousands of rows with a thousand beside the
// diagonal: in blocks, so that nearly all of it is products of small dense matrices.

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace mobil {

/// A few columns over the rows of a problem, a row's numbers side by side.
using Columns = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Lower half of a symmetric matrix whose entries lie within `reach` of the diagonal, and then its factor in its place.
/// No sum depends on the machine: products are cut to block_width terms.
class BandCholesky {
 public:
  BandCholesky(std::size_t size, std::size_t reach);

  /// Entry on or below the diagonal, within reach. Zero at first.
  double& at(std::size_t row, std::size_t column) { return entry_[column * stride_ + row]; }

  /// In place; false where the matrix is not positive definite.
  bool factorise();

  /// matrix⁻¹ · columns, in place.
  void solve(Eigen::Ref<Columns> columns) const;

 private:
  static constexpr Eigen::Index block_width = 48;
  template <class Matrix>
  void solve_all(Matrix& columns) const;
  using Block = Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
  using ConstBlock = Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

  // Entry (row, column) stands at column · stride + row, so that blocks of the band are dense matrices.
  Eigen::Index size_, reach_;
  std::size_t stride_;
  std::vector<double> entry_;
};

}  // namespace mobil
