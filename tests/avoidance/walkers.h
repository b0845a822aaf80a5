#pragma once
// Walkers for tests of avoidance.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>

#include <mobil/avoidance.h>
#include <mobil/simulation.h>
#include <mobil/systems/poses/roots.h>
#include "engine/row_hash.h"

namespace mobil {

inline constexpr float pi = std::numbers::pi_v<float>;

/// Returns a pseudorandom number from 0 to 1, determined by two integers.
inline float drawn(std::uint64_t a, std::uint64_t b) {
  return static_cast<float>(mix64(mix64(a + 1) ^ b) >> 40) * 0x1p-24F;
}

inline Entity walker(Simulation& simulation, float speed_m_s, float x_m = 0, float z_m = 0, float heading_rad = 0,
                     float height_m = 1.72F) {
  const Entity one =
      simulation.spawn({.height_m = height_m, .mass_kg = 24 * height_m * height_m}, {.speed_m_s = speed_m_s}).value();
  EXPECT_TRUE(simulation.place(one, x_m, z_m, heading_rad));
  return one;
}

inline Root root_of(const Simulation& simulation, Entity one) {
  Root root;
  EXPECT_TRUE(simulation.roots({&one, 1}, {&root, 1}));
  return root;
}

/// A world in which people avoid each other.
struct Avoiders {
  Simulation simulation;
  Avoidance avoidance = simulation.avoidance();

  template <class... Of>
  Entity come(float speed_m_s, Of... of) {
    const Entity one = walker(simulation, speed_m_s, of...);
    EXPECT_TRUE(avoidance.manage(one));
    return one;
  }
  void run(int ticks = 1) {
    for (int k = 0; k < ticks; ++k) simulation.tick();
  }
  Root root(Entity one) const { return root_of(simulation, one); }
  double apart_m(Entity a, Entity b) const {
    const Root one = root(a), other = root(b);
    return std::hypot(one.x_m - other.x_m, one.z_m - other.z_m);
  }
};

}  // namespace mobil
