#pragma once
// Solves y′ = f(t, y) for few unknowns and smooth forces: Adams–Bashforth predictor and Adams–Moulton corrector of
// fourth order (PECE, two evaluations a step) with adaptive step, started by Runge–Kutta steps of fourth order (paper,
// section 4.1; Burden and Faires, Numerical Analysis, section 5.7).
//
// The step is not doubled and halved: the coefficients depend on the actual steps. A changed step needs neither a
// restart nor interpolated derivatives, steps meet the end exactly, and the step follows the tolerance smoothly.

#include <cmath>
#include <cstddef>
#include <limits>

#include <mobil/engine/error.h>
#include "tests/gait/adams_step.h"

namespace mobil::step {

template <std::size_t N>
constexpr Unknowns<N> alike(double value) {
  Unknowns<N> all{};
  for (double& v : all) v = value;
  return all;
}

/// Accuracy of the integration. Component i can err by absolute[i] + relative[i]·|y_i| over the whole interval. Each
/// step can make the local error that is its share of the interval in time, so the local errors sum to at most that
/// value. The error at the end is proportional to the tolerance, as far as the equations themselves do not amplify it.
/// No share is below a thousandth: steps shorter than 1e-3 of the interval can each make a thousandth of the tolerance,
/// which carries the integration over a jump of the derivative that the caller did not announce.
template <std::size_t N>
struct AdamsOptions {
  Unknowns<N> absolute = alike<N>(1e-9);  // in the component's unit, above 0
  Unknowns<N> relative = alike<N>(1e-9);  // 0 or more; tolerances below 1e-13·|y_i| exceed double precision
  double fixed_step_s = 0.0;              // above 0: no adaption, largest equal steps up to this value
};

struct AdamsCounts {
  long evaluations = 0;             // of f
  long accepted = 0, rejected = 0;  // steps; a rejected start counts as one
};

template <std::size_t N>
struct AdamsResult {
  Unknowns<N> state;  // at the end
  Unknowns<N> error;  // sum of the estimated local errors' magnitudes
  AdamsCounts counts;
};

namespace adams {

inline constexpr double last_place = std::numeric_limits<double>::epsilon();
inline constexpr double min_share = 1e-3;
inline constexpr double safety = 0.8, max_growth = 2.0, max_shrinking = 0.2;
inline constexpr int failures_before_restart = 3;
inline constexpr long max_evaluations = 1'000'000;

template <std::size_t N>
bool finite(const Unknowns<N>& v) {
  for (double x : v)
    if (!(std::fabs(x) <= std::numeric_limits<double>::max())) return false;
  return true;
}

/// Returns the factor by which a step changes if its error is `ratio` of its limit; the ratio has order four in the
/// step.
inline double step_factor(double ratio) {
  if (!(ratio < 1e12)) return max_shrinking;
  const double factor = ratio > 1e-12 ? safety / std::sqrt(std::sqrt(ratio)) : max_growth;
  return std::fmin(std::fmax(factor, max_shrinking), max_growth);
}

/// State of one integration.
template <std::size_t N, class Derivative, class Visit>
struct Run {
  const AdamsOptions<N>& options;
  Derivative& derivative;
  Visit& visit;
  double span, grain;  // of the whole interval; `grain`: 16 units in the last place of its times
  Unknowns<N> y, error{};
  AdamsCounts counts{};
  double time, end_s, wish = 0.0;  // `wish`: the step that accuracy alone allows
  AdamsHistory<N> past{};

  bool evaluate(double t, const Unknowns<N>& at, Unknowns<N>& f) {
    ++counts.evaluations;
    f = derivative(t, at);
    return finite(f);
  }

  void accept(const DenseStep<N>& step) {
    ++counts.accepted;
    visit(step);
  }

  /// Returns the worst component's error relative to the limit for a step of h.
  double ratio(const Unknowns<N>& local, const Unknowns<N>& there, double h) const {
    const double share = std::fmax(h / span, min_share);
    double worst = 0.0;
    for (std::size_t i = 0; i < N; ++i) {
      const double size = std::fmax(std::fabs(y[i]), std::fabs(there[i]));
      const double r = std::fabs(local[i]) / ((options.absolute[i] + options.relative[i] * size) * share);
      if (!(r >= 0.0)) return std::numeric_limits<double>::infinity();
      worst = std::fmax(worst, r);
    }
    return worst;
  }

