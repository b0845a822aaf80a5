#pragma once
// Eigenvalues and eigenvectors of a small symmetric matrix, in a few microseconds and without heap.

#include <cstddef>

#include "assets/reduction/reduced_basis.h"

namespace mobil::inline v0_3 {

struct SmallEigen {
  double value[most_vectors];                 // ascending
  double vector[most_vectors][most_vectors];  // a row each, orthonormal
};

/// Of `matrix` (rows of most_vectors numbers, `size` of each used, 1 to most_vectors; destroyed). Householder's
/// tridiagonal form, then implicit QL (Golub and Van Loan, Matrix Computations, 4th ed., 8.3). False where it does not
/// converge (numbers that are not finite).
bool solve_small(double (*matrix)[most_vectors], std::size_t size, SmallEigen& result);

}  // namespace mobil::inline v0_3
