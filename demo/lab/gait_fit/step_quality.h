#pragma once
// How good a fitted step is.

#include <array>

#include "demo/lab/compare/compare_reference.h"
#include "demo/lab/gait_fit/step_model.h"
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

}  // namespace mobil
