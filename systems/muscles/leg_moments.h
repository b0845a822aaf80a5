#pragma once
// Moments at a person's joints, shared among the muscles of each leg, for muscles with ExcitationSource::moments. The
// components are on the person's row, only if the person has such muscles.

#include <mobil/components/body.h>
#include <mobil/components/leg_muscles.h>
#include <mobil/engine/error.h>
#include <mobil/engine/module.h>
#include <mobil/engine/world.h>

namespace mobil::inline v0_3 {

Module leg_moments_module();

inline bool follows_moments(const LegMuscles& choice) {
  return choice.activation == ExcitationSource::moments;
}
/// Returns an error if a choice needs moments and the person, awake or asleep, has no forces.
Result<void> check_leg_moments(const World& world, Entity person, const LegMuscles& choice);
/// Adds these components to the person's row, from its body, or removes them, as a checked choice requires.
void set_leg_moments(World& world, Entity person, const Body& body, const LegMuscles& choice);
/// Removes these components from the row, if it has them.
void forget_leg_moments(World& world, Entity person);

}  // namespace mobil::inline v0_3
