#pragma once
// A room full of walkers.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include <mobil/avoidance.h>
#include <mobil/simulation.h>
#include <mobil/systems/poses/roots.h>
#include "tests/avoidance/walkers.h"

namespace mobil {

/// People in a closed room, each with a sequence of goals.
struct Room {
  explicit Room(int threads, std::size_t many = 40, float side = 8)
      : people(many), side_m(side), simulation({.threads = threads}), avoidance(simulation.avoidance()) {
    for (std::size_t i = 0; i < people; ++i) {
      const std::size_t across = (people + 5) / 6;
      const float x = side_m * ((static_cast<float>(i % across) + 0.5F) / static_cast<float>(across) - 0.5F);
      const float z = side_m * ((static_cast<float>(i / across) + 0.5F) / 6 - 0.5F);
      who.push_back(walker(simulation, 0, x, z, 6 * drawn(i, 1), 1.6F + 0.25F * drawn(i, 2)));
      EXPECT_TRUE(avoidance.manage(who.back()));
    }
    const float h = side_m / 2;
    const Wall walls[] = {{{-h, -h}, {h, -h}}, {{h, -h}, {h, h}}, {{h, h}, {-h, h}}, {{-h, h}, {-h, -h}}};
    EXPECT_TRUE(avoidance.set_walls(walls));
    roots.resize(people);
  }

  void tick() {
    const std::uint32_t now = simulation.ticks();
    if (now % 15 == 0) {
      EXPECT_TRUE(simulation.roots(who, roots));
      wishes.clear();
      for (std::size_t i = 0; i < people; ++i) {
        const std::uint64_t goal = i * 1000 + (now + 31 * i) / 600;
        const auto x = static_cast<double>((side_m - 1) * (drawn(goal, 3) - 0.5F));
        const auto z = static_cast<double>((side_m - 1) * (drawn(goal, 4) - 0.5F));
        const float heading = static_cast<float>(std::atan2(x - roots[i].x_m, z - roots[i].z_m));
        const bool there = std::hypot(x - roots[i].x_m, z - roots[i].z_m) < 0.7;
        wishes.push_back({who[i], there ? 0 : 1.1F + 0.4F * drawn(i, 5), heading});
      }
      EXPECT_TRUE(avoidance.set_desired_velocity(wishes));
    }
    simulation.tick();
    report = avoidance.report();
  }

  std::size_t people;
  float side_m;
  Simulation simulation;
  Avoidance avoidance;
  std::vector<Entity> who;
  std::vector<Root> roots;
  std::vector<DesiredVelocity> wishes;
  AvoidanceReport report;
};

}  // namespace mobil
