#pragma once
// Algebra of dense matrices, each operation compiled once. Every expression of Eigen's is a separate type, and takes
// the compiler a second.

#include "assets/reduction/modal_cholesky.h"
#include "engine/eigen.h"

namespace mobil::inline v0_3 {

Eigen::MatrixXd transposed(const Eigen::MatrixXd& m);
Eigen::MatrixXd product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
Eigen::VectorXd product(const Eigen::MatrixXd& a, const Eigen::VectorXd& v);
/// Returns aᵀ·v.
Eigen::VectorXd transposed_product(const Eigen::MatrixXd& a, const Eigen::VectorXd& v);
Columns columns_product(const Eigen::Ref<const Columns>& a, const Eigen::MatrixXd& b);

/// Subtracts a·b from `from`.
void subtract_product(Columns& from, const Eigen::Ref<const Columns>& a, const Eigen::MatrixXd& b);

/// Adds aᵀ·b to `sum`.
void add_inner(const Eigen::Ref<const Columns>& a, const Eigen::Ref<const Columns>& b, Eigen::MatrixXd& sum);

/// Adds weight·a·bᵀ to `sum`.
void add_outer(Eigen::MatrixXd& sum, double weight, const Eigen::VectorXd& a, const Eigen::VectorXd& b);

/// Returns the x that minimises |a·x − b|, a column for each of b. `a` has at least as many rows as columns.
Eigen::MatrixXd least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Returns the x of a·x = b for a symmetric, definite `a`.
Eigen::MatrixXd solved(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

}  // namespace mobil::inline v0_3
