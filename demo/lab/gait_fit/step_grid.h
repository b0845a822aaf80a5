#pragma once
// A table of steps over speed and step length, fitted node by node; and changes of a step with the posture of a walk,
// in balance.

#include <functional>
#include <vector>

#include <mobil/engine/jobs.h>
#include "assets/gait/step_styles.h"
#include "assets/gait/step_table.h"
#include "demo/lab/compare/compare_reference.h"
#include "demo/lab/gait_fit/step_objective.h"

namespace mobil {

struct StepQuality {
  std::array<double, gait_quantity_count> rms, correlation, rate;  // against the targets; rate: relative to theirs
  double lacking_m;                                                // maximum shift of the centre of pressure
  double aside_m;                                                  // its maximum distance from the feet's lines
  double slack_m;                                                  // minimum
  double clearance_m;                                              // minimum in the middle two thirds of swing
  double pad_m;                                                    // maximum slide of the heel
  double rise_m;                                                   // of the centre of mass
};

StepQuality step_quality(const StepTask& task, const StepTargets& targets, const StepShape& shape);

/// Returns samples_of the step every 2 %.
CycleCurve published(const StepCycle& cycle, GaitQuantity quantity);

/// One node during its fit. `cost` is the smallest sum of squares found.
struct StepNode {
  StepTask task;
  StepTargets targets;
  StepShape shape;  // in m, of fitted_height_m
  double cost;
};

/// Input of a fit: a set of a reference, optionally without one of its speed classes.
struct FitData {
  const GaitReference* reference;
  StepKind kind = StepKind::man;
  std::size_t set = 0, without = none_left_out;
};

/// Returns node (speed, length) of step_table, with its shape not yet fitted.
StepNode step_node(const FitData& data, std::size_t speed, std::size_t length);

/// Fits a node from a shape, directly or first by the angles. Keeps the result and returns true if it is better.
bool fit_node(StepNode& node, const StepShape& from, bool by_angles);

/// Fits all nodes. Usual steps start from a first guess and from their neighbours, until none improves; the others
/// start from those, and then all from their neighbours. Bits are the same for any number of threads. `progress`
/// receives the stage, and the sum of all costs.
std::vector<StepNode> fit_grid(const FitData& data, const Jobs& jobs,
                               const std::function<void(const char* stage, double cost)>& progress);

/// Convert numbers of these groups between metres of fitted_height_m and a body of height 1.
template <std::size_t numbers, std::size_t groups>
std::array<float, numbers> tabled(const std::array<double, numbers>& shape,
                                  const std::array<ShapePart, groups>& parts) {
  std::array<float, numbers> out{};
  for (const ShapePart& part : parts) {
    for (std::size_t i = part.first; i < part.first + part.count; ++i)
      out[i] = static_cast<float>(part.is_length ? shape[i] / fitted_height_m : shape[i]);
  }
  return out;
}
template <std::size_t numbers, std::size_t groups>
std::array<double, numbers> fitted(const std::array<float, numbers>& shape,
                                   const std::array<ShapePart, groups>& parts) {
  std::array<double, numbers> out{};
  for (const ShapePart& part : parts) {
    for (std::size_t i = part.first; i < part.first + part.count; ++i)
      out[i] = static_cast<double>(shape[i]) * (part.is_length ? fitted_height_m : 1);
  }
  return out;
}
TabledShape tabled(const StepShape& shape);
StepShape fitted(const TabledShape& shape);

/// For each of style_effects, the change of the node's shape (m, rad) for one unit.
using StyleChanges = std::array<StepShape, style_effects.size()>;

/// Returns the changes that disturb the fitted step least, for one unit each. The changed step is near the node's,
/// balances as well, clears the ground, is as smooth, and differs by a given amount in one parameter.
StyleChanges style_changes(const StepNode& node);

/// Returns the values of style_effects' parameters at a step, in their units, relative to the step `usual`.
std::array<double, style_effects.size()> style_values(const StepTask& task, const StepShape& usual,
                                                      const StepShape& shape);

}  // namespace mobil
