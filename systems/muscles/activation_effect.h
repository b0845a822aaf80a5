#pragma once
// The effect LegMuscles::activation: muscles that pull, with elastic tendons.

#include "systems/muscles/muscle_effect.h"

namespace mobil {

extern const MuscleEffect activation_effect;

}  // namespace mobil
