#pragma once
// What a simulation keeps to itself, its world's structure and what muscles share: for what is the library's own.

#include "systems/simulation.h"

namespace mobil {

struct SimulationWorld {
  static World& of(Simulation& simulation) { return *simulation.world_; }
  static BellyLibrary& library(Simulation& simulation) { return *simulation.library_; }
};

/// Whoever changes rows through it keeps people, their muscles and what choosing remembers in step.
inline World& world_of(Simulation& simulation) {
  return SimulationWorld::of(simulation);
}

}  // namespace mobil
