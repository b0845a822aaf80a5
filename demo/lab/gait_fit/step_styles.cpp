#include "demo/lab/gait_fit/step_styles.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "demo/lab/gait_fit/levenberg_marquardt.h"

namespace mobil {
namespace {

constexpr std::size_t n = cycle_samples;
constexpr double degrees = 180 / std::numbers::pi;

/// By how much each effect is changed to see what else changes: far, and to the side on which knees do not lock.
constexpr std::array<double, style_effects.size()> tried_by = {3,    5,    4,     -4,   0.01, 6, 3,
                                                               0.01, 0.01, -0.05, -0.2, 0.1,  5, 1};
constexpr double insistence = 30;

/// Instants of the usual step at which its manner is read, so that values change smoothly with the shape.
struct Instants {
  std::size_t toe_off, mid_swing, release;
  std::size_t loaded;              // greatest knee flexion of early stance
  std::size_t straightest;         // least one after that, before the heel rises
  std::size_t most_bent;           // of the knee, in swing
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
  i.most_bent = greatest(c.knee, off, 0.95);
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
  if (of == &Style::swing_knee_deg) return degrees * c.knee[i.most_bent];
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
  StepNode own = node;  // what is to stay is the step itself
  StepCycle usual;
  evaluate_step(node.task, node.shape, usual);
  for (std::size_t q = 0; q < gait_quantity_count; ++q)
    own.targets.curve[q].mean = samples_of(usual, static_cast<GaitQuantity>(q));
  own.targets.rise.sd_m = own.targets.rise.mean_m;  // how far the hips fall may change
  const Residuals step = step_residuals(own.task, own.targets, {.angles = 0.3, .forces = 0.3, .moments = 0.1});
  std::vector<double> kept;  // no step lacks nothing: what the node lacks may stay
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
    least_squares(asked, scales, {.most_steps = 40, .least_gain = 1e-4}, shape);
    const double reached = style_values(node.task, node.shape, shape)[e] - before[e];
    for (std::size_t i = 0; i < shape.size(); ++i) changes[e][i] = (shape[i] - node.shape[i]) / reached;
  }
  return changes;
}

}  // namespace mobil
