#pragma once
// Effect LegMuscles::inertia: gravity and the acceleration of the muscle's frame, as loads on the belly.

#include "systems/muscles/muscle_effect.h"

namespace mobil::inline v0_3 {

extern const MuscleEffect inertia_effect;

}  // namespace mobil::inline v0_3
