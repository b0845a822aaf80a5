#pragma once
// What Relevance keeps on people's rows, as a module: no system of its own; it chooses between ticks.

#include <span>

#include <mobil/components/relevance.h>
#include <mobil/engine/module.h>
#include <mobil/engine/world.h>

namespace mobil::inline v0_3 {

/// The module; Simulation has it among its own.
Module relevance_module();
/// What a person has who is managed, for SpawnRequest::parts.
std::span<const KeyPart> relevance_parts();
/// What choosing begins from: a person's muscles, whole, and their methods. What the caller forced stays so.
Tiers<float> tiers_of(const World& world, Entity human);

}  // namespace mobil::inline v0_3
