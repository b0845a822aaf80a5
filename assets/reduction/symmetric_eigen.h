#pragma once
// Eigenvalues and eigenvectors of a dense symmetric matrix of a few hundred rows: Eigen's solver, compiled once.

#include "engine/eigen.h"

namespace mobil::inline v0_3 {

struct SymmetricEigen {
  Eigen::VectorXd values;   // ascending
  Eigen::MatrixXd vectors;  // a column each, orthonormal
};

/// Reads only the lower half.
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& matrix);

}  // namespace mobil::inline v0_3
