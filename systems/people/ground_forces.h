#pragma once
// The effect of ground reaction and joint moments (components/forces.h) on one walker.

#include "engine/world.h"

namespace mobil {

/// Stale handles answer Status::stale_entity, posed people Status::missing: they have no gait that forces could follow
/// from.
Status add_forces(World& world, Entity person);
/// Status::missing, too, where they are not there.
Status remove_forces(World& world, Entity person);

}  // namespace mobil
