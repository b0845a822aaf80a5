#pragma once
// One walker on a given terrain.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <utility>

#include <mobil/forces.h>
#include <mobil/simulation.h>
#include <mobil/terrain.h>
#include "tests/interfaces.h"

namespace mobil {

using HeightOf = std::function<TerrainHeight(float, float)>;

inline TerrainHeights answering(HeightOf ground) {
  return [ground = std::move(ground)](std::span<const TerrainQuery> at, std::span<TerrainHeight> out) {
    for (std::size_t i = 0; i < at.size(); ++i) out[i] = ground(at[i].x_m, at[i].z_m);
  };
}

inline HeightOf plane(float rise_x, float rise_z) {
  return [=](float x, float z) { return TerrainHeight{rise_x * x + rise_z * z, rise_x, rise_z}; };
}

/// Returns stairs that rise, or fall, by `rise_m` every `tread_m` from z = 0, `count` times.
inline HeightOf stairs(float rise_m, float tread_m, float count) {
  return [=](float, float z) {
    return TerrainHeight{rise_m * std::clamp(std::floor(z / tread_m) + 1, 0.0F, count), 0, 0};
  };
}

/// One walker with forces on such terrain.
struct Hike {
  HeightOf ground;
  Simulation simulation;
  Terrain terrain;
  Entity person;

  Hike(HeightOf on, const GaitRequest& gait, const BodyRequest& body = {.height_m = 1.75F, .mass_kg = 75},
       double tick_s = 1.0 / 60, float start_z_m = 0, const TerrainOptions& options = {})
      : ground(std::move(on)),
        simulation({.tick_s = tick_s}),
        terrain(terrain_of(simulation, answering(ground), options)) {
    person = simulation.spawn(body, gait).value();
    EXPECT_TRUE(simulation.place(person, 0, start_z_m, 0));
    EXPECT_TRUE(simulation.enable(person, Feature::forces));
    EXPECT_TRUE(terrain.manage({&person, 1}));
    tick();
  }
  void tick() { simulation.tick(); }
  template <template <class> class C>
  C<float> get() const {
    return simulation.get<C>(person).value();
  }
};

/// Returns the height above the ground of the lowest point of a sole, for a foot on a plane.
inline float lowest_m(const Hike& hike, std::size_t side) {
  const Feet<float> feet = hike.get<Feet>();
  float lowest = std::numeric_limits<float>::max();
  for (const Vec3<float>& p : {feet.heel_m[side], feet.toe_m[side], feet.tip_m[side]})
    lowest = std::min(lowest, p.y - hike.ground(p.x, p.z).height_m);
  return lowest;
}

}  // namespace mobil
