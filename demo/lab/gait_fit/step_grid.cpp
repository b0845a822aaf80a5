#include "demo/lab/gait_fit/step_grid.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <mobil/components/gait.h>
#include <mobil/components/step_plan.h>
#include "demo/lab/gait_fit/levenberg_marquardt.h"

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
constexpr double evenness = 0.15;  // pull of nodes towards their neighbours, per scale of each number

double solve(const StepNode& node, const StepWeights& weights, int max_steps, StepShape& shape) {
  static constexpr StepShape scales = shape_scales();
  return least_squares(step_residuals(node.task, node.targets, weights), scales, {max_steps}, shape);
}

bool keep(StepNode& node, const StepShape& shape, double cost) {
  if (!(cost < 0.999 * node.cost)) return false;
  node.shape = shape;
  node.cost = cost;
  return true;
}

/// Fits in stages, first mostly the angles: a direct fit hardly leaves an almost straight knee.
double by_way_of_angles(const StepNode& node, StepShape& shape) {
  solve(node, {.angles = 1, .forces = 0.1, .moments = 0.03, .balance = 1}, 60, shape);
  solve(node, {.angles = 1, .forces = 0.5, .moments = 0.3, .balance = 8}, 60, shape);
  return solve(node, {}, 250, shape);
}

/// Returns the mean of a node's neighbours in speed and in step length, for each of these with neighbours on both
/// sides; without any, the node's own shape.
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

constexpr std::size_t n = cycle_samples;
constexpr double degrees = 180 / std::numbers::pi;

/// Change of each effect by which side effects are found: large, and to the side on which knees do not lock.
constexpr std::array<double, style_effects.size()> tried_by = {3,    5,    4,     -4,   0.01, 6, 3,
                                                               0.01, 0.01, -0.05, -0.2, 0.1,  5, 1};
constexpr double insistence = 30;

/// Instants of the usual step at which its posture is read, so that values change smoothly with the shape.
struct Instants {
  std::size_t toe_off, mid_swing, release;
  std::size_t loaded;              // greatest knee flexion of early stance
  std::size_t straightest;         // minimum after that, before the heel rises
  std::size_t max_bent;            // maximum, of the knee, in swing
  std::size_t highest, lowest;     // of the hips
  std::size_t single, end_single;  // support on this foot: from, to
};

std::size_t at(double cycle) {
  return static_cast<std::size_t>(std::lround(cycle * static_cast<double>(n)));
}

std::size_t greatest(const Samples& of, double from, double to) {
  const auto first = of.begin() + static_cast<long>(at(from)), last = of.begin() + static_cast<long>(at(to));
  return static_cast<std::size_t>(std::max_element(first, last) - of.begin());
}
std::size_t least(Samples of, double from, double to) {
  for (double& value : of) value = -value;
  return greatest(of, from, to);
}

Instants instants(const StepTask& task, const StepCycle& c) {
  const double off = 0.5 + task.double_support;
  Instants i{};
  i.toe_off = at(off);
  i.mid_swing = at(0.5 * (off + 1));
  i.release = at(0.53);
  i.loaded = greatest(c.knee, 0.06, 0.22);
  i.straightest = least(c.knee, 0.22, 0.46);
  i.max_bent = greatest(c.knee, off, 0.95);
  i.highest = greatest(c.hips_up, 0, 0.5);
  i.lowest = least(c.hips_up, 0, 0.5);
  i.single = at(task.double_support);
  i.end_single = at(0.5);
  return i;
}

