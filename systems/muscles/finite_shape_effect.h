#pragma once
// The effect LegMuscles::finite_shape: bellies look as their tissue does at finite strain.

#include "systems/deformation/belly_motion.h"
#include "systems/muscles/muscle_effect.h"

namespace mobil::inline v0_3 {

extern const MuscleEffect finite_shape_effect;

/// Whether what is shown lies apart from what the method computes: where that is the method's state. Modal bellies
/// are shown in place.
bool shows_apart(const MuscleKind& kind);
bool shows_apart(const Archetype& key);

/// What the effect adds to what the belly's method (one with control points) computes under its load, and how fast that
/// changes as long as activation stays.
BellyMotion shape_offset(const NextBelly& next, float activation);

}  // namespace mobil::inline v0_3
