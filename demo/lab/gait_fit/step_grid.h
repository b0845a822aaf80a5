#pragma once
// A table of steps over speed and step length, fitted node by node.

#include <functional>
#include <vector>

#include <mobil/engine/jobs.h>
#include "assets/gait/step_table.h"
#include "demo/lab/gait_fit/step_objective.h"

namespace mobil {

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

}  // namespace mobil
