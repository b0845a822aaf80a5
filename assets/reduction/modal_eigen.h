#pragma once
// Eigenvalues and eigenvectors of a small symmetric matrix, in a few microseconds and without heap.

#include <cstddef>

#include "assets/reduction/modal_basis.h"

namespace mobil::inline v0_3 {

struct SmallEigen {
  double value[max_modes];              // ascending
  double vector[max_modes][max_modes];  // a row each, orthonormal
};

/// Solves `matrix` (rows of max_modes numbers, `size` of each used, 1 to max_modes; destroyed) by Householder's
/// tridiagonal form, then implicit QL (Golub and Van Loan, Matrix Computations, 4th ed., 8.3). Returns false if it does
/// not converge (numbers that are not finite).
bool solve_small(double (*matrix)[max_modes], std::size_t size, SmallEigen& result);

}  // namespace mobil::inline v0_3
