#include "demo/lab/run_fit/run_objective.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include <mobil/components/gait.h>
#include "demo/lab/compare/compare_reference.h"
#include "engine/eigen.h"

namespace mobil {
namespace {

constexpr double run_degrees = 180 / std::numbers::pi;
constexpr double max_outside_m = 0.002;  // of the centre of pressure beyond the sole
constexpr double max_free = 0.22;        // moment of a foot about the vertical, N m/kg
constexpr double usual_lean = 0.14;      // rad, toward which the trunk is drawn weakly

double under(double value, double least) {
  return std::min(value - least, 0.0);
}
double over(double value, double most) {
  return std::max(value - most, 0.0);
}
double third_of(const RunSamples& q, std::size_t i) {
  const std::size_t n = q.size();
  return q[(i + 3) % n] - 3 * q[(i + 2) % n] + 3 * q[(i + 1) % n] - q[i];
}
double bend_of(const RunSamples& q, std::size_t i) {
  const std::size_t n = q.size();
  return q[(i + 1) % n] - 2 * q[i] + q[(i + n - 1) % n];
}

/// Residuals, divided by the root of their count over a cycle, so that a curve's squares are a mean.
class RunGathered {
 public:
  RunGathered(std::vector<double>& to, std::size_t samples) : to_(to), n_(samples) { to_.clear(); }
  template <class At>
  void cycle(double weight, At at) {
    const double each = weight / std::sqrt(static_cast<double>(n_));
    for (std::size_t i = 0; i < n_; ++i) to_.push_back(each * at(i));
  }
  /// Adds a quantity of the whole body, which has two equal halves.
  template <class At>
  void step(double weight, At at) {
    const double each = weight / std::sqrt(0.5 * static_cast<double>(n_));
    for (std::size_t i = 0; i < n_ / 2; ++i) to_.push_back(each * at(i));
  }
  /// Adds a quantity of the right foot, which is 0 in the second half.
  template <class At>
  void stance(double weight, At at) {
    step(weight * std::numbers::sqrt2 / 2, at);
  }
  void one(double value) { to_.push_back(value); }

 private:
  std::vector<double>& to_;
  std::size_t n_;
};

struct RunAims {
  RunModel model;
  RunCycle cycle;
  RunTargets targets;
  RunWeights weights;
  RunShape likely;

  RunAims(const RunTask& task, const RunTargets& to, const RunWeights& by, const RunShape& drawn)
      : model(task), targets(to), weights(by), likely(drawn) {}

