// Requests to walking people: cost of a change, refusals, and when it takes effect.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include <mobil/engine/world.h>
#include <mobil/forces.h>
#include <mobil/schedule.h>
#include <mobil/simulation.h>
#include "tests/labels.h"
#include "tests/refused.h"
#include "tests/simulation/people.h"
#include "tests/simulation/simulation_hash.h"

MOBIL_TEST_LABELS("threads");

namespace mobil::simulation_change_test {
std::uint64_t solved(const Simulation& simulation) {
  return simulation.schedule().timing("replan")->rows;
}

template <template <class> class C>
bool has_column(const Simulation& simulation, Entity entity) {
  const auto place = simulation.world().find(entity);
  return place && find_component(place.table->key(), type_id<C<float>>()) != nullptr;
}

// --------------------------------------------------------------------------------------------------- refusals

TEST(Change, StaleHandlesChangeNothing) {
  Simulation simulation;
  const Entity gone = join(simulation, sample_person(0)), stays = join(simulation, sample_person(1));
  simulation.tick(10);
  ASSERT_EQ(simulation.despawn(gone), Status::ok);
  const Entity muscle = simulation.muscle(stays, Muscle::quadriceps, Side::left);
  ASSERT_TRUE(simulation.world().alive(muscle));
  const auto before = hash_world(simulation);
  for (const Entity bad : {gone, Entity{}, Entity{~0U, 1}, muscle}) {  // a muscle is alive, but is not a walker
    EXPECT_TRUE(is_refused(simulation.change_gait(bad, {.speed_m_s = 1.0F})));
    EXPECT_FALSE(simulation.turn_to(bad, 1));
    EXPECT_EQ(simulation.enable(bad, Feature::forces), Status::stale_entity);
    EXPECT_EQ(simulation.enable(bad, Feature::forces, false), Status::stale_entity);
  }
  EXPECT_EQ(hash_world(simulation), before);
}

TEST(Change, RequestsOutOfRangeChangeNothing) {
  Simulation simulation;
  const Entity person = join(simulation, sample_person(2)), other = join(simulation, sample_person(3), false);
  simulation.tick(45);
  const auto before = hash_world(simulation);
  const std::size_t tables = simulation.world().tables().size();
  std::vector<GaitRequest> bad = {{.speed_m_s = 9.0F},
                                  {.speed_m_s = -1.0F},
                                  {.speed_m_s = NAN},
                                  {.speed_m_s = INFINITY},
                                  {.speed_m_s = 0.0F, .step_length_m = 0.5F},
                                  {.step_length_m = 3.0F},
                                  {.step_length_m = 0.0F},
                                  {.step_frequency_hz = 20.0F},
                                  {.speed_m_s = 1.4F, .step_length_m = 0.7F, .step_frequency_hz = 3.0F}};
  for (const GaitParameter& parameter : gait_parameters) {
    for (const float value : {parameter.low - 0.01F, parameter.high + 0.01F, NAN, INFINITY, -INFINITY}) {
      bad.push_back({.speed_m_s = 1.2F});
      bad.back().style.*parameter.value = value;
    }
  }
  for (const GaitRequest& request : bad) {
    const auto changed = simulation.set_gait(person, request);
    ASSERT_FALSE(changed);
    EXPECT_EQ(changed.error().message.find('\n'), std::string::npos) << changed.error().message;
    ASSERT_EQ(hash_world(simulation), before) << changed.error().message;
  }
  EXPECT_EQ(simulation.world().tables().size(), tables);

  // It has no later effect either.
  Simulation unasked;
  const Entity same = join(unasked, sample_person(2)), beside = join(unasked, sample_person(3), false);
  unasked.tick(45);
  simulation.tick(60);
  unasked.tick(60);
  EXPECT_EQ(hash_person(simulation, person), hash_person(unasked, same));
  EXPECT_EQ(hash_person(simulation, other), hash_person(unasked, beside));
}

// ------------------------------------------------------------------------------------------------------- costs

TEST(Change, ForcesCostNothingUnlessEnabled) {
  Simulation simulation;
  const Entity person = join(simulation, sample_person(0), false), other = join(simulation, sample_person(1), false);
  const auto bare = simulation.world().find(person).table;
  for (int round = 0; round < 3; ++round) {
    EXPECT_EQ(simulation.enable(person, Feature::forces), Status::ok);
    EXPECT_EQ(simulation.enable(person, Feature::forces), Status::ok);  // there already
    EXPECT_TRUE(has_column<BodyMotion>(simulation, person));
    EXPECT_TRUE(has_column<GroundReaction>(simulation, person));
    EXPECT_TRUE(has_column<JointMoments>(simulation, person));
    EXPECT_FALSE(has_column<JointMoments>(simulation, other));
    simulation.tick(20);
    EXPECT_TRUE(simulation.get<GroundReaction>(person).has_value());
    EXPECT_EQ(simulation.get<GroundReaction>(other).error(), Status::missing);
    EXPECT_EQ(simulation.enable(person, Feature::forces, false), Status::ok);
    EXPECT_EQ(simulation.enable(person, Feature::forces, false), Status::ok);  // gone already
    EXPECT_FALSE(has_column<BodyMotion>(simulation, person));
    EXPECT_FALSE(has_column<GroundReaction>(simulation, person));
    EXPECT_FALSE(has_column<JointMoments>(simulation, person));
    EXPECT_EQ(simulation.world().find(person).table, bare);
    EXPECT_EQ(rows_with<JointMoments>(simulation.world()), 0U);
  }
}

TEST(Change, SteadyWalkersAreNotSolvedAgain) {
  Simulation simulation;
  std::vector<Entity> crowd;
  for (int i = 0; i < 40; ++i) crowd.push_back(join(simulation, sample_person(i), false));
  simulation.tick(120);  // the first step was solved at spawn; another can confirm that the next equals it
  EXPECT_LE(solved(simulation), 2 * crowd.size());
  auto before = solved(simulation);
  simulation.tick(300);
  EXPECT_EQ(solved(simulation), before);

  // A walker who changes is solved a few times: as many steps as the change takes, and one to confirm that it is done.
  for (const float speed : {1.9F, 0.6F, 0.0F, 1.3F}) {
    ASSERT_TRUE(simulation.change_gait(crowd[11], {.speed_m_s = speed}));
    before = solved(simulation);
    simulation.tick(600);
    EXPECT_GE(solved(simulation), before + 1) << speed;
    EXPECT_LE(solved(simulation), before + 6) << speed;
    before = solved(simulation);
    simulation.tick(300);
    EXPECT_EQ(solved(simulation), before) << speed;
  }
  // A turning walker is solved at every step, because turning steps are nearer to usual ones; usual walkers are not.
  EXPECT_TRUE(simulation.turn_to(crowd[11], 2));
  simulation.tick(600);
  EXPECT_GE(solved(simulation), before + 4);
  EXPECT_LE(solved(simulation), before + 9);
  ASSERT_TRUE(simulation.change_gait(crowd[11], {.style = GaitStyle{}}));
  simulation.tick(600);
  before = solved(simulation);
  EXPECT_TRUE(simulation.turn_to(crowd[11], 0));
  simulation.tick(600);
  EXPECT_EQ(solved(simulation), before);
  // Several requests within a step are solved once.
  const auto stance = simulation.get<GaitState>(crowd[20])->steps;
  while (simulation.get<GaitState>(crowd[20])->steps == stance) simulation.tick();
  before = solved(simulation);
  for (int i = 0; i < 5; ++i)
    ASSERT_TRUE(simulation.change_gait(crowd[20], {.speed_m_s = 1.2F + 0.01F * static_cast<float>(i)}));
  simulation.tick(600);
  EXPECT_LE(solved(simulation), before + 4);
}

TEST(Change, RequestTakesEffectFromTheNextStep) {
  Simulation changed, unchanged;
  const Entity a = join(changed, sample_person(4), false), b = join(unchanged, sample_person(4), false);
  changed.tick(50);
  unchanged.tick(50);
  ASSERT_TRUE(changed.change_gait(a, {.speed_m_s = 0.7F}));
  EXPECT_TRUE(changed.turn_to(a, 1));
  const auto step = changed.get<GaitState>(a)->steps;
  for (int i = 0; i < 200; ++i) {
    changed.tick();
    unchanged.tick();
    if (changed.get<GaitState>(a)->steps != step) break;
    const auto p = *changed.get<Pose>(a), q = *unchanged.get<Pose>(b);
    ASSERT_EQ(std::memcmp(&p, &q, sizeof p), 0) << i;
  }
  changed.tick(60);
  unchanged.tick(60);
  EXPECT_LT(changed.get<Pose>(a)->position_m[0].z, unchanged.get<Pose>(b)->position_m[0].z);
  EXPECT_GT(changed.get<GaitState>(a)->heading_rad, 0.1F);
}

}  // namespace mobil::simulation_change_test
