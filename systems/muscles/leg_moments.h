#pragma once
// The moments at a person's joints, shared among the muscles of each leg: what muscles with ExcitationSource::moments
// follow. Parts of the person's row; who has no such muscles has none of them.

#include "components/body.h"
#include "components/leg_muscles.h"
#include "engine/error.h"
#include "engine/module.h"
#include "engine/world.h"

namespace mobil {

Module leg_moments_module();

inline bool follows_moments(const LegMuscles& choice) {
  return choice.activation == ExcitationSource::moments;
}
/// Whether a person may have such muscles: moments are of who has forces, asleep too.
Result<void> check_leg_moments(const World& world, Entity person, const LegMuscles& choice);
/// Gives the person's row these parts, from its body, or takes them, as a checked choice asks.
void set_leg_moments(World& world, Entity person, const Body& body, const LegMuscles& choice);
/// The row loses these parts, if it has them.
void forget_leg_moments(World& world, Entity person);

}  // namespace mobil
