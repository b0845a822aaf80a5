#include "demo/lab/gait_fit/step_objective.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

namespace mobil {
namespace {

constexpr std::size_t n = cycle_samples;
constexpr double degrees = 180 / std::numbers::pi, gravity = gravity_m_s2;

constexpr double rise_margin = 0.001;  // m, distance kept from the bounds

/// Interpolates linearly between the 2 % at which curves are published.
Samples resampled(const CycleCurve& curve) {
  Samples out;
  for (std::size_t i = 0; i < n; ++i) {
    const double at = static_cast<double>(i) * (cycle_points - 1) / n;
    const auto k = static_cast<std::size_t>(at);
    out[i] = curve[k] + (at - static_cast<double>(k)) * (curve[k + 1] - curve[k]);
  }
  return out;
}

/// Returns weights of the classes of a set at a speed: the Catmull-Rom cubic through the two on either side, among all
/// classes except `without`.
std::array<double, speed_class_count> class_weights(const MeasuredSet& set, double speed, std::size_t without) {
  std::array<double, speed_class_count> weight{};
  std::vector<std::size_t> kept;
  for (std::size_t c = 0; c < speed_class_count; ++c) {
    if (c != without) kept.push_back(c);
  }
  std::size_t i = 0;
  while (i + 2 < kept.size() && speed > set.speed[kept[i + 1]]) ++i;
  const double first = set.speed[kept[i]], span = set.speed[kept[i + 1]] - first;
  const double u = std::clamp((speed - first) / span, 0.0, 1.0);
  const double h00 = (1 + 2 * u) * (1 - u) * (1 - u), h01 = u * u * (3 - 2 * u);
  const double h10 = u * (1 - u) * (1 - u) * span, h11 = u * u * (u - 1) * span;
  weight[kept[i]] += h00;
  weight[kept[i + 1]] += h01;
  const auto slope = [&](std::size_t k, double times) {  // of the parabola through neighbours, one-sided at the ends
    const std::size_t a = kept[k == 0 ? 0 : k - 1], b = kept[std::min(k + 1, kept.size() - 1)];
    const double over = set.speed[b] - set.speed[a];
    weight[b] += times / over;
    weight[a] -= times / over;
  };
  slope(i, h10);
  slope(i + 1, h11);
  return weight;
}

/// Returns the change of a curve in a whole cycle at its rate there, taken over 4 % of it.
double rate(const Samples& q, std::size_t i) {
  return std::abs(q[(i + 4) % n] - q[(i + n - 4) % n]) / 8 * n;
}
double third(const Samples& q, std::size_t i) {
  return q[(i + 3) % n] - 3 * q[(i + 2) % n] + 3 * q[(i + 1) % n] - q[i];
}
double bend(const Samples& q, std::size_t i) {
  return q[(i + 1) % n] - 2 * q[i] + q[(i + n - 1) % n];
}

/// Residuals, each divided by √n so that a curve's squares are a mean.
class Gathered {
 public:
  explicit Gathered(std::vector<double>& to) : to_(to) { to_.clear(); }
  template <class At>
  void curve(double weight, At at) {
    const double each = weight / std::sqrt(static_cast<double>(n));
    for (std::size_t i = 0; i < n; ++i) to_.push_back(each * at(i));
  }
  void one(double value) { to_.push_back(value); }

 private:
  std::vector<double>& to_;
};

/// Rearmost and foremost possible centre of pressure under a foot of that pitch, ahead of the ankle.
struct Sole {
  double back, front;
};
Sole sole(const StepBody& b, double pitch) {
  const double heel = -b.heel_back - 0.005, tip = b.ball_forward + 0.04 * b.height;
  const double toes_up = std::max(pitch, 0.0), heel_up = std::max(-pitch, 0.0);
  const double front = heel + (tip - heel) * std::clamp(1 - toes_up / 0.30, 0.0, 1.0) + 0.03;
  const double back = heel + (b.ball_forward - 0.03 - heel) * std::clamp(heel_up / 0.15, 0.0, 1.0);
  return {back, std::min(front, tip)};
}

double below(double value, double least) {
  return std::min(value - least, 0.0);
}
double beyond(double value, double most) {
  return std::max(value - most, 0.0);
}

struct Aims {
  StepTask task;
  StepTargets targets;
  StepWeights weights;
  std::array<double, 3> max_rate;  // of hip, knee and ankle, degrees a cycle
  double min_rise, max_rise;       // of the centre of mass, m

