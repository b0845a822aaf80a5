#pragma once
// The effect LegMuscles::line_motion: how fast a line of action lengthens, and its moment arms.

#include "systems/muscles/muscle_effect.h"

namespace mobil {

extern const MuscleEffect line_motion_effect;

}  // namespace mobil