  /// Returns the step for which the corrector's error 19/720 h⁵ λ⁴|f| is a tenth of its share. The rate of change λ is
  /// taken from the derivative a thousandth of the interval later.
  double guess(const Unknowns<N>& f) {
    double size = 0.0, change = 0.0;
    for (std::size_t i = 0; i < N; ++i)
      size = std::fmax(size, std::fabs(f[i]) / (options.absolute[i] + options.relative[i] * std::fabs(y[i])));
    const double ahead = 1e-3 * span;
    Unknowns<N> at, there;
    for (std::size_t i = 0; i < N; ++i) at[i] = y[i] + ahead * f[i];
    if (!evaluate(time + ahead, at, there)) return 1e-6 * span;
    for (std::size_t i = 0; i < N; ++i)
      change =
          std::fmax(change, std::fabs(there[i] - f[i]) / (options.absolute[i] + options.relative[i] * std::fabs(y[i])));
    if (!(size > 0.0) || !(change > 0.0)) return 1e-2 * span;
    const double pace = change / (ahead * size);
    return std::sqrt(std::sqrt(0.1 * 720.0 / 19.0 / (size * span))) / pace;
  }

  /// Takes over the Runge–Kutta steps; the last ends at `end`.
  void accept_start(const RungeKuttaStart<N>& s, double h, std::size_t count, double end) {
    for (std::size_t k = 0; k < count; ++k) {
      const double begin = time + static_cast<double>(k) * h;
      auto dense = dense_step<N>(begin, k + 1 == count ? end : time + static_cast<double>(k + 1) * h, s.state[k],
                                 s.state[k + 1], s.rate[k], s.rate[k + 1]);
      if (count > 1) bend(dense, s.rate[k == 0 ? 2 : k - 1], k == 0 ? 2.0 : -1.0);
      accept(dense);
      past.push(s.rate[k + 1], h);
    }
    if (count == 3) {
      const Unknowns<N> local = start_error(s, h);
      for (std::size_t i = 0; i < N; ++i) error[i] += 3.0 * local[i];
    }
    y = s.state[count];
    time = end;
  }

  /// Makes an Adams step to `end`. Returns the error ratio, or infinity on failure; sets whether f was finite.
  double advance(double h, double end, bool keep_all, bool& was_finite) {
    constexpr double no = std::numeric_limits<double>::infinity();
    const AdamsStep<N> step = predict(y, past, h);
    Unknowns<N> rate, local;
    was_finite = finite(step.predicted) && evaluate(end, step.predicted, rate);
    if (!was_finite) return no;
    const Unknowns<N> corrected = correct(y, past, step, rate, local);
    const double r = ratio(local, corrected, h);
    if (!(r <= 1.0) && !keep_all) return r;
    was_finite = finite(corrected) && evaluate(end, corrected, rate);
    if (!was_finite) return no;
    auto dense = dense_step<N>(time, end, y, corrected, past.rate[0], rate);
    bend(dense, past.rate[1], -past.step[0] / h);
    accept(dense);
    past.push(rate, h);
    for (std::size_t i = 0; i < N; ++i) error[i] += std::fabs(local[i]);
    y = corrected;
    time = end;
    return r;
  }

  /// Integrates with equal steps. Returns the error, or null.
  const char* fixed_steps() {
    const double begin = time, length = end_s - begin;
    const double count = std::ceil(length / options.fixed_step_s * (1.0 - 1e-12)), h = length / count;
    if (!(2.0 * count < static_cast<double>(max_evaluations))) return "too many evaluations";
    const long steps = static_cast<long>(count), start = steps < 3 ? steps : 3;
    auto at = [&](long k) { return k == steps ? end_s : begin + length * (static_cast<double>(k) / count); };
    RungeKuttaStart<N> s;
    s.state[0] = y;
    auto ask = [&](double t, const Unknowns<N>& there, Unknowns<N>& f) { return evaluate(t, there, f); };
    if (!evaluate(time, y, s.rate[0])) return "not finite";
    past.rate[0] = s.rate[0];
    if (!runge_kutta_start(s, time, h, static_cast<std::size_t>(start), ask)) return "not finite";
    accept_start(s, h, static_cast<std::size_t>(start), at(start));
    for (long k = start; k < steps; ++k) {
      bool was_finite = true;
      advance(h, at(k + 1), true, was_finite);
      if (!was_finite) return "not finite";
    }
    return nullptr;
  }

