#include "demo/lab/gait_fit/step_grid.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <mobil/components/gait_style.h>

namespace mobil {
namespace {

CycleCurve thinned(const Samples& samples) {
  CycleCurve curve{};
  constexpr std::size_t each = cycle_samples / (cycle_points - 1);
  for (std::size_t i = 0; i < cycle_points; ++i) curve[i] = samples[each * i % cycle_samples];
  return curve;
}

using namespace step_table;

constexpr double degree = std::numbers::pi / 180;
constexpr double evenness = 0.15;  // how strongly nodes are drawn to their neighbours', per scale of each number

double solve(const StepNode& node, const StepWeights& weights, int most_steps, StepShape& shape) {
  static constexpr StepShape scales = shape_scales();
  return least_squares(step_residuals(node.task, node.targets, weights), scales, {most_steps}, shape);
}

bool keep(StepNode& node, const StepShape& shape, double cost) {
  if (!(cost < 0.999 * node.cost)) return false;
  node.shape = shape;
  node.cost = cost;
  return true;
}

/// Straight at the last fit; a knee that is almost straight is hard to leave, so first the angles alone.
double by_way_of_angles(const StepNode& node, StepShape& shape) {
  solve(node, {.angles = 1, .forces = 0.1, .moments = 0.03, .balance = 1}, 60, shape);
  solve(node, {.angles = 1, .forces = 0.5, .moments = 0.3, .balance = 8}, 60, shape);
  return solve(node, {}, 250, shape);
}

/// The mean of a node's neighbours on either side, in speed and in step length where it has both; its own shape where
/// it has neither.
StepShape between_neighbours(const std::vector<StepNode>& nodes, std::size_t i) {
  const std::size_t s = i / length_count, l = i % length_count;
  StepShape sum{};
  double count = 0;
  const auto add = [&](std::size_t low, std::size_t high) {
    for (const std::size_t other : {low, high}) {
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += nodes[other].shape[k];
      ++count;
    }
  };
  if (s > 0 && s + 1 < speed_count) add(i - length_count, i + length_count);
  if (l > 0 && l + 1 < length_count) add(i - 1, i + 1);
  if (count == 0) return nodes[i].shape;
  for (double& number : sum) number /= count;
  return sum;
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

StepNode step_node(const FitData& data, std::size_t speed_number, std::size_t length_number) {
  const StepBody body = step_body(fitted_height_m);
  StepNode node{{}, step_targets(*data.reference, data.set, speed[speed_number], body.leg, data.without), {}, INFINITY};
  const double times = length[length_number];
  const GaitStyle style;
  StepTask& task = node.task;
  task.body = body;
  task.speed_m_s = node.targets.speed * std::sqrt(gravity_m_s2 * body.leg);
  task.step_length_m = times * node.targets.step_length * body.leg;
  task.double_support = node.targets.double_support;
  task.half_width_m = 0.5 * static_cast<double>(style.step_width_h) * body.height;
  task.toe_out = static_cast<double>(style.toe_out_deg) * degree;
  task.pelvis_rotation = node.targets.pelvis_rotation * times;
  task.pelvis_list = node.targets.pelvis_list;
  task.pelvis_tilt = node.targets.pelvis_tilt;
  task.pelvis_tilt_wave = static_cast<double>(style.pelvis_tilt_wave_deg) * degree;
  const double stride = task.step_length_m / (natural_step_h * body.height);
  const double swinging = std::min(arm_swing::by_speed * node.targets.speed, 1.0) * std::min(stride, 1.25);
  const double reach = std::max(0.5 * task.step_length_m / (body.thigh + body.shank), 0.15);
  task.leg_back = -arm_swing::reach_back * reach;
  task.leg_forward = reach;
  task.arm_back = swinging * static_cast<double>(style.arm_back_deg) * degree;
  task.arm_forward = swinging * static_cast<double>(style.arm_forward_deg) * degree;
  task.elbow_back = static_cast<double>(style.elbow_back_deg) * degree;
  task.elbow_forward =
      task.elbow_back + swinging * static_cast<double>(style.elbow_forward_deg - style.elbow_back_deg) * degree;
  node.targets.rise.mean_m *= times * times;  // as of a leg of fixed length
  node.shape = node.targets.likely = first_shape(task);
  return node;
}

bool fit_node(StepNode& node, const StepShape& from, bool by_angles) {
  StepShape shape = from;
  const double cost = by_angles ? by_way_of_angles(node, shape) : solve(node, {}, 250, shape);
  return keep(node, shape, cost);
}

std::vector<StepNode> fit_grid(const FitData& data, const Jobs& jobs,
                               const std::function<void(const char* stage, double cost)>& progress) {
  std::vector<StepNode> nodes;
  for (std::size_t s = 0; s < speed_count; ++s) {
    for (std::size_t l = 0; l < length_count; ++l) nodes.push_back(step_node(data, s, l));
  }
  /// Fits every node for which `from` names others, from all of these as they were before.
  const auto stage = [&](const char* name, bool by_angles, auto from) {
    const std::vector<StepNode> before = nodes;
    std::vector<char> gained(nodes.size());
    in_parallel(jobs, nodes.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        for (const auto& [speed_off, length_off] : from(i / length_count, i % length_count)) {
          const auto s = static_cast<std::size_t>(static_cast<long>(i / length_count) + speed_off);
          const auto l = static_cast<std::size_t>(static_cast<long>(i % length_count) + length_off);
          if (s >= speed_count || l >= length_count) continue;
          const StepShape& start = before[s * length_count + l].shape;
          if (fit_node(nodes[i], start, false)) gained[i] = 1;
          if (by_angles && fit_node(nodes[i], start, true)) gained[i] = 1;
        }
      }
    });
    double cost = 0;
    for (const StepNode& node : nodes) cost += std::isfinite(node.cost) ? node.cost : 0;
    progress(name, cost);
    return std::ranges::any_of(gained, [](char c) { return c != 0; });
  };
  using Others = std::vector<std::pair<long, long>>;
  stage("usual steps", true, [](std::size_t, std::size_t l) { return l == usual ? Others{{0, 0}} : Others{}; });
  for (std::size_t times = 0; times < speed_count; ++times) {
    const bool gained = stage("usual steps from their neighbours", true, [](std::size_t, std::size_t l) {
      return l == usual ? Others{{-1, 0}, {1, 0}} : Others{};
    });
    if (!gained) break;
  }
  for (std::size_t away = 1; away <= usual; ++away) {
    stage("shorter and longer steps", true, [&](std::size_t, std::size_t l) {
      if (l + away == usual) return Others{{0, 1}};
      return l == usual + away ? Others{{0, -1}} : Others{};
    });
  }
  for (int times = 0; times < 2; ++times)
    stage("all from their neighbours", false, [](std::size_t, std::size_t) {
      return Others{{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    });
  // Numbers that the aims leave free go evenly from node to node, so that steps between nodes are like them.
  for (int times = 0; times < 4; ++times) {
    const std::vector<StepNode> before = nodes;
    in_parallel(jobs, nodes.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        StepNode& node = nodes[i];
        node.targets.likely = between_neighbours(before, i);
        node.targets.drawn = evenness;
        node.cost = solve(node, {}, 100, node.shape);
      }
    });
    double cost = 0;
    for (const StepNode& node : nodes) cost += node.cost;
    progress("even", cost);
  }
  return nodes;
}

TabledShape tabled(const StepShape& fitted) {
  TabledShape out{};
  for (const ShapePart& part : step_shape::parts) {
    for (std::size_t i = part.first; i < part.first + part.count; ++i)
      out[i] = static_cast<float>(part.is_length ? fitted[i] / fitted_height_m : fitted[i]);
  }
  return out;
}

StepShape fitted(const TabledShape& tabled) {
  StepShape out{};
  for (const ShapePart& part : step_shape::parts) {
    for (std::size_t i = part.first; i < part.first + part.count; ++i)
      out[i] = static_cast<double>(tabled[i]) * (part.is_length ? fitted_height_m : 1);
  }
  return out;
}

}  // namespace mobil
