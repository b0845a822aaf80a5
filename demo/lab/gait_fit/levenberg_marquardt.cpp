#include "demo/lab/gait_fit/levenberg_marquardt.h"

#include <algorithm>
#include <cmath>

#include "engine/eigen.h"

namespace mobil {
namespace {

constexpr double difference = 1e-4;
constexpr int earliest_end = 5, max_retries = 9;

double squares(const std::vector<double>& r) {
  double sum = 0;
  for (const double v : r) sum += v * v;
  return sum;
}

/// Returns the derivatives of the residuals by the unknowns over their scale. Writes the residuals to `now`.
Eigen::MatrixXd derivatives(const Residuals& residuals, std::span<const double> scale, std::span<const double> unknown,
                            std::vector<double>& now) {
  std::vector<double> there, tried(unknown.begin(), unknown.end());
  residuals(unknown, now);
  Eigen::MatrixXd jacobian(static_cast<Eigen::Index>(now.size()), static_cast<Eigen::Index>(unknown.size()));
  for (std::size_t k = 0; k < unknown.size(); ++k) {
    tried[k] += difference * scale[k];
    residuals(tried, there);
    tried[k] = unknown[k];
    for (std::size_t i = 0; i < now.size(); ++i)
      jacobian(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = (there[i] - now[i]) / difference;
  }
  return jacobian;
}

}  // namespace

double least_squares(const Residuals& residuals, std::span<const double> scale, const LeastSquares& options,
                     std::span<double> unknown) {
  const auto n = static_cast<Eigen::Index>(unknown.size());
  std::vector<double> now, there, tried(unknown.begin(), unknown.end());
  residuals(unknown, now);
  double sum = squares(now), damping = 1e-2;
  for (int step = 0; step < options.max_steps; ++step) {
    const Eigen::MatrixXd jacobian = derivatives(residuals, scale, unknown, now);
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n, n);
    normal.selfadjointView<Eigen::Lower>().rankUpdate(jacobian.transpose());
    normal = normal.selfadjointView<Eigen::Lower>();
    const Eigen::VectorXd slope = jacobian.transpose() * Eigen::Map<const Eigen::VectorXd>(now.data(), jacobian.rows());
    const double least = 1e-3 * normal.trace() / static_cast<double>(n);
    double next = sum;
    for (int retry = 0; retry < max_retries; ++retry, damping *= 4) {
      Eigen::MatrixXd damped = normal;
      damped.diagonal() += damping * (normal.diagonal().array() + least).matrix();
      const Eigen::VectorXd change = -damped.ldlt().solve(slope);
      for (std::size_t k = 0; k < unknown.size(); ++k)
        tried[k] = unknown[k] + scale[k] * change[static_cast<Eigen::Index>(k)];
      residuals(tried, there);
      next = squares(there);
      if (std::isfinite(next) && next < sum) break;
    }
    if (!(next < sum)) return sum;
    const bool last = sum - next < options.min_gain * sum && step > earliest_end;
    std::copy(tried.begin(), tried.end(), unknown.begin());
    now.swap(there);
    sum = next;
    damping = std::max(damping / 5, 1e-7);
    if (last) break;
  }
  return sum;
}

}  // namespace mobil
