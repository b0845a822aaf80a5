#pragma once
// Effect LegMuscles::finite_shape: bellies show the shape of their tissue at finite strain.

#include "systems/deformation/belly_motion.h"
#include "systems/muscles/muscle_effect.h"

namespace mobil::inline v0_3 {

extern const MuscleEffect finite_shape_effect;

/// Returns true if the shown displacement is stored separately from the method's result, because that is the method's
/// state. Modal bellies are shown in place.
bool shows_apart(const MuscleKind& kind);
bool shows_apart(const Archetype& key);

/// Returns the displacement that the effect adds to the result of the belly's method under its load, and its rate of
/// change at constant activation. The method must have control points.
BellyMotion shape_offset(const NextBelly& next, float activation);

}  // namespace mobil::inline v0_3
