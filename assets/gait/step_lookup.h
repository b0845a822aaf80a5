#pragma once
// The table of steps at any speed and step length.

#include <span>

#include "assets/gait/step_styles.h"

namespace mobil::inline v0_3 {

/// The walk of a body of height 1 m at a speed and a step length: its usual values, and its shape.
struct TabledStep {
  StepGiven usual;
  TabledShape shape;
};

/// Returns the step at `speed` over √(g · leg), the leg from hip to ground, and step `length` over the leg. Between
/// nodes it is a Catmull–Rom cubic in speed and linear in step length over the usual one. Below the slowest node it is
/// linear to standing at 0; beyond the fastest, and beyond the table's step lengths, it stays at their ends.
/// A mix blends the table of men with those of women and of children, with these weights.
struct StepMix {
  float woman = 0, child = 0;
};
TabledStep tabled_step(float speed, float length, const StepMix& mix = {});

/// Adds to a shape the changes by a walk's posture at that speed: the given units of each effect of step_styles.h,
/// linear between nodes.
void add_styles(float speed, std::span<const float, style_effects.size()> amounts, TabledShape& shape);

/// Returns the usual step length at a speed, over the leg. It is tabled_step's, and grows with the root of speed beyond
/// the fastest node, so that a length and a frequency each belong to one speed.
double usual_step_length(float speed);

/// Returns the usual values at a speed, as in tabled_step.
StepGiven usual_step(float speed);

}  // namespace mobil::inline v0_3