  void gather(std::span<const double> unknown, std::vector<double>& residual);
  void measured(RunGathered& all) const;
  void balanced(RunGathered& all) const;
  void bounded(RunGathered& all) const;
  void balanced_aside(RunGathered& all) const;
  const RunSamples& mean(RunQuantity q) const { return targets.curve[index(q)].mean; }
};

/// Adds distances from measured curves, and excess over their peaks.
void RunAims::measured(RunGathered& all) const {
  using enum RunQuantity;
  const auto angle = [&](RunQuantity quantity, const RunSamples& ours, double scale_deg) {
    const RunSamples& theirs = mean(quantity);
    all.cycle(weights.angles / scale_deg, [&](std::size_t i) { return run_degrees * ours[i] - theirs[i]; });
  };
  angle(hip, cycle.cycle.hip, 2.5);
  angle(knee, cycle.cycle.knee, 2.2);
  angle(ankle, cycle.cycle.ankle, 2.0);
  angle(foot_pitch, cycle.foot.pitch, 5);
  const auto& force = cycle.step.force;
  all.stance(0.8 / 0.05 * weights.forces,
             [&](std::size_t i) { return force[i].y == 0 ? 0.0 : force[i].y - mean(vertical)[i]; });
  all.stance(0.8 / 0.03 * weights.forces, [&](std::size_t i) { return force[i].z - mean(fore_aft)[i]; });
  struct Moment {
    RunQuantity quantity;
    const RunSamples* ours;
    double spare;
  };
  for (const auto& [quantity, ours, spare] :
       {Moment{hip_moment, &cycle.cycle.hip_moment, 0.10}, Moment{knee_moment, &cycle.cycle.knee_moment, 0.05},
        Moment{ankle_moment, &cycle.cycle.ankle_moment, 0.08}}) {
    const RunSamples& theirs = mean(quantity);
    const auto [low, high] = std::ranges::minmax(theirs);
    all.cycle(weights.moments / 0.15, [&](std::size_t i) { return (*ours)[i] - theirs[i]; });
    all.cycle(30 * weights.moments, [&](std::size_t i) {
      const double m = (*ours)[i];
      return over(m / high, 1 + spare) + (low < -0.3 ? over(m / low, 1 + spare) : 0);
    });
  }
}

/// Adds balance about the axis across.
void RunAims::balanced(RunGathered& all) const {
  constexpr double most = 20;
  const auto& s = cycle.step;
  all.step(weights.balance, [&](std::size_t i) { return std::clamp(s.pitch_lacking[i], -most, most); });
  all.step(0.01 * weights.balance, [&](std::size_t i) {
    const double outside = over(s.wanted[i], s.front[i]) + under(s.wanted[i], s.back[i]);
    return outside * std::clamp(s.force[i].y, 0.0, 0.3);
  });
  all.step(10 * weights.balance, [&](std::size_t i) {
    const double outside = std::max(s.wanted[i] - s.front[i], s.back[i] - s.wanted[i]);
    return over(outside, max_outside_m) * std::clamp(10 * s.force[i].y - 2, 0.0, 1.0);
  });
  all.stance(30, [&](std::size_t i) { return under(s.force[i].y, 0); });
}

/// Adds balance about the axis ahead and the vertical.
void RunAims::balanced_aside(RunGathered& all) const {
  const auto& s = cycle.step;
  const double part = 2 * model.task().duty, each = weights.aside, half = static_cast<double>(s.yaw.size());
  all.step(30 * each, [&](std::size_t i) { return s.roll_lacking[i]; });
  const auto stands = [&](std::size_t i) { return static_cast<double>(i) < part * half; };
  all.step(28 * each, [&](std::size_t i) { return (stands(i) ? 0.09 : 1) * s.yaw[i]; });
  all.step(30 * each, [&](std::size_t i) { return stands(i) ? over(std::abs(s.yaw[i]), max_free) : 0.0; });
  all.step(6 / 0.03 * each,
           [&](std::size_t i) { return std::clamp(s.aside[i], -0.2, 0.2) * std::clamp(s.force[i].y, 0.0, 1.0); });
  all.step(0.3 * each, [&](std::size_t i) { return run_degrees * s.side_lean[i]; });
  all.step(0.06 * each, [&](std::size_t i) { return run_degrees * s.shoulders[i]; });
}

/// Adds reach, clearance, smoothness, the pad's and the trunk's limits.
void RunAims::bounded(RunGathered& all) const {
  const RunFoot& foot = cycle.foot;
  const auto& c = cycle.cycle;
  all.cycle(weights.reach, [&](std::size_t i) { return under(c.slack[i], weights.min_slack_m); });
  const double duty = model.task().duty, n = static_cast<double>(foot.clear.size());
  all.cycle(3000, [&](std::size_t i) {
    if (static_cast<double>(i) < duty * n) return 0.0;
    const double u = foot.swung[i];
    return under(foot.clear[i], 0.0105 * std::clamp(6 * u, 0.0, 1.0) * std::clamp(6 * (1 - u), 0.0, 1.0));
  });
  all.cycle(1.4, [&](std::size_t i) { return run_degrees * third_of(c.knee, i); });
  all.cycle(0.7, [&](std::size_t i) { return run_degrees * third_of(c.ankle, i); });
  all.cycle(0.7, [&](std::size_t i) { return run_degrees * third_of(foot.pitch, i); });
  for (const RunSamples* moment : {&c.hip_moment, &c.knee_moment, &c.ankle_moment})
    all.cycle(3, [&](std::size_t i) { return bend_of(*moment, i); });
  all.cycle(3000, [&](std::size_t i) { return under(foot.pad_up[i], 0) + over(foot.pad_up[i], 0.012); });
  all.cycle(6000, [&](std::size_t i) { return over(std::abs(foot.pad_forward[i]), 0.004); });
  const RunSamples& lean = cycle.step.trunk;
  double mean_lean = 0;
  for (const double l : lean) mean_lean += l / static_cast<double>(lean.size());
  all.one(run_degrees * (mean_lean - usual_lean) / 4);
  all.step(1.0 / 3, [&](std::size_t i) { return run_degrees * (lean[i] - mean_lean); });
  const auto [low, high] = std::ranges::minmax(cycle.step.centre, {}, &Vec3<double>::y);
  const double rise = high.y - low.y;
  all.one(300 * (under(rise, targets.min_rise_m) + over(rise, targets.max_rise_m)));
}

void RunAims::gather(std::span<const double> unknown, std::vector<double>& residual) {
  static constexpr RunShape scale = run_shape_scales();
  RunShape shape = likely;
  std::ranges::copy(unknown, shape.begin());
  model.evaluate(shape, cycle);
  RunGathered all(residual, model.task().samples);
  measured(all);
  balanced(all);
  bounded(all);
  if (weights.aside != 0) balanced_aside(all);
  for (std::size_t k = 0; k < unknown.size(); ++k) all.one(weights.likely * (shape[k] - likely[k]) / scale[k]);
}

/// Returns the force numbers that are nearest to a curve over stance.
Eigen::VectorXd force_numbers(const RunTask& task, const std::vector<double>& force) {
  constexpr Eigen::Index points = 80, terms = 9;
  Eigen::MatrixXd basis(points, terms);
  Eigen::VectorXd wanted(points);
  const auto n = static_cast<double>(force.size());
  for (Eigen::Index i = 0; i < points; ++i) {
    const double u = static_cast<double>(i) / (points - 1), at = u * task.duty * n;
    const auto k = static_cast<std::size_t>(at);
    wanted[i] = std::lerp(force[k], force[(k + 1) % force.size()], at - static_cast<double>(k));
    for (Eigen::Index t = 0; t < terms; ++t)
      basis(i, t) = u * (1 - u) * std::legendre(static_cast<unsigned>(t), 2 * u - 1);
  }
  return basis.householderQr().solve(wanted);
}

}  // namespace

RunTask run_task(const RunTargets& targets, std::size_t samples) {
  const GaitStyle style;
  const auto rad = [](float degrees) { return static_cast<double>(degrees) / run_degrees; };
  RunTask task{run_body(fitted_height_m),
               targets.speed_m_s,
               targets.frequency_hz,
               targets.duty,
               run_table::half_width * fitted_height_m,
               rad(style.toe_out_deg),
               rad(style.arm_abduction_deg),
               rad(style.forearm_pronation_deg),
               rad(style.finger_flexion_deg),
               targets.given,
               samples};
  return task;
}

RunShape first_run_shape(const RunTask& task, const RunTargets& targets) {
  RunShape p{};
  const auto set = [&](const ShapePart& part, std::initializer_list<double> values) {
    std::copy(values.begin(), values.end(), p.begin() + static_cast<long>(part.first));
  };
  const Eigen::VectorXd up = force_numbers(task, targets.curve[index(RunQuantity::vertical)].mean),
                        forward = force_numbers(task, targets.curve[index(RunQuantity::fore_aft)].mean);
  for (std::size_t k = 0; k < run_shape::force_up.count; ++k) {
    p[run_shape::force_up.first + k] = up[static_cast<Eigen::Index>(k + 1)];
    p[run_shape::force_forward.first + k] = forward[static_cast<Eigen::Index>(k + 1)];
  }
  const double faster = task.speed_m_s - 2.5, leg = task.body.size.leg;
  set(run_shape::centre, {-0.18 * leg * (1 + 0.15 * faster), 0.03});
  set(run_shape::trunk, {0.15});
  set(run_shape::strike, {10 / run_degrees, -0.1, -0.2});
  set(run_shape::rise, {0.7, 0.2});
  set(run_shape::swing_pitch, {-0.7, 0.2});
  set(run_shape::swing_forward, {-0.1, 0.2});
  set(run_shape::swing_up, {0.32 + 0.08 * faster, -0.1});
  set(run_shape::pad_up, {0.006});
  set(run_shape::force_aside, {0.25});
  set(run_shape::shoulders, {-0.5 * task.given.turn[0], 0, -0.5 * task.given.turn[2], 0});
  return p;
}

RunSamples samples_of(const RunCycle& cycle, RunQuantity quantity) {
  const auto in_degrees = [](RunSamples angle) {
    for (double& a : angle) a *= run_degrees;
    return angle;
  };
  const auto of_force = [&](double Vec3<double>::*component) {
    RunSamples force(cycle.cycle.hip.size(), 0.0);
    for (std::size_t i = 0; i < cycle.step.force.size(); ++i) force[i] = cycle.step.force[i].*component;
    return force;
  };
  switch (quantity) {
    case RunQuantity::hip:
      return in_degrees(cycle.cycle.hip);
    case RunQuantity::knee:
      return in_degrees(cycle.cycle.knee);
    case RunQuantity::ankle:
      return in_degrees(cycle.cycle.ankle);
    case RunQuantity::foot_pitch:
      return in_degrees(cycle.foot.pitch);
    case RunQuantity::vertical:
      return of_force(&Vec3<double>::y);
    case RunQuantity::fore_aft:
      return of_force(&Vec3<double>::z);
    case RunQuantity::hip_moment:
      return cycle.cycle.hip_moment;
    case RunQuantity::knee_moment:
      return cycle.cycle.knee_moment;
    default:
      return cycle.cycle.ankle_moment;
  }
}

Residuals run_residuals(const RunTask& task, const RunTargets& targets, const RunWeights& weights,
                        const RunShape& likely) {
  auto aims = std::make_shared<RunAims>(task, targets, weights, likely);
  return [aims](std::span<const double> unknown, std::vector<double>& residual) { aims->gather(unknown, residual); };
}

}  // namespace mobil
