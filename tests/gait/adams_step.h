#pragma once
// One step of the Adams methods of fourth order on a grid of unequal steps, and the three Runge–Kutta steps before it.
// The formulas integrate the polynomial through the last derivatives in Newton's form (Hairer, Nørsett, Wanner, Solving
// Ordinary Differential Equations I, section III.5). On an even grid they are the classical Adams–Bashforth 55/24,
// −59/24, 37/24, −9/24 and Adams–Moulton 9/24, 19/24, −5/24, 1/24.

#include <array>
#include <cmath>
#include <cstddef>

namespace mobil::step {

/// The unknowns, or their derivatives.
template <std::size_t N>
using Unknowns = std::array<double, N>;

/// One accepted step as a polynomial of degree four. It meets state and derivative at both ends and the derivative at
/// one neighbouring point, so pieces join with continuous derivative and are within O(h⁵) of the solution.
template <std::size_t N>
struct DenseStep {
  double begin_s, end_s;
  Unknowns<N> first, last;            // states
  Unknowns<N> first_rate, last_rate;  // derivatives there
  Unknowns<N> bow;                    // quartic minus cubic

  /// Returns the state at a time within the step.
  Unknowns<N> state(double time_s) const {
    const double h = end_s - begin_s, u = (time_s - begin_s) / h, w = 1.0 - u;
    Unknowns<N> y;
    for (std::size_t i = 0; i < N; ++i)
      y[i] = w * w * (1.0 + 2.0 * u) * first[i] + u * u * (1.0 + 2.0 * w) * last[i] +
             u * w * (h * (w * first_rate[i] - u * last_rate[i]) + u * w * bow[i]);
    return y;
  }
};

template <std::size_t N>
DenseStep<N> dense_step(double begin, double end, const Unknowns<N>& y0, const Unknowns<N>& y1, const Unknowns<N>& f0,
                        const Unknowns<N>& f1) {
  return {begin, end, y0, y1, f0, f1, {}};
}

/// Adjusts a dense step to the derivative `f` at `u` step lengths from its start, u < 0 or u > 1.
template <std::size_t N>
void bend(DenseStep<N>& d, const Unknowns<N>& f, double u) {
  const double h = d.end_s - d.begin_s;
  for (std::size_t i = 0; i < N; ++i) {
    const double cubic =
        6.0 * u * (1.0 - u) * (d.last[i] - d.first[i]) +
        h * ((3.0 * u * u - 4.0 * u + 1.0) * d.first_rate[i] + (3.0 * u * u - 2.0 * u) * d.last_rate[i]);
    d.bow[i] = (h * f[i] - cubic) / (2.0 * u * (1.0 - u) * (1.0 - 2.0 * u));
  }
}

/// Derivatives at the last four points, newest first, and the steps between them.
template <std::size_t N>
struct AdamsHistory {
  std::array<Unknowns<N>, 4> rate;
  std::array<double, 3> step;

