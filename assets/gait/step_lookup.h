#pragma once
// The table of steps at any speed and step length.

#include <span>

#include "assets/gait/step_styles.h"

namespace mobil::inline v0_3 {

/// The walk of a body of height 1 m at a speed and a step length: what is usual there, and its shape.
struct TabledStep {
  StepGiven usual;
  TabledShape shape;
};

/// `speed` over √(g · leg), the leg from hip to ground; `length`: of a step, over the leg. Between nodes by the cubic
/// of Catmull and Rom in speed and straight in step length over the usual one. Below the slowest node straight on to
/// standing at 0; beyond the fastest, and beyond the table's step lengths, its ends.
TabledStep tabled_step(float speed, float length);

/// Adds to a shape what the posture of a walk changes at that speed: so many units of each effect of step_styles.h,
/// straight between nodes.
void add_styles(float speed, std::span<const float, style_effects.size()> amounts, TabledShape& shape);

/// The step that people take at a speed, over the leg: tabled_step's, and beyond the fastest node growing with the root
/// of speed, so that a length and a frequency each belong to one speed.
double usual_step_length(float speed);

/// What is usual at a speed; tabled_step's.
StepGiven usual_step(float speed);

}  // namespace mobil::inline v0_3
