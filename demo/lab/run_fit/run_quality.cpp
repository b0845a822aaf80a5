#include "demo/lab/run_fit/run_quality.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "demo/lab/compare/compare_reference.h"

namespace mobil {
namespace {

using namespace geometry;

constexpr std::size_t judged_points = run_points - 1;  // the last point repeats the first
constexpr double in_degrees = 180 / std::numbers::pi;

RunSamples thinned_run(const RunSamples& samples) {
  RunSamples out(judged_points);
  for (std::size_t i = 0; i < judged_points; ++i) out[i] = samples[i * samples.size() / judged_points];
  return out;
}

RunMatch match_of(const RunSamples& ours, const RunSamples& mean, const RunSamples& sd) {
  const auto n = static_cast<double>(ours.size());
  double a = 0, b = 0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    a += ours[i] / n;
    b += mean[i] / n;
  }
  double ab = 0, aa = 0, bb = 0, square = 0;
  std::size_t inside = 0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    ab += (ours[i] - a) * (mean[i] - b);
    aa += (ours[i] - a) * (ours[i] - a);
    bb += (mean[i] - b) * (mean[i] - b);
    square += (ours[i] - mean[i]) * (ours[i] - mean[i]);
    inside += std::abs(ours[i] - mean[i]) <= sd[i] ? 1 : 0;
  }
  const auto [low, high] = std::ranges::minmax(ours);
  const auto [low_measured, high_measured] = std::ranges::minmax(mean);
  return {std::sqrt(square / n), ab / std::sqrt(aa * bb), static_cast<double>(inside) / n, high, high_measured, low,
          low_measured};
}

/// Root mean square and greatest amount.
struct Amount {
  double squares = 0, count = 0, most = 0;
  void add(double value) {
    squares += value * value;
    ++count;
    most = std::max(most, std::abs(value));
  }
  double rms() const { return std::sqrt(squares / count); }
};

/// Returns the greatest force on the segments in flight, body weights, by differences over the interval.
double force_in_flight(const RunModel& model) {
  const RunTask& task = model.task();
  const std::size_t half = task.samples / 2;
  const BodyParts& parts = task.body.parts;
  RunVectors centre(half, {0, 0, 0});
  for (std::size_t i = 0; i < half; ++i) {
    const RunPose pose = model.pose(i);
    for (std::size_t s = 0; s < segment_count; ++s)
      centre[i] = centre[i] + parts.mass[s] * (pose.position[s] + rotated(pose.rotation[s], parts.centre_of_mass[s]));
  }
  const double interval = 2 / (task.frequency_hz * static_cast<double>(task.samples));
  double most = 0;
  for (std::size_t i = 1; i + 1 < half; ++i) {
    if (static_cast<double>(i - 1) < task.duty * static_cast<double>(task.samples)) continue;
    const Vec3<double> force = (1 / (interval * interval)) * (centre[i + 1] - 2 * centre[i] + centre[i - 1]) +
                               Vec3<double>{0, gravity_m_s2, 0};
    most = std::max(most, length(force) / gravity_m_s2);
  }
  return most;
}

void judge_balance(const RunTask& task, const RunCycle& cycle, RunQuality& q) {
  const auto& s = cycle.step;
  Amount pitch, roll, yaw, free;
  const std::size_t half = s.yaw.size();
  for (std::size_t i = 0; i < half; ++i) {
    pitch.add(s.pitch_lacking[i]);
    roll.add(s.roll_lacking[i]);
    const bool flies = static_cast<double>(i) >= 2 * task.duty * static_cast<double>(half);
    (flies ? yaw : free).add(s.yaw[i]);
    q.error_m = std::max(q.error_m, s.error[i]);
    if (s.force[i].y <= 0.3) continue;
    q.outside_m = std::max({q.outside_m, s.wanted[i] - s.front[i], s.back[i] - s.wanted[i]});
    q.aside_m = std::max(q.aside_m, std::abs(s.aside[i]));
  }
  q.pitch_rms = pitch.rms();
  q.pitch_max = pitch.most;
  q.roll_rms = roll.rms();
  q.roll_max = roll.most;
  q.yaw_flight_rms = yaw.rms();
  q.yaw_flight_max = yaw.most;
  q.free_rms = free.rms();
  q.free_max = free.most;
}

void judge_limits(const RunCycle& cycle, RunQuality& q) {
  const auto most = [](const RunSamples& samples) {
    double value = 0;
    for (const double v : samples) value = std::max(value, std::abs(v));
    return value;
  };
  const RunFoot& foot = cycle.foot;
  q.clearance_m = q.sink_m = INFINITY;
  for (std::size_t i = 0; i < foot.clear.size(); ++i) {
    if (foot.swung[i] <= 0) continue;
    q.sink_m = std::min(q.sink_m, foot.clear[i]);
    if (foot.swung[i] > 1.0 / 6 && foot.swung[i] < 5.0 / 6) q.clearance_m = std::min(q.clearance_m, foot.clear[i]);
  }
  q.slack_m = std::ranges::min(cycle.cycle.slack);
  q.pad_max_m = std::ranges::max(foot.pad_up);
  q.pad_min_m = std::ranges::min(foot.pad_up);
  q.slide_m = most(foot.pad_forward);
  const auto [low, high] = std::ranges::minmax(cycle.step.centre, {}, &Vec3<double>::y);
  q.rise_m = high.y - low.y;
  const RunSamples& lean = cycle.step.trunk;
  const auto [least, greatest] = std::ranges::minmax(lean);
  q.lean_range_deg = in_degrees * (greatest - least);
  for (const double l : lean) q.lean_deg += in_degrees * l / static_cast<double>(lean.size());
  q.side_lean_deg = in_degrees * most(cycle.step.side_lean);
  q.shoulders_deg = in_degrees * most(cycle.step.shoulders);
  for (const Vec3<double>& hips : cycle.cycle.hips) q.hips_aside_m = std::max(q.hips_aside_m, std::abs(hips.x));
}

}  // namespace

RunQuality run_quality(const RunTask& coarse, const RunTargets& targets, const std::optional<RunMeasured>& measured,
                       const RunShape& shape) {
  RunTask task = coarse;
  task.samples = run_judged_samples;
  RunModel model(task);
  RunCycle cycle;
  model.evaluate(shape, cycle);
  RunQuality q{};
  const auto mean_of = [&](RunQuantity of) {
    if (!measured) return thinned_run(targets.curve[index(of)].mean);
    const auto& curve = measured->curve[index(of)].mean;
    return RunSamples(curve.begin(), curve.end() - 1);
  };
  for (std::size_t k = 0; k < run_compared_count; ++k) {
    const auto of = static_cast<RunQuantity>(k);
    RunSamples sd = thinned_run(targets.curve[k].sd);
    if (measured) sd.assign(measured->curve[k].sd.begin(), measured->curve[k].sd.end() - 1);
    q.match[k] = match_of(thinned_run(samples_of(cycle, of)), mean_of(of), sd);
  }
  RunSamples height;
  for (const Vec3<double>& hips : cycle.cycle.hips) height.push_back(hips.y);
  height = thinned_run(height);
  double mean = 0;
  for (const double h : height) mean += h / static_cast<double>(height.size());
  const RunSamples theirs = mean_of(RunQuantity::hip_height);
  Amount off;
  for (std::size_t i = 0; i < height.size(); ++i) off.add(height[i] - mean - task.body.size.leg * theirs[i]);
  q.hips_rms_m = off.rms();
  judge_balance(task, cycle, q);
  judge_limits(cycle, q);
  q.flight_force = force_in_flight(model);
  return q;
}

}  // namespace mobil
