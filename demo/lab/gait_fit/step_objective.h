#pragma once
// Aims of a fit: measured curves, and constraints that every step must meet.

#include "demo/lab/compare/compare_verdicts.h"
#include "demo/lab/gait_fit/levenberg_marquardt.h"
#include "demo/lab/gait_fit/step_model.h"

namespace mobil {

/// Mean and deviation over the cycle.
struct Target {
  Samples mean, sd;
};

/// Measured people at one speed. Their moments are converted to a leg as long as the fitted one.
struct StepTargets {
  double speed, step_length, double_support;         // over √(g · leg); of the leg; of the cycle
  double pelvis_tilt, pelvis_rotation, pelvis_list;  // rad: mean, and range to each side
  ExcursionNorm rise;                                // of the centre of mass
  std::array<Target, gait_quantity_count> curve;     // by GaitQuantity
  StepShape likely;                                  // values toward which the shape is pulled
  double drawn = 0.02;                               // strength of the pull, per scale of each number
};

/// No class of speed left out.
inline constexpr std::size_t none_left_out = speed_class_count;

/// Returns targets of a set at a speed between its slowest and its fastest, by cubic interpolation between classes;
/// beyond, at its ends. `without` is a class of speed between others that is left out.
StepTargets step_targets(const GaitReference& reference, std::size_t set, double speed, double leg_m,
                         std::size_t without = none_left_out);

/// Returns a curve of the step in the units of measured ones: degrees, body weights, N m/kg; the hip from the pelvis.
Samples samples_of(const StepCycle& cycle, GaitQuantity quantity);

/// Weights of the aims.
struct StepWeights {
  double angles = 1, forces = 1, moments = 1, balance = 30;
};

/// Returns residuals of a shape: from the targets, and of balance, clearance, reach, sole, smoothness, rates.
Residuals step_residuals(const StepTask& task, const StepTargets& targets, const StepWeights& weights);

}  // namespace mobil