double style_value(const StepTask& task, const StepShape& shape, const StepCycle& usual, const StepCycle& c,
                   const Instants& i, float GaitStyle::*of) {
  using Style = GaitStyle;
  const auto pressure = [&](std::size_t k) { return c.pressure[k] + c.lacking[k]; };
  if (of == &Style::strike_pitch_deg) return degrees * c.pitch[0];
  if (of == &Style::strike_knee_deg) return degrees * c.knee[0];
  if (of == &Style::stance_knee_deg) return degrees * c.knee[i.straightest];
  if (of == &Style::toe_off_knee_deg) return degrees * c.knee[i.toe_off];
  if (of == &Style::knee_release_cycle) {
    const double rate = (usual.knee[i.release + 1] - usual.knee[i.release - 1]) * 0.5 * static_cast<double>(n);
    return -c.knee[i.release] / rate;
  }
  if (of == &Style::swing_knee_deg) return degrees * c.knee[i.max_bent];
  if (of == &Style::swing_ankle_deg) return degrees * c.ankle[i.mid_swing];
  if (of == &Style::toe_clearance_m) return c.toe_clear[i.mid_swing];
  if (of == &Style::foot_pivot_h) {
    double sum = 0;
    for (std::size_t k = i.single; k < i.end_single; ++k) sum += pressure(k);
    return sum / static_cast<double>(i.end_single - i.single) / task.body.height;
  }
  if (of == &Style::hip_fall) {
    const double straight = task.body.leg - std::sqrt(std::pow(task.body.leg, 2) - std::pow(task.step_length_m / 2, 2));
    return (c.hips_up[i.highest] - c.hips_up[i.lowest]) / straight;
  }
  if (of == &Style::leg_damping)
    return (c.knee[i.loaded] - c.knee[0]) / std::max(usual.knee[i.loaded] - usual.knee[0], 3 / degrees);
  if (of == &Style::roll_over)
    return (pressure(i.end_single - 1) - pressure(i.single)) /
           (c.hips_forward[i.end_single - 1] - c.hips_forward[i.single]);
  if (of == &Style::trunk_lean_deg) return degrees * shape[step_shape::trunk.first];
  // trunk_stiffness: along the usual sway
  double along = 0, square = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const double usual_sway = usual.trunk[k] - usual.trunk[(k + n / 4) % n];
    along += usual_sway * (c.trunk[k] - c.trunk[(k + n / 4) % n]);
    square += usual_sway * usual_sway;
  }
  return along / square;
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
  const StepBody body = step_body(data.kind, fitted_height_m);
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
  node.targets.rise.mean_m *= times * times;  // as for a leg of fixed length
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
  /// Fits every node from the nodes that `from` lists, in the shapes they had before.
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
  for (std::size_t away = 1; away < std::max(usual + 1, length_count - usual); ++away) {
    stage("shorter and longer steps", true, [&](std::size_t, std::size_t l) {
      if (l + away == usual) return Others{{0, 1}};
      return l == usual + away ? Others{{0, -1}} : Others{};
    });
  }
  for (int times = 0; times < 2; ++times)
    stage("all from their neighbours", false, [](std::size_t, std::size_t) {
      return Others{{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    });
  // Numbers that the aims leave free vary evenly between nodes, so that steps between nodes resemble them.
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

TabledShape tabled(const StepShape& shape) {
  return tabled(shape, step_shape::parts);
}

StepShape fitted(const TabledShape& shape) {
  return fitted(shape, step_shape::parts);
}

std::array<double, style_effects.size()> style_values(const StepTask& task, const StepShape& usual_shape,
                                                      const StepShape& shape) {
  StepCycle usual, cycle;
  evaluate_step(task, usual_shape, usual);
  evaluate_step(task, shape, cycle);
  const Instants i = instants(task, usual);
  std::array<double, style_effects.size()> values{};
  for (std::size_t k = 0; k < values.size(); ++k)
    values[k] = style_value(task, shape, usual, cycle, i, style_effects[k].parameter);
  return values;
}

StyleChanges style_changes(const StepNode& node) {
  StepNode own = node;  // the step itself is kept
  StepCycle usual;
  evaluate_step(node.task, node.shape, usual);
  for (std::size_t q = 0; q < gait_quantity_count; ++q)
    own.targets.curve[q].mean = samples_of(usual, static_cast<GaitQuantity>(q));
  own.targets.rise.sd_m = own.targets.rise.mean_m;  // the fall of the hips can change
  const Residuals step = step_residuals(own.task, own.targets, {.angles = 0.3, .forces = 0.3, .moments = 0.1});
  std::vector<double> kept;  // every step has residuals: those of the node can stay
  step(node.shape, kept);
  const auto before = style_values(node.task, node.shape, node.shape);
  const Instants at = instants(node.task, usual);
  static constexpr StepShape scales = shape_scales();
  StyleChanges changes{};
  for (std::size_t e = 0; e < changes.size(); ++e) {
    const double by = tried_by[e];
    StepCycle cycle;
    const Residuals asked = [&](std::span<const double> unknown, std::vector<double>& residual) {
      step(unknown, residual);
      for (std::size_t i = 0; i < kept.size(); ++i) residual[i] -= kept[i];
      StepShape shape;
      std::copy(unknown.begin(), unknown.end(), shape.begin());
      evaluate_step(node.task, shape, cycle);
      const double now = style_value(node.task, shape, usual, cycle, at, style_effects[e].parameter);
      residual.push_back(insistence * ((now - before[e]) / by - 1));
    };
    StepShape shape = node.shape;
    least_squares(asked, scales, {.max_steps = 40, .min_gain = 1e-4}, shape);
    const double reached = style_values(node.task, node.shape, shape)[e] - before[e];
    for (std::size_t i = 0; i < shape.size(); ++i) changes[e][i] = (shape[i] - node.shape[i]) / reached;
  }
  return changes;
}

}  // namespace mobil
