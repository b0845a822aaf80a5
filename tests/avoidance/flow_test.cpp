// How walkers get on who meet others or stand in a bad place.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "systems/avoidance/avoidance.h"
#include "systems/simulation.h"
#include "tests/avoidance/walkers.h"

namespace mobil {
namespace {

/// Who comes the other way is parted from: each flow keeps to its right.
TEST(Avoidance, TwoFlowsPartIntoLanes) {
  Simulation simulation;
  Avoidance avoidance(simulation);
  constexpr float half_m = 2.5F, far_m = 60;
  const Wall walls[] = {{{-half_m, -far_m}, {-half_m, far_m}}, {{half_m, -far_m}, {half_m, far_m}}};
  ASSERT_TRUE(avoidance.set_walls(walls));
  constexpr std::size_t many = 48;
  std::vector<Entity> all;
  std::vector<WalkWish> wishes;
  for (std::size_t i = 0; i < many; ++i) {
    const bool back = i % 2 == 1;
    const float x = 3.6F * (drawn(i, 1) - 0.5F), z = (back ? 1.0F : -1.0F) * (4 + 0.5F * static_cast<float>(i));
    all.push_back(walker(simulation, 1.3F, x, z, back ? pi : 0));
    ASSERT_TRUE(avoidance.manage(all.back()));
    wishes.push_back({all.back(), 1.3F, back ? pi : 0});
  }
  ASSERT_TRUE(avoidance.want(wishes));
  std::vector<Root> at(many);
  double right = 0, passing = 0;
  for (int tick = 0; tick < 60 * 40; ++tick) {
    avoidance.update();
    simulation.tick();
    if (tick % 30 != 0) continue;
    ASSERT_TRUE(simulation.roots(all, at));
    for (std::size_t i = 0; i < many; ++i) {
      if (std::fabs(at[i].z_m) > 4) continue;  // where they pass
      ++passing;
      right += (i % 2 == 1 ? at[i].x_m : -at[i].x_m) > 0 ? 1 : 0;  // of who goes toward +Z the right is -X
    }
  }
  EXPECT_GT(passing, 300);
  EXPECT_GT(right / passing, 0.8);
  ASSERT_TRUE(simulation.roots(all, at));
  for (std::size_t i = 0; i < many; ++i)
    EXPECT_GT(i % 2 == 1 ? -at[i].z_m : at[i].z_m, 4) << i << " did not get through";
}

/// Who stands beside a wall, facing into it a little, turns and goes along it.
TEST(Avoidance, WhoStandsBesideAWallGoesAlongIt) {
  for (const float off : {0.0F, 0.2F, 0.45F, 0.9F}) {
    Simulation simulation;
    Avoidance avoidance(simulation);
    const Wall wall[] = {{{0.225F, -50}, {0.225F, 50}}};
    ASSERT_TRUE(avoidance.set_walls(wall));
    const Entity one = walker(simulation, 0, 0, 0, off);
    ASSERT_TRUE(avoidance.manage(one));
    const WalkWish wish[] = {{one, 1.2F, 0}};
    ASSERT_TRUE(avoidance.want(wish));
    for (int k = 0; k < 600; ++k) {
      avoidance.update();
      simulation.tick();
    }
    EXPECT_GT(root_of(simulation, one).z_m, 7) << "facing " << off;
    EXPECT_LT(root_of(simulation, one).x_m, 0.06);
  }
}

}  // namespace
}  // namespace mobil