  void push(const Unknowns<N>& newest, double h) {
    rate = {newest, rate[0], rate[1], rate[2]};
    step = {h, step[0], step[1]};
  }
};

/// Quantities of a step of h before its derivative is known: integrals of the Newton polynomials s, s(s + a₁), s(s +
/// a₁)(s + a₂), with a_k the distance to the k-th last point, and the divided differences.
template <std::size_t N>
struct AdamsStep {
  double h, a1, a2, a3, g3, corrector;  // corrector: ∫ s(s + a₁)(s + a₂)(h − s) ds, 19/720 · 24 h⁵ on an even grid
  Unknowns<N> explicit_part, d1, d2, d3;
  Unknowns<N> predicted;
};

/// Predicts with the Adams–Bashforth formula of four points.
template <std::size_t N>
AdamsStep<N> predict(const Unknowns<N>& y, const AdamsHistory<N>& past, double h) {
  const double h1 = past.step[0], h2 = past.step[1], h3 = past.step[2];
  AdamsStep<N> s;
  s.h = h, s.a1 = h1, s.a2 = h1 + h2, s.a3 = h1 + h2 + h3;
  const double hh = h * h, sum = s.a1 + s.a2, product = s.a1 * s.a2;
  const double g1 = hh / 2.0, g2 = hh * (h / 3.0 + s.a1 / 2.0);
  s.g3 = hh * (hh / 4.0 + sum * h / 3.0 + product / 2.0);
  s.corrector = hh * h * (hh / 20.0 + sum * h / 12.0 + product / 6.0);
  const double w1 = 1.0 / h1, w2 = 1.0 / h2, w3 = 1.0 / h3, w12 = 1.0 / s.a2, w23 = 1.0 / (h2 + h3), w123 = 1.0 / s.a3;
  for (std::size_t i = 0; i < N; ++i) {
    const double f = past.rate[0][i];
    const double d1b = (past.rate[1][i] - past.rate[2][i]) * w2, d1c = (past.rate[2][i] - past.rate[3][i]) * w3;
    s.d1[i] = (f - past.rate[1][i]) * w1;
    s.d2[i] = (s.d1[i] - d1b) * w12;
    s.d3[i] = (s.d2[i] - (d1b - d1c) * w23) * w123;
    s.explicit_part[i] = h * f + g1 * s.d1[i] + g2 * s.d2[i];
    s.predicted[i] = y[i] + (s.explicit_part[i] + s.g3 * s.d3[i]);
  }
  return s;
}

/// Corrects with the Adams–Moulton formula of three points and the new one, using the derivative of the predicted
/// state. `error` is Milne's signed estimate of the remaining error: on an even grid 19/270 of the difference to the
/// predictor.
template <std::size_t N>
Unknowns<N> correct(const Unknowns<N>& y, const AdamsHistory<N>& past, const AdamsStep<N>& s,
                    const Unknowns<N>& rate_predicted, Unknowns<N>& error) {
  const double w = 1.0 / s.h, w1 = 1.0 / (s.h + s.a1), w12 = 1.0 / (s.h + s.a2), w123 = 1.0 / (s.h + s.a3);
  Unknowns<N> corrected;
  for (std::size_t i = 0; i < N; ++i) {
    const double e3 = (((rate_predicted[i] - past.rate[0][i]) * w - s.d1[i]) * w1 - s.d2[i]) * w12;
    corrected[i] = y[i] + (s.explicit_part[i] + s.g3 * e3);
    error[i] = s.corrector * ((s.d3[i] - e3) * w123);
  }
  return corrected;
}

/// Up to three classical Runge–Kutta steps: states, derivatives and increments.
template <std::size_t N>
struct RungeKuttaStart {
  std::array<Unknowns<N>, 4> state, rate;
  std::array<Unknowns<N>, 3> increment;
};

/// Makes `count` steps of h from state[0], rate[0] at `time`. Returns false if f is not finite, as `evaluate(t, y, f)`
/// does.
template <std::size_t N, class Evaluate>
bool runge_kutta_start(RungeKuttaStart<N>& s, double time, double h, std::size_t count, Evaluate&& evaluate) {
  for (std::size_t k = 0; k < count; ++k) {
    const double t = time + static_cast<double>(k) * h;
    const Unknowns<N>&y = s.state[k], &k1 = s.rate[k];
    Unknowns<N> at, k2, k3, k4;
    for (std::size_t i = 0; i < N; ++i) at[i] = y[i] + 0.5 * h * k1[i];
    if (!evaluate(t + 0.5 * h, at, k2)) return false;
    for (std::size_t i = 0; i < N; ++i) at[i] = y[i] + 0.5 * h * k2[i];
    if (!evaluate(t + 0.5 * h, at, k3)) return false;
    for (std::size_t i = 0; i < N; ++i) at[i] = y[i] + h * k3[i];
    if (!evaluate(t + h, at, k4)) return false;
    for (std::size_t i = 0; i < N; ++i) {
      s.increment[k][i] = h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
      s.state[k + 1][i] = y[i] + s.increment[k][i];
    }
    if (!evaluate(t + h, s.state[k + 1], s.rate[k + 1])) return false;
  }
  return true;
}

/// Returns the error of the three steps, as the local error of the corrector for one such step. Simpson's rule over two
/// steps and the three-eighths rule over three integrate derivatives that are available anyway. Their differences to
/// the Runge–Kutta states are 1/90 and 3/80 h⁵y⁽⁵⁾ plus Runge–Kutta's own errors; the corrector's error is 19/720.
template <std::size_t N>
Unknowns<N> start_error(const RungeKuttaStart<N>& s, double h) {
  Unknowns<N> error;
  for (std::size_t i = 0; i < N; ++i) {
    const double f0 = s.rate[0][i], f1 = s.rate[1][i], f2 = s.rate[2][i], f3 = s.rate[3][i];
    const double two = s.increment[0][i] + s.increment[1][i], three = two + s.increment[2][i];
    const double simpson = std::fabs(two - h / 3.0 * (f0 + 4.0 * f1 + f2));
    const double three_eighths = std::fabs(three - 0.375 * h * (f0 + 3.0 * (f1 + f2) + f3));
    error[i] = std::fmax(19.0 / 8.0 * simpson, 19.0 / 27.0 * three_eighths);
  }
  return error;
}

}  // namespace mobil::step
