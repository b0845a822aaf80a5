#pragma once
// What a step is fitted to: measured curves, and what every step must keep.

#include "demo/lab/compare/compare_verdicts.h"
#include "demo/lab/gait_fit/levenberg_marquardt.h"
#include "demo/lab/gait_fit/step_model.h"

namespace mobil {

/// Mean and deviation over the cycle.
struct Target {
  Samples mean, sd;
};

/// Measured people at one speed, whose moments are those of a leg as long as the fitted one's.
struct StepTargets {
  double speed, step_length, double_support;         // over √(g · leg); of the leg; of the cycle
  double pelvis_tilt, pelvis_rotation, pelvis_list;  // rad: mean, and how far to each side
  ExcursionNorm rise;                                // of the centre of mass
  std::array<Target, gait_quantity_count> curve;     // by GaitQuantity
  StepShape likely;                                  // what the numbers of the shape are drawn to
  double drawn = 0.02;                               // how strongly, per their scale
};

/// No class of speed.
inline constexpr std::size_t none_left_out = speed_class_count;

/// Of a set at a speed between its slowest and its fastest, by cubic interpolation between classes; beyond, at its
/// ends. `without`: a class of speed between others that is left out.
StepTargets step_targets(const GaitReference& reference, std::size_t set, double speed, double leg_m,
                         std::size_t without = none_left_out);

/// A curve of the step as measured ones are published: degrees, body weights, N m/kg; the hip from the pelvis.
Samples samples_of(const StepCycle& cycle, GaitQuantity quantity);

/// How much each aim counts.
struct StepWeights {
  double angles = 1, forces = 1, moments = 1, balance = 30;
};

/// Residuals of a shape: from the targets, and of balance, clearance, reach, sole, smoothness, rates.
Residuals step_residuals(const StepTask& task, const StepTargets& targets, const StepWeights& weights);

}  // namespace mobil
