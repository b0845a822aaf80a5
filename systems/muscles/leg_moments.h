#pragma once
// The moments at a person's joints, shared among the muscles of each leg: what muscles with ExcitationSource::moments
// follow. Parts of the person's row; who has no such muscles has none of them.

#include "components/body.h"
#include "engine/error.h"
#include "engine/module.h"
#include "engine/world.h"

namespace mobil {

Module leg_moments_module();

/// Gives the person's row what it takes, from its body, if it has not got it. Fails, and changes nothing, where it has
/// no forces (JointMoments).
Result<void> share_leg_moments(World& world, Entity person, const Body& body);
/// Whether share_leg_moments would go well.
Result<void> can_share_leg_moments(const World& world, Entity person);
/// The row loses these parts, if it has them.
void forget_leg_moments(World& world, Entity person);

}  // namespace mobil
