#pragma once
// A simulation's world with its structure open: for what is the library's own.

#include "systems/simulation.h"

namespace mobil {

struct SimulationWorld {
  static World& of(Simulation& simulation) { return *simulation.world_; }
};

/// Whoever changes rows through it keeps people, their muscles and what choosing remembers in step.
inline World& world_of(Simulation& simulation) {
  return SimulationWorld::of(simulation);
}

}  // namespace mobil
