#pragma once
// Aims of a running step: measured curves, balance in stance and in flight, and constraints.

#include "demo/lab/gait_fit/levenberg_marquardt.h"
#include "demo/lab/run_fit/run_model.h"
#include "demo/lab/run_fit/run_targets.h"

namespace mobil {

/// Number of parameters of the motion ahead and up, which are the first; the others are those to the side.
inline constexpr std::size_t run_sagittal = run_shape::force_aside.first;

/// Weights of the aims.
struct RunWeights {
  double angles = 1, forces = 1, moments = 1.3, balance = 40, aside = 1;
  double reach = 3000, min_slack_m = 0.002;
  double likely = 0.02;  // pull toward `likely`, per scale of each number
};

/// Returns a running step's task at a speed and a step length over the usual one, and a shape to start from.
RunTask run_task(const RunTargets& targets, std::size_t samples = run_fit_samples);
RunShape first_run_shape(const RunTask& task, const RunTargets& targets);

/// Returns a curve of the step over the cycle in the units of measured ones (the first `run_compared_count`).
RunSamples samples_of(const RunCycle& cycle, RunQuantity quantity);

/// Returns residuals of the shape's first numbers, as many as the unknowns; the others are those of `likely`.
Residuals run_residuals(const RunTask& task, const RunTargets& targets, const RunWeights& weights,
                        const RunShape& likely);

}  // namespace mobil
