#pragma once
// Least squares: the step of Gauss and Newton, shortened where it leads astray (Levenberg and Marquardt).

#include <functional>
#include <span>
#include <vector>

namespace mobil {

/// What is to become small, of one set of unknowns; always as many numbers.
using Residuals = std::function<void(std::span<const double> unknown, std::vector<double>& residual)>;

struct LeastSquares {
  int max_steps = 100;
  double min_gain = 3e-6;  // of the sum of squares, below which a step is the last
};

/// Changes `unknown` toward the least sum of squares, and returns that sum. `scale`: by how much each unknown is likely
/// to change. Derivatives are difference quotients over 1e-4 of it. The same bits on every machine.
double least_squares(const Residuals& residuals, std::span<const double> scale, const LeastSquares& options,
                     std::span<double> unknown);

}  // namespace mobil
