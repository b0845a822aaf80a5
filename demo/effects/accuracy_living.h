#pragma once
// The accuracy table's part of muscles that pull: people walk with each rung of their ladder, beside tissue at finite
// strain whose fibres pull (assets/finite/finite_motion.h).

#include <vector>

#include "demo/effects/accuracy_measure.h"
#include "engine/error.h"
#include "systems/relevance/accuracy_table.h"

namespace mobil {

/// As accuracy_plan: two bodies, and a shorter time, for a muscle's walk takes half a minute of a core.
AccuracyPlan living_plan();

/// Rows without inertia and with, the right leg's. Where nonlinear tissue is: its static shape as the tables are made
/// from, and what inertia adds to that on 4×4×16 elements.
Result<std::vector<AccuracyRow>> measure_living_errors(const AccuracyPlan& plan);

}  // namespace mobil
