#pragma once
// The effect of fat that wobbles (mobil/components/fat.h) on people: for skin in close view.

#include <span>

#include <mobil/engine/jobs.h>
#include <mobil/engine/module.h>
#include <mobil/engine/status.h>
#include <mobil/engine/world.h>
#include <mobil/systems/people/person_requests.h>

namespace mobil::inline v0_3 {

Module fat_module();

/// People, named once each, walkers and posed, have fat that wobbles, or have it no more; who is so already is left
/// alone. All or none. Errors: Status::stale_entity.
Status set_fat_wobble(World& world, const Jobs& jobs, std::span<const Entity> people, bool on);
/// Awake or asleep; false for a stale handle.
bool has_fat(const World& world, Entity person);
/// Fat that wobbles begins at rest beside the skeleton: who is posed elsewhere has jumped, who was compact is whole.
void settle_fat(World& world, Entity person);
/// A walker was put elsewhere on the ground plane: it goes along, as if the world had been moved under it.
void place_fat(World& world, Entity person, const Placing& way);

}  // namespace mobil::inline v0_3
