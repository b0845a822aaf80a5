#pragma once
// A table of steps over speed and step length, fitted node by node; and how a step changes with the posture of a
// walk, and stays in balance.

#include <functional>
#include <vector>

#include <mobil/engine/jobs.h>
#include "assets/gait/step_styles.h"
#include "assets/gait/step_table.h"
#include "demo/lab/compare/compare_reference.h"
#include "demo/lab/gait_fit/step_objective.h"

namespace mobil {

struct StepQuality {
  std::array<double, gait_quantity_count> rms, correlation, rate;  // against the targets; rate: over theirs
  double lacking_m;                                                // most that the centre of pressure is moved
  double aside_m;                                                  // most that it lies beside the feet's lines
  double slack_m;                                                  // least
  double clearance_m;                                              // least in the middle two thirds of swing
  double pad_m;                                                    // most that the heel slides
  double rise_m;                                                   // of the centre of mass
};

StepQuality step_quality(const StepTask& task, const StepTargets& targets, const StepShape& shape);

/// samples_of the step every 2 %.
CycleCurve published(const StepCycle& cycle, GaitQuantity quantity);

/// One node while it is fitted. `cost`: the least sum of squares found.
struct StepNode {
  StepTask task;
  StepTargets targets;
  StepShape shape;  // in m, of fitted_height_m
  double cost;
};

/// What nodes are fitted to: a set of a reference, perhaps without one class of its speeds.
struct FitData {
  const GaitReference* reference;
  std::size_t set = 0, without = none_left_out;
};

/// Node (speed, length) of step_table, its shape not yet fitted.
StepNode step_node(const FitData& data, std::size_t speed, std::size_t length);

/// Fits a node from a shape, at once or by way of the angles alone, and keeps what is better than it was: true then.
bool fit_node(StepNode& node, const StepShape& from, bool by_angles);

/// Fits all nodes: usual steps from a first guess and from their neighbours until none gains, the others from those,
/// and all from their neighbours. The same bits for any number of threads. `progress`: what is done, and the sum of all
/// costs.
std::vector<StepNode> fit_grid(const FitData& data, const Jobs& jobs,
                               const std::function<void(const char* stage, double cost)>& progress);

/// Between metres of fitted_height_m and a body of height 1.
TabledShape tabled(const StepShape& shape);
StepShape fitted(const TabledShape& shape);

/// By style_effects: the change of the node's shape (m, rad) for one unit of each.
using StyleChanges = std::array<StepShape, style_effects.size()>;

/// The changes that disturb the fitted step least: a step near the node's that balances as well, clears the ground and
/// is as smooth, and of which a parameter is different by a given amount; the difference, for one unit.
StyleChanges style_changes(const StepNode& node);

/// What style_effects' parameters are of, in their units, at a step. `usual` is the step that they are counted from.
std::array<double, style_effects.size()> style_values(const StepTask& task, const StepShape& usual,
                                                      const StepShape& shape);

}  // namespace mobil
