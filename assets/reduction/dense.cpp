#include "assets/reduction/dense.h"

#include <mobil/engine/interrupt.h>

namespace mobil::inline v0_3 {

using Eigen::MatrixXd;

MatrixXd transposed(const MatrixXd& m) {
  return m.transpose();
}
MatrixXd product(const MatrixXd& a, const MatrixXd& b) {
  return a * b;
}
Eigen::VectorXd product(const MatrixXd& a, const Eigen::VectorXd& v) {
  return a * v;
}
Eigen::VectorXd transposed_product(const MatrixXd& a, const Eigen::VectorXd& v) {
  return a.transpose() * v;
}

Columns columns_product(const Eigen::Ref<const Columns>& a, const MatrixXd& b) {
  check_interrupt();
  return a * b;
}

void subtract_product(Columns& from, const Eigen::Ref<const Columns>& a, const MatrixXd& b) {
  check_interrupt();
  from.noalias() -= a * b;
}

void add_inner(const Eigen::Ref<const Columns>& a, const Eigen::Ref<const Columns>& b, MatrixXd& sum) {
  sum.noalias() += a.transpose() * b;
}

void add_outer(MatrixXd& sum, double weight, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  for (Eigen::Index c = 0; c < b.size(); ++c) sum.col(c) += (weight * b(c)) * a;
}

MatrixXd least_squares(const MatrixXd& a, const MatrixXd& b) {
  return a.colPivHouseholderQr().solve(b);
}
MatrixXd solved(const MatrixXd& a, const MatrixXd& b) {
  return a.ldlt().solve(b);
}

}  // namespace mobil::inline v0_3
