#pragma once
// What level of detail keeps of a person whom it manages, and the methods that its levels are.

#include <cstddef>
#include <span>

#include <mobil/components/leg_muscles.h>
#include <mobil/components/lod.h>
#include <mobil/engine/world.h>

namespace mobil::inline v0_3 {

/// What a person has who is managed by level of detail, for SpawnRequest::parts.
std::span<const KeyPart> managed_parts();
/// Whether somebody's muscles are chosen, awake or asleep.
bool is_managed(const World& world, Entity human);
/// What choosing begins from: a person's muscles, whole, and their methods. What the caller forced stays so.
Tiers<float> tiers_of(const World& world, Entity human);
/// A rung as Simulation takes it, of the ladder of muscles that pull or of others.
MuscleMethod rung_method(std::size_t rung, bool control_points, bool living = false);

}  // namespace mobil::inline v0_3
