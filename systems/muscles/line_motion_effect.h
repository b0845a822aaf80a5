#pragma once
// The effect LegMuscles::line_motion: how fast a line of action lengthens, and its moment arms.

#include "systems/muscles/muscle_effect.h"

namespace mobil::inline v0_3 {

extern const MuscleEffect line_motion_effect;

}  // namespace mobil::inline v0_3
