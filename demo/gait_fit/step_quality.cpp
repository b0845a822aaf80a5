#include "demo/gait_fit/step_quality.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mobil {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

CycleCurve thinned(const Samples& samples) {
  CycleCurve curve{};
  constexpr std::size_t each = cycle_samples / (cycle_points - 1);
  for (std::size_t i = 0; i < cycle_points; ++i) curve[i] = samples[each * i % cycle_samples];
  return curve;
}

}  // namespace

CycleCurve published(const StepCycle& cycle, GaitQuantity quantity) {
  Samples angle{};
  const auto in_degrees = [&](auto at) {
    for (std::size_t i = 0; i < cycle_samples; ++i) angle[i] = degrees * at(i);
    return thinned(angle);
  };
  switch (quantity) {
    case GaitQuantity::hip:
      return in_degrees([&](std::size_t i) { return cycle.thigh[i] + cycle.tilt[i]; });
    case GaitQuantity::knee:
      return in_degrees([&](std::size_t i) { return cycle.knee[i]; });
    case GaitQuantity::ankle:
      return in_degrees([&](std::size_t i) { return cycle.pitch[i] - cycle.shank[i]; });
    case GaitQuantity::vertical:
      return thinned(cycle.up);
    case GaitQuantity::fore_aft:
      return thinned(cycle.forward);
    case GaitQuantity::hip_moment:
      return thinned(cycle.hip_moment);
    case GaitQuantity::knee_moment:
      return thinned(cycle.knee_moment);
    default:
      return thinned(cycle.ankle_moment);
  }
}

StepQuality step_quality(const StepTask& task, const StepTargets& targets, const StepShape& shape) {
  static thread_local StepCycle c;
  evaluate_step(task, shape, c);
  StepQuality q{};
  for (std::size_t i = 0; i < gait_quantity_count; ++i) {
    const CycleCurve ours = published(c, static_cast<GaitQuantity>(i)), theirs = thinned(targets.curve[i].mean);
    q.rms[i] = rms_distance(ours, theirs);
    q.correlation[i] = correlation(ours, theirs);
    q.rate[i] = fastest_change(ours) / fastest_change(theirs);
  }
  const auto most = [](const Samples& samples) {
    double value = 0;
    for (const double v : samples) value = std::max(value, std::abs(v));
    return value;
  };
  q.lacking_m = most(c.lacking);
  q.aside_m = most(c.pressure_aside);
  q.slack_m = std::ranges::min(c.slack);
  q.pad_m = most(c.pad_forward);
  q.clearance_m = INFINITY;
  for (std::size_t i = 0; i < cycle_samples; ++i) {
    if (c.swung[i] < 1.0 / 6 || c.swung[i] > 5.0 / 6) continue;
    q.clearance_m = std::min({q.clearance_m, c.heel_clear[i], c.ball_clear[i], c.toe_clear[i]});
  }
  const auto [low, high] = std::ranges::minmax(c.centre_up);
  q.rise_m = high - low;
  return q;
}

}  // namespace mobil
