#pragma once
// The table of running steps at any speed and step length.

#include "assets/gait/run_table.h"

namespace mobil::inline v0_3 {

/// The run of a body of height 1 m at a speed and a step length: its given values, with the frequency of that length,
/// and its node.
struct TabledRun {
  RunGiven given;
  RunNode node;
};

/// Returns the running step at `speed` over √(g · leg), the leg from hip to ground, and a step length over the usual
/// one of that speed. It is cubic in speed (Catmull and Rom, for unequal intervals) and quadratic in step length.
/// Beyond the table it stays at its ends.
TabledRun tabled_run(double speed, double length);

/// Returns the given values of the usual run at a speed, as in tabled_run.
RunGiven usual_run(double speed);

/// Returns the usual step length at a speed, over the leg. It grows with speed.
double usual_run_length(double speed);

}  // namespace mobil::inline v0_3
