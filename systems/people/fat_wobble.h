#pragma once
// Wobbling fat of people (mobil/components/fat.h), for skin in close view.

#include <span>

#include <mobil/engine/error.h>
#include <mobil/engine/jobs.h>
#include <mobil/engine/module.h>
#include <mobil/engine/world.h>
#include "systems/people/person_requests.h"

namespace mobil::inline v0_3 {

Module fat_module();

/// Switches the wobbling fat of walkers and posed people on or off; each is named once. Skips people who are in that
/// state already. Changes all or none. Errors: Status::stale_entity.
Status set_fat_wobble(World& world, const Jobs& jobs, std::span<const Entity> people, bool on);
/// Returns true if a person, awake or asleep, has wobbling fat; false for a stale handle.
bool has_fat(const World& world, Entity person);
/// Resets wobbling fat to rest relative to the skeleton, after a jump of the pose or a change from compact to full.
void settle_fat(World& world, Entity person);
/// Moves wobbling fat rigidly with a walker who was placed elsewhere on the ground plane.
void place_fat(World& world, Entity person, const Placing& way);

}  // namespace mobil::inline v0_3
