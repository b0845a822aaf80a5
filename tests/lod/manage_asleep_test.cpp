// People managed asleep: those in view wake, and a refusal leaves all people unchanged.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include <mobil/components/lod.h>
#include <mobil/lod.h>
#include <mobil/simulation.h>
#include "tests/interfaces.h"
#include "tests/labels.h"
#include "tests/refused.h"

MOBIL_TEST_LABELS("threads");

namespace mobil {
namespace {
namespace manage_asleep {

/// Two people: one walks straight on, one turns and cannot sleep.
struct Two {
  Simulation simulation{SimulationOptions{.threads = 1}};
  std::vector<Entity> people;

  Two() {
    for (int i = 0; i < 2; ++i) people.push_back(*simulation.spawn(BodyRequest{}, {}));
    for (int i = 0; i < 120; ++i) simulation.tick();
    EXPECT_TRUE(simulation.turn_to(people[1], 1.5F));
    for (int i = 0; i < 40; ++i) simulation.tick();
  }
};

/// Expects a refusal that leaves no person managed or asleep.
void expect_refused(const LodOptions& options, const std::string& word) {
  Two two;
  Lod lod = lod_of(two.simulation, options);
  const std::uint64_t before = two.simulation.state_hash();
  EXPECT_TRUE(is_refused(lod.manage_asleep(two.people), word)) << word;
  EXPECT_EQ(two.simulation.state_hash(), before) << word;
  EXPECT_FALSE(lod.release(two.people[0])) << word;
}

TEST(ManageAsleep, InvalidMusclesAreRefusedBeforeAnyoneSleeps) {
  expect_refused({.leg_muscles = {.dt_s = 1e-12}}, "step");
  expect_refused({.leg_muscles = {.material = {.young_pa = 0}}}, "Young");
  expect_refused({.leg_muscles = {.damping_per_s = -1}}, "damping");
  expect_refused({.leg_muscles = {.cells = {0, 2, 2}}}, "cells");
  expect_refused({.leg_muscles = {.activation = ExcitationSource::moments}}, "Feature::forces");
}

TEST(ManageAsleep, SleepersWithForcesHaveMoments) {
  Simulation simulation(SimulationOptions{.threads = 1});
  const Entity person = *simulation.spawn(BodyRequest{}, {});
  ASSERT_TRUE(simulation.enable(person, Feature::forces));
  simulation.tick(120);
  ASSERT_TRUE(simulation.set_state({&person, 1}, PersonState::asleep));
  ASSERT_EQ(simulation.state(person), PersonState::asleep);
  Lod lod = lod_of(simulation, {.leg_muscles = {.activation = ExcitationSource::moments}});
  const auto done = lod.manage_asleep({&person, 1});
  EXPECT_TRUE(done) << done.error().message;
}

TEST(ManageAsleep, SceneWithoutMusclesManagesPeopleUnableToSleep) {
  Two two;
  Lod lod = two.simulation.lod();
  LodScene needs;
  needs.muscles = 0;
  ASSERT_TRUE(lod.set_scene(needs));
  EXPECT_EQ(lod.manage_asleep(two.people).value(), 1U);
  two.simulation.tick();
  for (const Entity person : two.people) EXPECT_TRUE(lod.release(person));
}

TEST(ManageAsleep, PeopleEnteringAFixedViewWake) {
  Two two;
  Lod lod = two.simulation.lod();
  LodScene needs;
  needs.muscles = 0;
  Viewpoint camera;
  camera.forward = {0, 0, 1};
  camera.half_angle_rad = 0.5F;
  camera.reach_m = 50;
  needs.camera = camera;
  needs.asleep_beyond_m = 30;
  ASSERT_TRUE(lod.set_scene(needs));
  std::vector<SpawnRequest> far(400);
  for (SpawnRequest& request : far) request.z_m = -500;
  std::vector<Entity> unseen(far.size());
  ASSERT_TRUE(two.simulation.spawn(far, unseen));
  ASSERT_TRUE(lod.manage_asleep(unseen));
  for (int i = 0; i < 30; ++i) two.simulation.tick();
  SpawnRequest request;
  request.z_m = 20;
  Entity seen;
  ASSERT_TRUE(two.simulation.spawn({&request, 1}, {&seen, 1}));
  ASSERT_EQ(lod.manage_asleep({&seen, 1}).value(), 1U);
  for (int i = 0; i < 3 && (two.simulation.state(seen) == PersonState::asleep); ++i) two.simulation.tick();
  EXPECT_NE(two.simulation.state(seen), PersonState::asleep);
}

}  // namespace manage_asleep
}  // namespace
}  // namespace mobil
