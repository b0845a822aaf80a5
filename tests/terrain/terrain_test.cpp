// Walkers on terrain that is not level.

#include <mobil/terrain.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include <mobil/components/step_plan.h>
#include <mobil/forces.h>
#include <mobil/lod.h>
#include <mobil/simulation.h>
#include <mobil/systems/people/step_event.h>
#include "engine/row_hash.h"
#include "tests/engine/counting_heap.h"
#include "tests/interfaces.h"
#include "tests/labels.h"
#include "tests/simulation/reseal.h"
#include "tests/terrain/hike.h"

MOBIL_TEST_LABELS("threads");

namespace mobil {
namespace {

/// Feet are never in a slope of any direction, and the standing foot is on it, within 2 mm.
RC_GTEST_PROP(Terrain, FeetStandOnAnySlopeAndNeverInIt, ()) {
  const auto drawn = [](int low, int high) { return static_cast<float>(*rc::gen::inRange(low, high)) * 0.01F; };
  const float speed = drawn(40, 170), x = drawn(-25, 26), z = drawn(-25, 26), height = drawn(150, 196);
  Hike hike(plane(x, z), {.speed_m_s = speed}, {.height_m = height, .mass_kg = 24 * height * height});
  RC_ASSERT(hike.simulation.turn_to(hike.person, drawn(-300, 300)).has_value());
  for (int t = 0; t < 240; ++t) {
    hike.tick();
    const GaitState<float> state = hike.get<GaitState>();
    RC_ASSERT(lowest_m(hike, 0) > -0.002F);
    RC_ASSERT(lowest_m(hike, 1) > -0.002F);
    // The heel's pad yields at first.
    if (state.time_s > 0.15F * hike.get<StepPlan>().duration_s) RC_ASSERT(lowest_m(hike, state.stance_side) < 0.002F);
  }
}

/// Except that a foot in the air keeps slightly farther from a straight leg.
TEST(Terrain, WalkOnAPlateauEqualsLevelGround) {
  Hike up([](float, float) { return TerrainHeight{12.5F, 0, 0}; }, {.speed_m_s = 1.3F});
  Hike down([](float, float) { return TerrainHeight{0, 0, 0}; }, {.speed_m_s = 1.3F});
  Simulation level;
  const Entity person = level.spawn({.height_m = 1.75F, .mass_kg = 75}, {.speed_m_s = 1.3F}).value();
  level.tick();
  for (int t = 0; t < 200; ++t) {
    const Pose<float> a = up.get<Pose>(), b = down.get<Pose>(), c = level.get<Pose>(person).value();
    for (std::size_t s = 0; s < segment_count; ++s) {
      EXPECT_NEAR(a.position_m[s].y - 12.5F, b.position_m[s].y, 1e-5F);
      EXPECT_NEAR(b.position_m[s].x, c.position_m[s].x, 3.2e-3F);
      EXPECT_NEAR(b.position_m[s].y, c.position_m[s].y, 3.2e-3F);
      EXPECT_NEAR(b.position_m[s].z, c.position_m[s].z, 3.2e-3F);
    }
    up.tick(), down.tick(), level.tick();
  }
}

double fastest_m_s(const Pose<float>& before, const Pose<float>& now, double tick_s) {
  double most = 0;
  for (std::size_t s = 0; s < segment_count; ++s) {
    const Vec3<float>&a = before.position_m[s], &b = now.position_m[s];
    most = std::max(most, std::hypot(double{b.x} - double{a.x}, double{b.y} - double{a.y}, double{b.z} - double{a.z}));
  }
  return most / tick_s;
}

/// A kerb runs along the path, under one foot: walking, stopping, standing, stepping to either side, turning in place
/// and walking again.
TEST(Terrain, OneFootHigherThanTheOtherNothingJumps) {
  constexpr double tick_s = 1.0 / 240;
  for (const float high_m : {0.15F, -0.15F}) {
    Hike hike(
        [=](float x, float) {
          return TerrainHeight{x > 0 ? high_m : 0, 0, 0};
        },
        {.speed_m_s = 1.0F}, {.height_m = 1.75F, .mass_kg = 75}, tick_s);
    double fastest = 0, standing = 0;
    Pose<float> before = hike.get<Pose>();
    const auto go = [&](int ticks, double& most) {
      for (int t = 0; t < ticks; ++t) {
        hike.tick();
        const Pose<float> now = hike.get<Pose>();
        most = std::max(most, fastest_m_s(before, now, tick_s));
        before = now;
        for (const std::size_t side : {0U, 1U}) ASSERT_GT(lowest_m(hike, side), -0.16F);
      }
    };
    go(480, fastest);
    ASSERT_TRUE(hike.simulation.change_gait(hike.person, {.speed_m_s = 0.0F}));
    ASSERT_TRUE(hike.simulation.step_aside(hike.person, 0.2F, 0));  // once standing
    go(720, fastest);
    go(240, standing);
    ASSERT_TRUE(hike.simulation.step_aside(hike.person, -0.2F, 0));
    go(480, fastest);
    ASSERT_TRUE(hike.simulation.turn_to(hike.person, 1.0F));
    go(720, fastest);
    for (const std::size_t side : {0U, 1U}) EXPECT_NEAR(lowest_m(hike, side), 0, 0.002F);
    ASSERT_TRUE(hike.simulation.change_gait(hike.person, {.speed_m_s = 1.0F}));
    go(480, fastest);
    EXPECT_LT(standing, 0.001) << high_m;
    EXPECT_LT(fastest, 8) << high_m;
  }
}

TEST(Terrain, ManagedWalkersAreNotMadeCompact) {
  Hike hike(plane(0, 0.1F), {.speed_m_s = 1.2F});
  ASSERT_TRUE(hike.simulation.enable(hike.person, Feature::forces, false));
  EXPECT_EQ(hike.simulation.set_state({&hike.person, 1}, PersonState::compact).value(), 0U);
}

/// People who cannot be compact do not keep others from it.
TEST(Terrain, LodMakesOtherPeopleCompact) {
  Simulation simulation;
  Terrain terrain = terrain_of(simulation, answering([](float, float) { return TerrainHeight{50, 0, 0}; }));
  LodOptions options;
  options.machine_factor = 1;
  options.leg_muscles.muscles = 1;
  options.compacts = 1;
  Lod lod = lod_of(simulation, options);
  std::vector<Entity> people;
  for (int i = 0; i < 8; ++i) {
    people.push_back(simulation.spawn({}, {.speed_m_s = 1.0F}).value());
    ASSERT_TRUE(simulation.place(people.back(), static_cast<float>(i), 100, 0));
    ASSERT_TRUE(lod.manage(people.back(), {}));
  }
  ASSERT_TRUE(terrain.manage(std::span(people).first(4)));
  LodScene needs;
  needs.muscles = 1;
  needs.compact_unseen = true;
  needs.camera = Viewpoint{.position_m = {0, 51, 0}, .forward = {0, 0, -1}};
  ASSERT_TRUE(lod.set_scene(needs));
  const auto go = [&](int ticks) {
    for (int t = 0; t < ticks; ++t) simulation.tick();
  };
  go(120);
  for (std::size_t i = 0; i < people.size(); ++i)
    EXPECT_EQ((simulation.state(people[i]) == PersonState::compact), i >= 4) << i;
}

/// Hosts that resolve queries themselves can skip several ticks. The query is then made later, and repeated if it was
/// not resolved in time.
TEST(Terrain, LateHeightsPutFeetBackOnTheGround) {
  Hike hike(plane(0, 0.1F), {.speed_m_s = 1.2F});
  hike.terrain.set_heights({});
  std::vector<TerrainHeight> answers;
  const auto answer_and_tick = [&](std::uint32_t ticks) {
    const auto at = hike.terrain.query();
    answers.assign(at.size(), {});
    answering(hike.ground)(at, answers);
    ASSERT_TRUE(hike.terrain.resolve(answers));
    hike.simulation.tick(ticks);
  };
  ASSERT_TRUE(hike.simulation.change_gait(hike.person, {.speed_m_s = 0.0F}));
  for (int k = 0; k < 60; ++k) answer_and_tick(2);
  ASSERT_TRUE(hike.simulation.change_gait(hike.person, {.speed_m_s = 1.2F}));
  for (int k = 0; k < 100; ++k) {
    answer_and_tick(2);
    for (const std::size_t side : {0U, 1U}) EXPECT_GT(lowest_m(hike, side), -0.004F);
  }
  hike.simulation.tick(90);
  answer_and_tick(1);
  answer_and_tick(1);
  EXPECT_NEAR(lowest_m(hike, hike.get<GaitState>().stance_side), 0, 0.01F);
}

TEST(Terrain, StepEventsAreAtTerrainHeight) {
  Hike hike(plane(0, 0.1F), {.speed_m_s = 1.2F});
  ASSERT_TRUE(hike.simulation.enable({&hike.person, 1}, Feature::step_events));
  std::size_t count = 0;
  for (int t = 0; t < 200; ++t) {
    hike.tick();
    for (const StepEvent& event : hike.simulation.events()) {
      ++count;
      EXPECT_NEAR(event.place_m.y, hike.ground(event.place_m.x, event.place_m.z).height_m, 1e-4F);
    }
  }
  EXPECT_GT(count, 8U);
}

/// Fifty people on hills, a quarter of them with their own style.
struct Crowd {
  Simulation simulation;
  Terrain terrain;
  std::vector<Entity> people;

