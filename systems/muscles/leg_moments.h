#pragma once
// The moments at a person's joints, shared among the muscles of each leg: what muscles with ExcitationSource::moments
// follow. Parts of the person's row; who has no such muscles has none of them.

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
/// Whether a person may have such muscles: moments are of who has forces, asleep too.
Result<void> check_leg_moments(const World& world, Entity person, const LegMuscles& choice);
/// Gives the person's row these parts, from its body, or takes them, as a checked choice asks.
void set_leg_moments(World& world, Entity person, const Body& body, const LegMuscles& choice);
/// The row loses these parts, if it has them.
void forget_leg_moments(World& world, Entity person);

}  // namespace mobil::inline v0_3
