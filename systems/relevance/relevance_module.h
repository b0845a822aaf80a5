#pragma once
// What Relevance keeps on people's rows, as a module: no system of its own; it chooses between ticks.

#include <span>

#include "engine/module.h"

namespace mobil {

/// The module; Simulation has it among its own.
Module relevance_module();
/// What a person has who is managed, for SpawnRequest::parts.
std::span<const KeyPart> relevance_parts();

}  // namespace mobil
