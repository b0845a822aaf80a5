#pragma once
// Write access to a simulation's rows, for tests only: reproduces a broken host or a fault of the library.

#include <mobil/engine/world.h>
#include <mobil/simulation.h>

namespace mobil {

inline World& world_of(Simulation& simulation) {
  return const_cast<World&>(simulation.world());
}

}  // namespace mobil
