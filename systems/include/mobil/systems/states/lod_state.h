#pragma once
// What level of detail keeps of a person whom it manages, and the methods that its levels are.

#include <cstddef>
#include <span>

#include <mobil/components/leg_muscles.h>
#include <mobil/components/lod.h>
#include <mobil/engine/world.h>

namespace mobil::inline v0_3 {

/// What a person has who is managed by level of detail, for SpawnRequest::parts.
std::span<const ComponentId> managed_parts();
/// Whether somebody's muscles are chosen, awake or asleep.
bool is_managed(const World& world, Entity person);
/// What choosing begins from: a person's muscles, whole, and their methods. What the caller forced stays so.
LodState<float> lod_state_of(const World& world, Entity person);
/// A level as Simulation takes it, of the lod_table of muscles that pull or of others.
MuscleMethod level_method(std::size_t level, bool control_points, bool active = false);

}  // namespace mobil::inline v0_3