  explicit Crowd(int threads, bool slows_down = false)
      : simulation({.threads = threads}),
        terrain(terrain_of(simulation, answering([](float x, float z) {
                             return TerrainHeight{0.3F * std::sin(x) + 0.1F * z, 0.3F * std::cos(x), 0.1F};
                           }),
                           {.slows_down = slows_down})) {
    for (int i = 0; i < 50; ++i) {
      GaitRequest gait{.speed_m_s = 0.5F + 0.02F * static_cast<float>(i)};
      if (i % 4 == 0) gait.style.time_asymmetry = 0.1F;
      people.push_back(simulation.spawn({}, gait).value());
      EXPECT_TRUE(simulation.place(people.back(), static_cast<float>(i), 0, 0.1F * static_cast<float>(i)));
    }
    EXPECT_TRUE(terrain.manage(people));
  }
  void tick() { simulation.tick(); }
};

TEST(Terrain, SameBitsOnAnyThreadsAndFromASnapshot) {
  for (const bool slows_down : {false, true}) {
    Crowd one(1, slows_down), three(3, slows_down);
    std::vector<std::byte> saved;
    for (int k = 0; k < 300; ++k) {
      one.tick();
      three.tick();
      if (k != 137) continue;
      saved.resize(one.simulation.snapshot_bytes());
      ASSERT_TRUE(one.simulation.save(saved));
    }
    EXPECT_EQ(one.simulation.state_hash(), three.simulation.state_hash());
    ASSERT_TRUE(three.simulation.restore(saved));
    for (int k = 138; k < 300; ++k) three.tick();
    EXPECT_EQ(one.simulation.state_hash(), three.simulation.state_hash());
  }
}

TEST(Terrain, TerrainIsQueriedOnceAStepWithoutAllocating) {
  for (const bool slows_down : {false, true}) {
    Crowd crowd(1, slows_down);
    for (int k = 0; k < 400; ++k) crowd.tick();
    std::size_t asked = 0, requests = 0;
    std::uint32_t steps = 0;
    for (const Entity person : crowd.people) steps -= crowd.simulation.get<GaitState>(person)->steps;
    for (int k = 0; k < 240; ++k) {
      const std::size_t before = heap_requests;
      crowd.simulation.tick();
      requests += heap_requests - before;
      asked += crowd.terrain.report().asked;
    }
    for (const Entity person : crowd.people) steps += crowd.simulation.get<GaitState>(person)->steps;
    EXPECT_NEAR(static_cast<double>(asked), static_cast<double>(steps), 50);
    EXPECT_EQ(requests, 0U) << slows_down;
  }
}

/// A host that queries and resolves separately gets equal results. A query changes no state.
TEST(Terrain, QueryAndResolveEqualTheCallback) {
  Crowd whole(1), halves(1);
  halves.terrain.set_heights({});
  std::vector<TerrainHeight> answers;
  for (int k = 0; k < 200; ++k) {
    whole.tick();
    const std::uint64_t before = halves.simulation.state_hash();
    const std::size_t once = halves.terrain.query().size();
    const std::span<const TerrainQuery> at = halves.terrain.query();
    ASSERT_EQ(at.size(), once);
    ASSERT_EQ(halves.simulation.state_hash(), before);
    answers.assign(at.size(), {});
    for (std::size_t i = 0; i < at.size(); ++i)
      answers[i] = {0.3F * std::sin(at[i].x_m) + 0.1F * at[i].z_m, 0.3F * std::cos(at[i].x_m), 0.1F};
    ASSERT_TRUE(halves.terrain.resolve(answers));
    halves.simulation.tick();
  }
  EXPECT_EQ(whole.simulation.state_hash(), halves.simulation.state_hash());
}

/// Between query and resolve, people are removed, take steps, or move to other tables.
TEST(Terrain, HeightsForChangedWalkersAreIgnored) {
  Crowd crowd(1);
  crowd.tick();
  crowd.terrain.set_heights({});
  for (int k = 0; k < 40; ++k) {
    std::vector<TerrainHeight> answers(crowd.terrain.query().size());
    if (k == 10) {
      ASSERT_TRUE(crowd.simulation.despawn(crowd.people.back()));
      crowd.people.pop_back();
    }
    if (k == 20) (void)crowd.simulation.enable(crowd.people.front(), Feature::forces);
    if (k == 25) (void)crowd.terrain.release({&crowd.people[1], 1});
    crowd.simulation.tick(7);
    ASSERT_TRUE(crowd.terrain.resolve(answers));
    EXPECT_EQ(crowd.terrain.resolve(answers).has_value(), answers.empty());  // resolved only once
  }
  crowd.tick();
  for (const Entity person : crowd.people)
    EXPECT_TRUE(std::isfinite(crowd.simulation.get<Pose>(person)->position_m[0].y));
}

TEST(Terrain, PlacedOrWokenPeopleStandOnTheLocalGround) {
  Hike hike(plane(0, 0.1F), {.speed_m_s = 1.2F});
  for (int k = 0; k < 30; ++k) hike.tick();
  ASSERT_TRUE(hike.simulation.place(hike.person, 3, 200, 0));
  hike.tick();
  EXPECT_NEAR(lowest_m(hike, hike.get<GaitState>().stance_side), 0, 0.01F);
  ASSERT_TRUE(hike.simulation.enable(hike.person, Feature::forces, false));
  for (int k = 0; k < 120; ++k) hike.tick();
  ASSERT_TRUE(hike.simulation.set_state({&hike.person, 1}, PersonState::asleep));
  ASSERT_EQ(hike.simulation.state(hike.person), PersonState::asleep);
  for (int k = 0; k < 600; ++k) hike.tick();
  ASSERT_TRUE(hike.simulation.set_state({&hike.person, 1}, PersonState::full));
  hike.tick();
  EXPECT_GT(hike.get<Pose>().position_m[0].z, 210);
  for (const std::size_t side : {0U, 1U}) {
    EXPECT_GT(lowest_m(hike, side), -0.002F);
    EXPECT_LT(lowest_m(hike, side), 0.3F);
  }
}

TEST(Terrain, NonFiniteHeightsAreHarmless) {
  int calls = 0;
  Simulation simulation;
  Terrain terrain = terrain_of(simulation, [&](std::span<const TerrainQuery> at, std::span<TerrainHeight> out) {
    ++calls;
    for (std::size_t i = 0; i < at.size(); ++i) {
      const float wild[] = {std::nanf(""), std::numeric_limits<float>::infinity(), -1e30F, 0.1F, 50, -50};
      const auto draw = [&](std::uint64_t k) { return wild[mix64(mix64(i) ^ (k + static_cast<unsigned>(calls))) % 6]; };
      out[i] = {draw(1), draw(2), draw(3)};
    }
  });
  const Entity person = simulation.spawn({}).value();
  ASSERT_TRUE(terrain.manage({&person, 1}));
  std::size_t unusable = 0;
  for (int k = 0; k < 400; ++k) {
    simulation.tick();
    unusable += terrain.report().unusable;
    const Pose<float> pose = simulation.get<Pose>(person).value();
    for (const Vec3<float>& p : pose.position_m) ASSERT_TRUE(std::isfinite(p.x + p.y + p.z));
  }
  EXPECT_GT(unusable, 100U);
}

TEST(Terrain, ForgedSnapshotsWithAValidSealAreHarmless) {
  Crowd crowd(1);
  for (int k = 0; k < 50; ++k) crowd.tick();
  std::vector<std::byte> good(crowd.simulation.snapshot_bytes());
  ASSERT_TRUE(crowd.simulation.save(good));
  std::size_t taken = 0;
  for (std::uint64_t k = 0; k < 200; ++k) {
    std::vector<std::byte> bytes = good;
    const std::uint64_t draw = mix64(k), at = 4 * (draw % (bytes.size() / 4));
    const auto word = static_cast<std::uint32_t>(k % 2 == 0 ? mix64(draw) : 0x7F000000U | (mix64(draw) & 0x80FFFFFFU));
    std::memcpy(&bytes[at], &word, 4);
    if (!reseal_snapshot(bytes) || !crowd.simulation.restore(bytes)) continue;
    ++taken;
    for (int t = 0; t < 4; ++t) crowd.tick();
  }
  EXPECT_GT(taken, 20U);
  ASSERT_TRUE(crowd.simulation.restore(good));
}

TEST(Terrain, RefusalsNameTheMistake) {
  Simulation simulation;
  Terrain terrain = terrain_of(simulation, answering(plane(0, 0)));
  const Entity walker = simulation.spawn({}).value(), posed = simulation.spawn_posed({}).value();
  const Entity both[] = {walker, posed}, stale[] = {walker, Entity{}};
  EXPECT_EQ(terrain.manage(both).error().status, Status::missing);
  EXPECT_EQ(terrain.manage(stale).error().status, Status::stale_entity);
  EXPECT_EQ(terrain.release({&walker, 1}).error().status, Status::missing) << "all or none";
  ASSERT_TRUE(terrain.manage({&walker, 1}));
  ASSERT_TRUE(terrain.manage({&walker, 1})) << "again";
  ASSERT_TRUE(terrain.release({&walker, 1}));
  simulation.tick();
  EXPECT_EQ(terrain.report().people, 0U);
}

}  // namespace
}  // namespace mobil
