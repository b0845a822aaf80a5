#pragma once
// The rows of a simulation, to be written in tests alone: what only a broken host or a fault of the library could do.

#include <mobil/engine/world.h>
#include <mobil/simulation.h>

namespace mobil {

inline World& world_of(Simulation& simulation) {
  return const_cast<World&>(simulation.world());
}

}  // namespace mobil
