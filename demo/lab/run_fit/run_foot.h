#pragma once
// The right foot of a running step.

#include "demo/lab/run_fit/run_model.h"

namespace mobil {

/// Evaluates the foot over the cycle.
void evaluate_foot(const RunTask& task, const RunShape& shape, RunFoot& foot);

}  // namespace mobil
