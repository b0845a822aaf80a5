#pragma once
// Least squares by Gauss-Newton steps, shortened where they diverge (Levenberg and Marquardt).

#include <functional>
#include <span>
#include <vector>

namespace mobil {

/// Numbers to minimise, as a function of the unknowns. Their count is constant.
using Residuals = std::function<void(std::span<const double> unknown, std::vector<double>& residual)>;

struct LeastSquares {
  int max_steps = 100;
  double min_gain = 3e-6;  // of the sum of squares, below which a step is the last
};

/// Changes `unknown` toward the minimum of the sum of squares, and returns that sum. `scale` is the likely change of
/// each unknown; derivatives are difference quotients over 1e-4 of it. Bits are the same on every machine.
double least_squares(const Residuals& residuals, std::span<const double> scale, const LeastSquares& options,
                     std::span<double> unknown);

}  // namespace mobil
