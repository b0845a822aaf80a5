#pragma once
// Interfaces of a simulation (avoidance, terrain, …) with options that a test chooses.

#include <gtest/gtest.h>

#include <utility>

#include <mobil/avoidance.h>
#include <mobil/lod.h>
#include <mobil/simulation.h>
#include <mobil/terrain.h>

namespace mobil {

inline Lod lod_of(Simulation& simulation, const LodOptions& options) {
  Lod lod = simulation.lod();
  EXPECT_TRUE(lod.set_options(options));
  return lod;
}

inline Avoidance avoidance_of(Simulation& simulation, const AvoidanceOptions& options) {
  Avoidance avoidance = simulation.avoidance();
  avoidance.set_options(options);
  return avoidance;
}

inline Terrain terrain_of(Simulation& simulation, TerrainHeights heights, const TerrainOptions& options = {}) {
  Terrain terrain = simulation.terrain();
  terrain.set_heights(std::move(heights));
  terrain.set_options(options);
  return terrain;
}

}  // namespace mobil