  const char* adaptive_steps() {
    auto ask = [&](double t, const Unknowns<N>& there, Unknowns<N>& f) { return evaluate(t, there, f); };
    Unknowns<N> newest;
    if (!evaluate(time, y, newest)) return "not finite";
    wish = guess(newest);
    bool started = false;
    int failures = 0;
    while (time < end_s) {
      if (counts.evaluations >= max_evaluations) return "too many evaluations";
      const double left = end_s - time;
      double h = std::fmax(wish, grain), r = 0.0;
      bool was_finite = true;
      if (!started) {
        const bool whole = 3.0 * h >= left;
        if (whole) h = left / 3.0;
        RungeKuttaStart<N> s;
        s.state[0] = y, s.rate[0] = newest;
        past.rate[0] = newest;
        was_finite = runge_kutta_start(s, time, h, 3, ask);
        r = was_finite ? ratio(start_error(s, h), s.state[3], h) : std::numeric_limits<double>::infinity();
        if (r <= 1.0) {
          accept_start(s, h, 3, whole ? end_s : time + 3.0 * h);
          started = true;
        }
      } else {
        if (h >= left)
          h = left;
        else if (2.0 * h > left)
          h = 0.5 * left;  // no tiny last step
        r = advance(h, h == left ? end_s : time + h, false, was_finite);
      }
      if (r <= 1.0) {
        // A step shortened by the end of the interval gives little information about a longer one.
        const double next = h * std::fmin(step_factor(r), failures > 0 ? 1.0 : max_growth);
        wish = h < wish ? std::fmax(wish, next) : next;
        failures = 0;
        continue;
      }
      ++counts.rejected;
      wish = h;
      if (h <= grain) return was_finite ? "the step fell to nothing" : "not finite";
      wish = std::fmax(h * std::fmin(step_factor(r), safety), grain);
      if (++failures >= failures_before_restart && started) {
        // The history does not predict the next step: an unannounced kink or jump.
        newest = past.rate[0];
        started = false;
      }
    }
    return nullptr;
  }
};

}  // namespace adams

/// Integrates from `state` at begin_s to end_s > begin_s. `derivative(t, y)` gives y′ as Unknowns<N>; `visit(step)` is
/// called with every accepted DenseStep<N>, in order and without gaps.
template <std::size_t N, class Derivative, class Visit>
Result<AdamsResult<N>> integrate_adams(Derivative&& derivative, const Unknowns<N>& state, double begin_s, double end_s,
                                       const AdamsOptions<N>& options, Visit&& visit) {
  const double grain = 16.0 * adams::last_place * std::fmax(std::fabs(begin_s), std::fabs(end_s));
  adams::Run<N, Derivative, Visit> run{options, derivative, visit, end_s - begin_s, grain,
                                       state,   {},         {},    begin_s,         end_s};
  const char* const why = options.fixed_step_s > 0.0 ? run.fixed_steps() : run.adaptive_steps();
  if (why != nullptr) return tl::unexpected<Error>({why});
  return AdamsResult<N>{run.y, run.error, run.counts};
}

template <std::size_t N, class Derivative>
Result<AdamsResult<N>> integrate_adams(Derivative&& derivative, const Unknowns<N>& state, double begin_s, double end_s,
                                       const AdamsOptions<N>& options = {}) {
  return integrate_adams<N>(derivative, state, begin_s, end_s, options, [](const DenseStep<N>&) {});
}

/// Returns a visitor that calls take(i, t, y) at `count` ≥ 2 equally spaced times t from begin_s to end_s, both
/// included. It serves one integration from begin_s to end_s, passed by reference or by value.
template <std::size_t N, class Take>
auto at_equal_times(double begin_s, double end_s, int count, Take take) {
  return [begin_s, end_s, count, take, i = 0](const DenseStep<N>& step) mutable {
    for (; i < count; ++i) {
      const double t = i + 1 == count ? end_s : begin_s + (end_s - begin_s) * (static_cast<double>(i) / (count - 1));
      if (t > step.end_s) return;
      take(i, t, t == step.end_s ? step.last : step.state(t));
    }
  };
}

}  // namespace mobil::step
