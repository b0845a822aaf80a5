#pragma once
// Effect LegMuscles::activation: active muscles with elastic tendons.

#include "systems/muscles/muscle_effect.h"

namespace mobil::inline v0_3 {

extern const MuscleEffect activation_effect;

}  // namespace mobil::inline v0_3
