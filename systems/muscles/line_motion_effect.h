#pragma once
// Effect LegMuscles::line_motion: lengthening speed and moment arms of a line of action.

#include "systems/muscles/muscle_effect.h"

namespace mobil::inline v0_3 {

extern const MuscleEffect line_motion_effect;

}  // namespace mobil::inline v0_3