  void gather(std::span<const double> unknown, std::vector<double>& residual) const;
  void peaks(GaitQuantity quantity, double weight, double spare, const Samples& ours, Gathered& all) const;
};

/// Adds the excess of a curve over its target's peak and `spare`, as a fraction of that. Upward, it counts against the
/// peak of the same half of stance or of swing, so that no hump hides behind another; also downward.
void Aims::peaks(GaitQuantity quantity, double weight, double spare, const Samples& ours, Gathered& all) const {
  constexpr double each = 120;
  constexpr std::array<std::size_t, 4> part = {0, n * 3 / 10, n * 6 / 10, n};
  const Samples& target = targets.curve[index(quantity)].mean;
  const double most = *std::ranges::max_element(target), least = *std::ranges::min_element(target);
  std::array<double, 3> high;
  for (std::size_t k = 0; k < 3; ++k)
    high[k] =
        *std::max_element(target.begin() + static_cast<long>(part[k]), target.begin() + static_cast<long>(part[k + 1]));
  all.curve(each * weight, [&](std::size_t i) {
    const std::size_t k = i < part[1] ? 0 : i < part[2] ? 1 : 2;
    const double up = beyond((ours[i] - high[k]) / most, spare);
    return up + (least < -0.05 * most ? beyond((ours[i] - least) / least, spare) : 0);
  });
}

void Aims::gather(std::span<const double> unknown, std::vector<double>& residual) const {
  StepCycle c;
  StepShape shape;
  std::copy(unknown.begin(), unknown.end(), shape.begin());
  evaluate_step(task, shape, c);
  Gathered all(residual);
  const auto track = [&](GaitQuantity quantity, double weight, double min_sd, double max_sd) {
    const Target& target = targets.curve[index(quantity)];
    const Samples ours = samples_of(c, quantity);
    all.curve(weight,
              [&](std::size_t i) { return (ours[i] - target.mean[i]) / std::clamp(target.sd[i], min_sd, max_sd); });
  };
  using enum GaitQuantity;
  track(hip, weights.angles, 2.5, 2.5);
  track(knee, weights.angles, 2.2, 2.2);
  track(ankle, weights.angles, 2.2, 2.2);
  track(vertical, 4 * weights.forces, 0.04, 1);
  track(fore_aft, 3 * weights.forces, 0.015, 1);
  track(hip_moment, 1.5 * weights.moments, 0.10, 0.15);
  track(knee_moment, 1.5 * weights.moments, 0.10, 0.15);
  track(ankle_moment, 1.5 * weights.moments, 0.10, 0.15);
  peaks(vertical, weights.forces, 0.06, c.up, all);
  peaks(fore_aft, weights.forces, 0.05, c.forward, all);
  peaks(hip_moment, weights.moments, 0.04, c.hip_moment, all);
  peaks(knee_moment, weights.moments, 0.01, c.knee_moment, all);
  peaks(ankle_moment, weights.moments, 0.06, c.ankle_moment, all);
  all.curve(weights.balance, [&](std::size_t i) { return gravity * c.lacking[i]; });

  const StepBody& b = task.body;
  all.curve(200, [&](std::size_t i) {  // m
    if (c.share[i] <= 0.02) return 0.0;
    const Sole s = sole(b, c.stance_pitch[i]);
    return beyond(c.borne[i], s.front) + below(c.borne[i], s.back);
  });
  const double half_sole = 0.025 * b.height;
  all.curve(60, [&](std::size_t i) { return c.pressure_aside[i] / (half_sole / 0.045); });
  all.curve(600, [&](std::size_t i) { return beyond(std::abs(c.pressure_aside[i]), 0.9 * half_sole); });
  all.curve(2000, [&](std::size_t i) { return below(c.slack[i], 0.0012); });
  all.curve(3000, [&](std::size_t i) {
    if (!c.swings[i]) return 0.0;
    const double need = 0.0105 * std::clamp(6 * c.swung[i], 0.0, 1.0) * std::clamp(6 * (1 - c.swung[i]), 0.0, 1.0);
    return below(std::min({c.heel_clear[i], c.ball_clear[i], c.toe_clear[i]}), need);
  });
  all.curve(3, [&](std::size_t i) { return degrees * third(c.knee, i); });
  for (const Samples* moment : {&c.hip_moment, &c.knee_moment, &c.ankle_moment})
    all.curve(8, [&](std::size_t i) { return bend(*moment, i); });
  all.curve(0.5, [&](std::size_t i) { return degrees * third(c.ankle, i); });
  all.curve(0.9, [&](std::size_t i) { return degrees * third(c.pitch, i); });
  all.curve(40, [&](std::size_t i) { return bend(c.up, i); });
  all.curve(15, [&](std::size_t i) { return bend(c.total_up, i) / gravity; });
  const Samples* turning[3] = {&c.hip, &c.knee, &c.ankle};
  for (std::size_t k = 0; k < 3; ++k)
    all.curve(1.0 / 5, [&](std::size_t i) { return beyond(degrees * rate(*turning[k], i), max_rate[k]); });
  const auto [low, high] = std::ranges::minmax(c.centre_up);
  all.one(1500 * (below(high - low, min_rise) + beyond(high - low, max_rise)));
  all.curve(3000, [&](std::size_t i) { return below(c.pad_up[i], 0) + beyond(c.pad_up[i], 0.008); });
  all.curve(8000, [&](std::size_t i) { return beyond(std::abs(c.pad_forward[i]), 0.003); });
  static constexpr StepShape scale = shape_scales();
  for (std::size_t k = 0; k < step_shape::size; ++k) all.one(targets.drawn * (shape[k] - targets.likely[k]) / scale[k]);
  // Two ways of rolling give steps nearly as good, with early and with late heel rise. All nodes use one of them,
  // because a step between nodes of both ways would have neither.
  constexpr std::size_t heel_rise = step_shape::times.first + 1;
  all.one((shape[heel_rise] - first_shape(task)[heel_rise]) / scale[heel_rise]);
}

}  // namespace

Samples samples_of(const StepCycle& cycle, GaitQuantity quantity) {
  const auto in_degrees = [](Samples angle) {
    for (double& a : angle) a *= degrees;
    return angle;
  };
  switch (quantity) {
    case GaitQuantity::hip:
      return in_degrees(cycle.hip);
    case GaitQuantity::knee:
      return in_degrees(cycle.knee);
    case GaitQuantity::ankle:
      return in_degrees(cycle.ankle);
    case GaitQuantity::vertical:
      return cycle.up;
    case GaitQuantity::fore_aft:
      return cycle.forward;
    case GaitQuantity::hip_moment:
      return cycle.hip_moment;
    case GaitQuantity::knee_moment:
      return cycle.knee_moment;
    default:
      return cycle.ankle_moment;
  }
}

StepTargets step_targets(const GaitReference& reference, std::size_t of, double speed, double leg_m,
                         std::size_t without) {
  const MeasuredSet& set = reference.sets[of];
  const auto weight = class_weights(set, speed, without);
  StepTargets targets{speed, 0, 0, 0, 0, 0, excursion_at(reference, speed * std::sqrt(gravity * leg_m)), {}, {}};
  for (std::size_t c = 0; c < speed_class_count; ++c) {
    targets.step_length += weight[c] * set.step_length[c];
    targets.double_support += weight[c] * set.double_support[c];
    targets.pelvis_tilt += weight[c] * set.pelvis_tilt_deg[c] / degrees;
    targets.pelvis_rotation += weight[c] * set.pelvis_rotation_deg[c] / degrees;
    targets.pelvis_list += weight[c] * set.pelvis_list_deg[c] / degrees;
    for (std::size_t q = 0; q < gait_quantity_count; ++q) {
      const MeasuredCurve curve = set.scaled(c, static_cast<GaitQuantity>(q), leg_m);
      const Samples mean = resampled(curve.mean), sd = resampled(curve.sd);
      for (std::size_t i = 0; i < n; ++i) {
        targets.curve[q].mean[i] += weight[c] * mean[i];
        targets.curve[q].sd[i] += weight[c] * sd[i];
      }
    }
  }
  return targets;
}

Residuals step_residuals(const StepTask& task, const StepTargets& targets, const StepWeights& weights) {
  auto aims = std::make_shared<Aims>(Aims{task,
                                          targets,
                                          weights,
                                          {},
                                          targets.rise.mean_m - targets.rise.sd_m + rise_margin,
                                          targets.rise.mean_m + targets.rise.sd_m - rise_margin});
  constexpr std::array<double, 3> allowed = {1.14, 1.14, 1.42};  // of the fastest measured
  for (std::size_t q = 0; q < 3; ++q) {
    const Samples& mean = targets.curve[q].mean;
    for (std::size_t i = 0; i < n; ++i) aims->max_rate[q] = std::max(aims->max_rate[q], allowed[q] * rate(mean, i));
  }
  return [aims](std::span<const double> unknown, std::vector<double>& residual) { aims->gather(unknown, residual); };
}

}  // namespace mobil
