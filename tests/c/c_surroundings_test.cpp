// Avoidance, walls and terrain through the C interface, compared with C++ in the host's axes.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <mobil/avoidance.h>
#include <mobil/lod.h>
#include <mobil/terrain.h>
#include "tests/c/c_fixture.h"

namespace mobil::c_surroundings_test {
namespace {
using namespace c_test;

TEST(CSurroundings, AvoidancePathsMatchCpp) {
  Twins twins;
  Avoidance avoidance = twins.simulation.avoidance();
  ASSERT_EQ(mobil_avoidance_manage(twins.sim, twins.ids.data(), 5, 1), MOBIL_OK) << twins.sim.message();
  for (const Entity person : twins.entities) ASSERT_TRUE(avoidance.manage(person));
  EXPECT_EQ(bits_of(twins.sim, twins.ids[2]) & (MOBIL_AVOIDS | MOBIL_ON_GROUND), MOBIL_AVOIDS);

  // Everyone walks to the middle, between two walls and past a moving pillar.
  std::vector<std::array<float, 2>> wishes(5);
  std::vector<DesiredVelocity> ours(5);
  for (std::size_t i = 0; i < 5; ++i) {
    wishes[i] = {1.2F, 0.5F * static_cast<float>(i) - 1};
    ours[i] = {twins.entities[i], wishes[i][0], wishes[i][1]};
  }
  const float walls[2][6] = {{-500, 100, 0, 900, 100, 0}, {-500, -600, 0, 900, -600, 30}};
  const float discs[1][7] = {{300, -200, 0, -50, 0, 0, 25}};
  ASSERT_EQ(mobil_avoidance_set_desired_velocity(twins.sim, twins.ids.data(), 5, wishes[0].data(), 0), MOBIL_OK)
      << twins.sim.message();
  ASSERT_EQ(mobil_avoidance_set_walls(twins.sim, walls[0], 0, 2), MOBIL_OK) << twins.sim.message();
  ASSERT_EQ(mobil_avoidance_set_discs(twins.sim, discs[0], 0, 1), MOBIL_OK) << twins.sim.message();
  ASSERT_TRUE(avoidance.set_desired_velocity(ours));
  ASSERT_TRUE(avoidance.set_walls({{{{-1, -5}, {-1, 9}}, {{6, -5}, {6, 9}}}}));
  ASSERT_TRUE(avoidance.set_discs({{{{2, 3}, 0.25F, 0, -0.5F}}}));
  std::size_t chose = 0;
  for (int frame = 0; frame < 100; ++frame) {
    auto did = filled<mobil_avoidance_counts>(MOBIL_AVOIDANCE_COUNTS);
    ASSERT_EQ(mobil_tick(twins.sim, 3), MOBIL_OK);
    twins.simulation.tick(3);
    ASSERT_EQ(mobil_avoidance_report(twins.sim, &did), MOBIL_OK) << twins.sim.message();
    const AvoidanceReport& report = avoidance.report();
    ASSERT_EQ(did.people, 5U);
    ASSERT_EQ(did.chose, report.chose);
    ASSERT_EQ(did.kept_reservation, report.kept_reservation);
    chose += did.chose;
  }
  EXPECT_GT(chose, 30U);
  EXPECT_EQ(twins.sim.hash(), twins.simulation.state_hash());
  ASSERT_EQ(mobil_avoidance_manage(twins.sim, twins.ids.data(), 5, 0), MOBIL_OK) << twins.sim.message();
  EXPECT_EQ(mobil_avoidance_manage(twins.sim, twins.ids.data(), 5, 0), MOBIL_MISSING);
  EXPECT_NE(twins.sim.message().find("person 0"), std::string::npos);
}

TEST(CSurroundings, ObstaclesHaveHeights) {
  Twins twins;
  ASSERT_EQ(mobil_avoidance_manage(twins.sim, twins.ids.data(), 5, 1), MOBIL_OK);
  Avoidance avoidance = twins.simulation.avoidance();
  ASSERT_TRUE(avoidance.manage(twins.entities));
  constexpr float infinite = std::numeric_limits<float>::infinity();
  const float walls[2][6] = {{300, 100, 0, 300, -600, 0}, {400, 100, 0, 400, -600, 0}};
  const float discs[1][7] = {{250, -200, 0, 0, 0, 0, 25}};
  const float heights[2][2] = {{250, 400}, {-infinite, 100}}, upside_down[2][2] = {{0, 1}, {3, 2}};
  ASSERT_EQ(mobil_avoidance_set_walls_between(twins.sim, walls[0], 0, heights[0], 0, 2), MOBIL_OK)
      << twins.sim.message();
  ASSERT_EQ(mobil_avoidance_set_discs_between(twins.sim, discs[0], 0, heights[0], 0, 1), MOBIL_OK);
  ASSERT_TRUE(avoidance.set_walls({{{{-1, 3}, {6, 3}, {2.5F, 4}}, {{-1, 4}, {6, 4}, {-infinite, 1}}}}));
  ASSERT_TRUE(avoidance.set_discs({{{{2, 2.5F}, 0.25F, 0, 0, {2.5F, 4}}}}));
  for (int i = 0; i < 5; ++i) {
    ASSERT_EQ(mobil_tick(twins.sim, 60), MOBIL_OK);
    twins.simulation.tick(60);
    EXPECT_EQ(twins.sim.hash(), twins.simulation.state_hash());
  }
  EXPECT_EQ(mobil_avoidance_set_walls_between(twins.sim, walls[0], 0, upside_down[0], 0, 2), MOBIL_REFUSED);
  EXPECT_NE(twins.sim.message().find("top must be above"), std::string::npos) << twins.sim.message();
}

/// An irregular hill, in the library's coordinates.
TerrainHeight hill(float x_m, float z_m) {
  return {0.3F * std::sin(x_m) + 0.1F * z_m, 0.3F * std::cos(x_m), 0.1F};
}

/// The hill as a host's callback, in the library's axes.
int hill_of_host(void* calls, const float* places, const mobil_id*, size_t count, float* ground) {
  ++*static_cast<int*>(calls);
  for (size_t i = 0; i < count; ++i, places += 3, ground += 4) {
    const TerrainHeight at = hill(places[0], places[2]);
    const float row[] = {at.height_m, -at.rise_x, 1, -at.rise_z};
    std::ranges::copy(row, ground);
  }
  return 0;
}

/// All people walk on the hill, with or without speed scaling, as in C++.
void walk_on_the_hill(bool slows_down) {
  Twins twins;
  const auto heights = [](std::span<const TerrainQuery> at, std::span<TerrainHeight> out) {
    for (std::size_t i = 0; i < at.size(); ++i) out[i] = hill(at[i].x_m, at[i].z_m);
  };
  Terrain terrain = twins.simulation.terrain();
  terrain.set_heights(heights);
  terrain.set_options({.slows_down = slows_down});
  ASSERT_EQ(mobil_terrain_set_speed_scaling(twins.sim, slows_down ? 1 : 0), MOBIL_OK);
  ASSERT_EQ(mobil_terrain_manage(twins.sim, twins.ids.data(), 5, 1), MOBIL_OK) << twins.sim.message();
  ASSERT_TRUE(terrain.manage(twins.entities));
  EXPECT_EQ(bits_of(twins.sim, twins.ids[2]) & (MOBIL_AVOIDS | MOBIL_ON_GROUND), MOBIL_ON_GROUND);
  std::size_t all = 0;
  for (int t = 0; t < 200; ++t) {
    std::size_t count = 0, unusable = 1;
    ASSERT_EQ(mobil_terrain_query(twins.sim, nullptr, 0, nullptr, 0, &count), MOBIL_OK);
    all += count;
    if (count > 0) {
      std::vector<std::array<float, 3>> places(count);
      std::vector<std::array<float, 4>> ground(count);
      std::vector<mobil_id> who(count);
      EXPECT_EQ(mobil_terrain_query(twins.sim, places[0].data(), 0, who.data(), count - 1, nullptr), MOBIL_ROOM);
      ASSERT_EQ(mobil_terrain_query(twins.sim, places[0].data(), 0, who.data(), count, nullptr), MOBIL_OK);
      for (std::size_t i = 0; i < count; ++i) {
        EXPECT_LT(who[i].index, 5U);
        EXPECT_EQ(places[i][2], 0);
        const TerrainHeight at = hill(-places[i][1] / 100, places[i][0] / 100);
        ground[i] = {100 * at.height_m, -2 * at.rise_z, 2 * at.rise_x, 2};  // x ahead, y right, z up
      }
      EXPECT_EQ(mobil_terrain_resolve(twins.sim, ground[0].data(), 0, count - 1, nullptr), MOBIL_REFUSED);
      ASSERT_EQ(mobil_terrain_resolve(twins.sim, ground[0].data(), 0, count, &unusable), MOBIL_OK)
          << twins.sim.message();
      EXPECT_EQ(unusable, 0U);
    }
    ASSERT_EQ(mobil_tick(twins.sim, 1), MOBIL_OK);
    twins.simulation.tick();
    ASSERT_EQ(count, terrain.report().places);
  }
  EXPECT_GT(all, 300U);
  std::vector<float> pose(std::size_t{7} * MOBIL_SEGMENTS);
  int slowed = 0;
  for (std::size_t i = 0; i < 5; ++i) {
    ASSERT_EQ(mobil_poses(twins.sim, &twins.ids[i], 1, nullptr, pose.data(), 0), MOBIL_OK);
    const Vec3<float> pelvis = twins.simulation.get<Pose>(twins.entities[i])->position_m[0];
    EXPECT_NEAR(pose[0], 100 * pelvis.z, 0.01);
    EXPECT_NEAR(pose[1], -100 * pelvis.x, 0.01);
    EXPECT_NEAR(pose[2], 100 * pelvis.y, 0.01);
    auto walk = filled<mobil_walk>(MOBIL_WALK);
    ASSERT_EQ(mobil_get_walk(twins.sim, twins.ids[i], &walk, nullptr, 0), MOBIL_OK) << twins.sim.message();
    EXPECT_NEAR(walk.speed_m_s, twins.simulation.get<Gait>(twins.entities[i])->speed_m_s, 1e-3);
    slowed += walk.speed_m_s < 0.85F;  // every request was at least 0.9 m/s
  }
  EXPECT_EQ(slowed > 0, slows_down);
  ASSERT_EQ(mobil_terrain_set_speed_scaling(twins.sim, 0), MOBIL_OK);
}

TEST(CSurroundings, TerrainMatchesCpp) {
  walk_on_the_hill(false);
}

TEST(CSurroundings, SpeedScalingMatchesCpp) {
  walk_on_the_hill(true);
}

/// One advance per frame runs level of detail, avoidance and terrain queries, as in C++.
TEST(CSurroundings, AFrameHasAllOfItsPhases) {
  const Sim sim;
  const auto ids = spawn(sim, 5);
  int calls = 0;
  auto options = filled<mobil_lod_options>(MOBIL_LOD_OPTIONS);
  options.machine_factor = 1;
  auto scene = filled<mobil_scene>(MOBIL_SCENE);
  scene.tolerance_m = 0.001F;
  ASSERT_EQ(mobil_lod_set_options(sim, &options, nullptr), MOBIL_OK);
  ASSERT_EQ(mobil_lod_set_scene(sim, &scene), MOBIL_OK) << sim.message();
  ASSERT_EQ(mobil_lod_manage(sim, ids.data(), 5, nullptr), MOBIL_OK) << sim.message();
  ASSERT_EQ(mobil_avoidance_manage(sim, ids.data(), 5, 1), MOBIL_OK) << sim.message();
  ASSERT_EQ(mobil_terrain_manage(sim, ids.data(), 5, 1), MOBIL_OK) << sim.message();
  ASSERT_EQ(mobil_terrain_set_heights(sim, &hill_of_host, &calls), MOBIL_OK);

  Simulation ours;
  std::vector<Entity> people(5);
  ASSERT_TRUE(ours.spawn(as_requests(some_people(5)), people));
  ASSERT_TRUE(ours.lod().set_options({.machine_factor = 1}));
  ASSERT_TRUE(ours.lod().set_scene({.tolerance_m = 0.001F}));
  ASSERT_TRUE(ours.lod().manage(people));
  ASSERT_TRUE(ours.avoidance().manage(people));
  ASSERT_TRUE(ours.terrain().manage(people));
  ours.terrain().set_heights([](std::span<const TerrainQuery> at, std::span<TerrainHeight> out) {
    for (std::size_t i = 0; i < at.size(); ++i) out[i] = hill(at[i].x_m, at[i].z_m);
  });
  std::size_t looked_at = 0, places = 0;
  for (int frame = 0; frame < 60; ++frame) {
    mobil_ticks ticks;
    ASSERT_EQ(mobil_advance(sim, 0.04, &ticks), MOBIL_OK) << sim.message();
    ASSERT_EQ(ours.advance(0.04).count, ticks.count);
    auto lod = filled<mobil_lod_counts>(MOBIL_LOD_COUNTS);
    auto avoidance = filled<mobil_avoidance_counts>(MOBIL_AVOIDANCE_COUNTS);
    auto terrain = filled<mobil_terrain_counts>(MOBIL_TERRAIN_COUNTS);
    ASSERT_EQ(mobil_lod_report(sim, &lod), MOBIL_OK);
    ASSERT_EQ(mobil_avoidance_report(sim, &avoidance), MOBIL_OK);
    ASSERT_EQ(mobil_terrain_report(sim, &terrain), MOBIL_OK);
    EXPECT_EQ(lod.switched, ours.lod().report().switched);
    EXPECT_EQ(avoidance.people, ours.avoidance().report().people);
    EXPECT_EQ(terrain.people, ours.terrain().report().people);
    looked_at += lod.looked_at;
    places += terrain.places;
  }
  EXPECT_EQ(sim.hash(), ours.state_hash());
  EXPECT_GT(looked_at, 0U);
  EXPECT_GT(places, 300U);
  EXPECT_GT(calls, 10);
  EXPECT_EQ(bits_of(sim, ids[0]), MOBIL_HAS_MUSCLES | MOBIL_MANAGED | MOBIL_AVOIDS | MOBIL_ON_GROUND);
}

/// A callback that refuses stops the tick. The next tick continues.
TEST(CSurroundings, MissingTerrainStopsTime) {
  const Sim sim, plain;
  const auto level = [](void* user, const float*, const mobil_id*, size_t, float*) { return *static_cast<int*>(user); };
  for (const Sim* each : {&sim, &plain}) {
    const auto ids = spawn(*each, 3);
    ASSERT_EQ(mobil_terrain_manage(*each, ids.data(), 3, 1), MOBIL_OK);
  }
  int refuses = 7, never = 0;
  ASSERT_EQ(mobil_terrain_set_heights(sim, level, &refuses), MOBIL_OK);
  ASSERT_EQ(mobil_terrain_set_heights(plain, level, &never), MOBIL_OK);
  const auto before = sim.hash();
  EXPECT_EQ(mobil_tick(sim, 4), MOBIL_REFUSED);
  EXPECT_NE(sim.message().find("returned 7"), std::string::npos) << sim.message();
  EXPECT_EQ(sim.hash(), before);
  EXPECT_EQ(mobil_time_s(sim), 0);
  refuses = 0;
  ASSERT_EQ(mobil_tick(sim, 40), MOBIL_OK);
  ASSERT_EQ(mobil_tick(plain, 40), MOBIL_OK);
  EXPECT_EQ(sim.hash(), plain.hash());
  ASSERT_EQ(mobil_terrain_set_heights(sim, nullptr, nullptr), MOBIL_OK);
  std::size_t count = 0;
  ASSERT_EQ(mobil_tick(sim, 60), MOBIL_OK);
  ASSERT_EQ(mobil_terrain_query(sim, nullptr, 0, nullptr, 0, &count), MOBIL_OK);
  EXPECT_GT(count, 0U);  // unresolved queries
}

TEST(CSurroundings, InvalidTerrainCountsAsLevel) {
  const Sim sim;
  const auto ids = spawn(sim, 1);
  ASSERT_EQ(mobil_terrain_manage(sim, ids.data(), 1, 1), MOBIL_OK);
  std::size_t count = 0, unusable = 0;
  ASSERT_EQ(mobil_terrain_query(sim, nullptr, 0, nullptr, 0, &count), MOBIL_OK);
  ASSERT_EQ(count, 33U);
  std::vector<std::array<float, 4>> ground(count);
  ground[3] = {0, 0, -1, 0};
  ground[7] = {NAN, 0, 1, 0};
  ground[9] = {0, 1, 0, 0};
  ASSERT_EQ(mobil_terrain_resolve(sim, ground[0].data(), 0, count, &unusable), MOBIL_OK) << sim.message();
  EXPECT_EQ(unusable, 3U);
  EXPECT_EQ(mobil_terrain_resolve(sim, ground[0].data(), 0, count, &unusable), MOBIL_REFUSED);
}

TEST(CSurroundings, BatchesAreAllOrNone) {
  const Sim sim;
  auto ids = spawn(sim, 2);
  ASSERT_EQ(mobil_avoidance_set_options(sim, nullptr), MOBIL_OK);
  auto person = filled<mobil_person>(MOBIL_PERSON);
  person.posed = 1;
  mobil_id posed;
  ASSERT_EQ(mobil_spawn(sim, &person, 0, 1, nullptr, &posed), MOBIL_OK);
  ids.push_back(posed);
  const std::uint64_t before = sim.hash();
  EXPECT_EQ(mobil_avoidance_manage(sim, ids.data(), 3, 1), MOBIL_MISSING);
  EXPECT_NE(sim.message().find("person 2"), std::string::npos);
  EXPECT_EQ(mobil_terrain_manage(sim, ids.data(), 3, 1), MOBIL_MISSING);
  ids[2] = {99, 9};
  EXPECT_EQ(mobil_avoidance_manage(sim, ids.data(), 3, 1), MOBIL_STALE);
  EXPECT_EQ(mobil_terrain_manage(sim, ids.data(), 3, 1), MOBIL_STALE);
  EXPECT_EQ(sim.hash(), before);
  ASSERT_EQ(mobil_avoidance_manage(sim, ids.data(), 2, 1), MOBIL_OK);
  const float wishes[2][2] = {{1, 0}, {NAN, 0}};
  const std::uint64_t avoiding = sim.hash();
  EXPECT_EQ(mobil_avoidance_set_desired_velocity(sim, ids.data(), 2, wishes[0], 0), MOBIL_REFUSED);
  EXPECT_EQ(mobil_avoidance_set_desired_velocity(sim, ids.data(), 2, wishes[0], 4), MOBIL_REFUSED);
  EXPECT_EQ(mobil_avoidance_set_desired_velocity(sim, ids.data(), 2, nullptr, 0), MOBIL_REFUSED);
  EXPECT_EQ(mobil_avoidance_manage(sim, ids.data(), 2, 1),
            MOBIL_OK);  // people who already avoid others keep their desired velocity
  EXPECT_EQ(sim.hash(), avoiding);
  const float wall[6] = {0, 0, 0, INFINITY, 0, 0};
  EXPECT_EQ(mobil_avoidance_set_walls(sim, wall, 0, 1), MOBIL_REFUSED);
  auto options = filled<mobil_avoidance_options>(MOBIL_AVOIDANCE_OPTIONS);
  options.radius_h = NAN;
  EXPECT_EQ(mobil_avoidance_set_options(sim, &options), MOBIL_REFUSED);
}

}  // namespace
}  // namespace mobil::c_surroundings_test
