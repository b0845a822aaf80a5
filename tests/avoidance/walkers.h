#pragma once
// Walkers for the tests of avoidance.

#include <gtest/gtest.h>

#include <cstdint>
#include <numbers>

#include <mobil/simulation.h>
#include "engine/row_hash.h"

namespace mobil {

inline constexpr float pi = std::numbers::pi_v<float>;

/// 0 to 1, of two numbers.
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

}  // namespace mobil
