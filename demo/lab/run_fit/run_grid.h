#pragma once
// A table of running steps over speed and step length, fitted node by node.

#include <functional>
#include <string_view>
#include <vector>

#include <mobil/engine/jobs.h>
#include "assets/gait/run_lookup.h"
#include "demo/lab/gait_fit/step_grid.h"
#include "demo/lab/run_fit/run_quality.h"

namespace mobil {

struct RunFitNode {
  RunTask task;
  RunTargets targets;
  RunShape shape;
  double cost = 0;
};

/// Returns a node of the table that is not fitted yet.
RunFitNode run_node(std::size_t speed, std::size_t length);

/// Returns the task of a step as the table gives it, of a man whose legs have the scale `fitted_height_m`.
RunTask tabled_run_task(double speed, const TabledRun& run, std::size_t samples = run_fit_samples);

/// Fits a node without any other: angles and forces first, then balance, then moments.
void fit_run_alone(RunFitNode& node);
/// Fits a node from a neighbour's shape, whose centre of mass is first lowered until all legs reach.
void fit_run_from(const RunShape& neighbour, RunFitNode& node);

/// Fits a node of another step length from the usual step at its speed, by small changes of the length.
void fit_run_length(const RunShape& usual_one, RunFitNode& node);

/// Receives the name of a finished stage, and its sum of squares.
using RunProgress = std::function<void(std::string_view stage, double cost)>;

/// Fits all nodes, speed after speed from 2.5 m/s, and evens them. The result does not depend on the jobs.
std::vector<RunFitNode> fit_runs(const Jobs& jobs, const RunProgress& progress);
/// Fits all nodes again, drawn to the lines through their neighbours. Numbers that the aims leave free then vary
/// evenly, so that steps between nodes resemble them.
void even_runs(const Jobs& jobs, const RunProgress& progress, std::vector<RunFitNode>& nodes);

/// Convert a fitted shape to the table's units and back.
std::array<float, run_shape::size> tabled(const RunShape& fitted);
RunShape fitted(const std::array<float, run_shape::size>& tabled);

/// Returns the node of the table: the shape, and the centre of mass from the hips.
RunNode table_node(const RunFitNode& node);

}  // namespace mobil
