#include "demo/lab/gait_fit/step_quality.h"

#include <algorithm>
#include <cmath>

namespace mobil {
namespace {

CycleCurve thinned(const Samples& samples) {
  CycleCurve curve{};
  constexpr std::size_t each = cycle_samples / (cycle_points - 1);
  for (std::size_t i = 0; i < cycle_points; ++i) curve[i] = samples[each * i % cycle_samples];
  return curve;
}

}  // namespace

CycleCurve published(const StepCycle& cycle, GaitQuantity quantity) {
  return thinned(samples_of(cycle, quantity));
}

StepQuality step_quality(const StepTask& task, const StepTargets& targets, const StepShape& shape) {
  StepCycle c;
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
