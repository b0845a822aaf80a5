#pragma once
// One fibre and one tendon in series, in double precision, solved by bisection: reference for the lanes of
// systems/activation. The curves follow De Groote et al. 2016 and OpenSim's DeGrooteFregly2016Muscle.

#include <algorithm>
#include <cmath>

#include <mobil/components/activation.h>

namespace mobil::test {

struct HillMember {
  double fibre_m, tendon_m, pennation_rad, force_n;
};

inline double hill_active(double m) {
  const double bells[3][4] = {
      {0.815, 1.055, 0.162, 0.063}, {0.433, 0.717, -0.030, 0.200}, {0.1, 1.0, 0.353553390593274, 0}};
  double sum = 0;
  for (const auto& b : bells) sum += b[0] * std::exp(-0.5 * std::pow((m - b[1]) / (b[2] + b[3] * m), 2));
  return sum;
}
inline double hill_passive(double m) {
  return m <= 1 ? 0 : (std::exp(4 * (m - 1) / 0.6) - 1) / (std::exp(4) - 1);
}
inline double hill_at_speed(double v) {
  return std::max(0.0, -0.3211346127989808 * std::asinh(-8.149 * v - 0.374) + 0.8825327733249912);
}
inline double hill_tendon(double t) {
  return std::max(-0.05, 0.2 * std::exp(std::log(6.0) / 0.049 * (t - 1)) - 0.2);
}

/// Returns the fibre's length over its optimal length, on a path of length `path_m`. With `tick_s` 0 it is at rest.
inline double hill_fibre(const HillMember& of, double path_m, double activation, double before, double tick_s) {
  const double height = std::sin(of.pennation_rad);
  double low = std::max(1.05 * height, 0.3), high = 1.8;
  for (int i = 0; i < 100; ++i) {
    const double m = (low + high) / 2, cos = std::sqrt(1 - std::pow(height / m, 2));
    const double v = tick_s > 0 ? (m - before) / (10 * tick_s) : 0;
    const double fibre = activation * hill_active(m) * hill_at_speed(v) + hill_passive(m) + 0.1 * v;
    const double left = fibre * cos - hill_tendon((path_m - of.fibre_m * m * cos) / of.tendon_m);
    (left > 0 ? high : low) = m;
  }
  return (low + high) / 2;
}

inline double hill_cosine(const HillMember& of, double m) {
  return std::sqrt(1 - std::pow(std::sin(of.pennation_rad) / m, 2));
}
inline double hill_tendon_m(const HillMember& of, double path_m, double m) {
  return path_m - of.fibre_m * m * hill_cosine(of, m);
}

/// Activation dynamics of Thelen 2003.
inline double hill_activation(double activation, double excitation, double tick_s) {
  const double by = 0.5 + 1.5 * activation, tau = excitation > activation ? 0.010 * by : 0.040 / by;
  return activation + (excitation - activation) * (1 - std::exp(-tick_s / tau));
}

}  // namespace mobil::test
