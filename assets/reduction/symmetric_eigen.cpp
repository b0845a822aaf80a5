#include "assets/reduction/symmetric_eigen.h"

#include "engine/eigen.h"

namespace mobil::inline v0_3 {

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace mobil::inline v0_3
