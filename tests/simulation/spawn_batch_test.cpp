// People spawned by one call equal people spawned singly, bit for bit. All of them are spawned, or none.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

#include <mobil/engine/world.h>
#include <mobil/muscle_library.h>
#include <mobil/simulation.h>
#include <mobil/systems/muscles/person.h>
#include "tests/engine/engine_counting_memory.h"
#include "tests/engine/wilful_pool.h"
#include "tests/labels.h"
#include "tests/simulation/people.h"
#include "tests/simulation/simulation_hash.h"

MOBIL_TEST_LABELS("threads;long");

namespace mobil::spawn_batch_test {
LegMuscles muscles_of_kind(int kind) {
  LegMuscles choice;
  choice.muscles = 0b1010;  // two suffice
  choice.method = kind == 0 ? Method::none : kind == 3 ? Method::explicit_central : Method::modal;
  choice.modal.cells = {2, 2, 8};
  choice.modal.modes = 6;
  choice.modal.control_points = kind != 1 && kind != 7;
  choice.modal.moving = kind != 4;
  choice.drive = kind == 4 ? Drive::force : Drive::displacement;
  choice.modal.tuned = choice.inertia = kind >= 6;
  if (kind >= 6) choice.activation = ExcitationSource::phase;
  return choice;
}

SpawnRequest request(int i) {
  const SamplePerson of = sample_person(i);
  SpawnRequest made{of.body, of.gait, 0, 0, 0, {}};
  if (i % 8 != 5) made.muscles = muscles_of_kind(i % 8);
  return made;
}

Entity spawn_alone(Simulation& simulation, const SpawnRequest& request) {
  const auto person = simulation.spawn(request.body, request.gait);
  EXPECT_TRUE(person) << person.error().message;
  if (person && request.muscles) {
    EXPECT_TRUE(simulation.set_muscles(*person, *request.muscles));
  }
  return person.value_or(Entity{});
}

/// Returns an empty world that keeps the costly bases.
Simulation& empty_world(bool by_threads) {
  static Simulation threads(sharing({.threads = 2})), jobs(sharing({.jobs = backwards(2)}));
  Simulation& of = by_threads ? threads : jobs;
  const std::vector<Entity> all = of.people();
  EXPECT_EQ(of.despawn(all), Status::ok);
  return of;
}

/// Returns the hash of persons 0 to 35 after some ticks, each alone in the world.
std::uint64_t hash_alone(int i) {
  static Simulation simulation(sharing());
  static std::map<int, std::uint64_t> known;
  const auto at = known.find(i);
  if (at != known.end()) return at->second;
  const Entity person = spawn_alone(simulation, request(i));
  for (int t = 0; t < 3; ++t) simulation.tick();
  known[i] = hash_person(simulation, person);
  EXPECT_EQ(simulation.despawn(person), Status::ok);
  return known[i];
}

RC_GTEST_PROP(SpawnBatch, MatchesSingleSpawnsInAnyOrderOnAnyJobs, ()) {
  const auto who = *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 36));
  Simulation& simulation = empty_world(*rc::gen::arbitrary<bool>());
  std::vector<SpawnRequest> people;
  for (const int i : who) people.push_back(request(i));
  std::vector<Entity> made(people.size());
  const auto spawned = simulation.spawn(people, made);
  RC_ASSERT(spawned.has_value());
  for (int t = 0; t < 3; ++t) simulation.tick();
  for (std::size_t i = 0; i < who.size(); ++i) RC_ASSERT(hash_person(simulation, made[i]) == hash_alone(who[i]));
}

TEST(SpawnBatch, PeopleHaveTheirRequestedPlacesAndGaits) {
  Simulation simulation(sharing());
  std::vector<SpawnRequest> people(40);
  for (std::size_t i = 0; i < people.size(); ++i) {
    people[i] = request(static_cast<int>(i));
    people[i].muscles.reset();
    people[i].x_m = 3 * static_cast<float>(i);
    people[i].z_m = -2 * static_cast<float>(i);
    people[i].heading_rad = 0.1F * static_cast<float>(i);
  }
  std::vector<Entity> made(people.size());
  ASSERT_TRUE(simulation.spawn(people, made));
  for (int t = 0; t < 240; ++t) simulation.tick();
  for (std::size_t i = 0; i < people.size(); ++i) {
    const auto at = simulation.get<CentreOfMass>(made[i])->position_m;
    const float heading = people[i].heading_rad, dx = at.x - people[i].x_m, dz = at.z - people[i].z_m;
    const float ahead = dx * std::sin(heading) + dz * std::cos(heading);
    const float aside = dx * std::cos(heading) - dz * std::sin(heading);
    EXPECT_NEAR(ahead, *people[i].gait.speed_m_s * 4, 0.5F) << i;
    EXPECT_LT(std::abs(aside), 0.2F) << i;
    EXPECT_EQ(simulation.person(made[i])->gait.heading_rad, heading);
  }
}

TEST(SpawnBatch, OneInvalidRequestRefusesAllAndIsNamed) {
  Simulation simulation(sharing());
  std::vector<SpawnRequest> people(70);
  for (std::size_t i = 0; i < people.size(); ++i) people[i] = request(static_cast<int>(i % 3));
  std::vector<Entity> made(people.size());
  ASSERT_TRUE(simulation.spawn(people, made));
  const std::uint64_t before = hash_world(simulation);
  const auto refused = [&](std::size_t at, SpawnRequest wrong) {
    auto others = people;
    others[at] = wrong;
    std::vector<Entity> none(others.size());
    const auto spawned = simulation.spawn(others, none);
    ASSERT_FALSE(spawned);
    const std::string& message = spawned.error().message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
    EXPECT_EQ(message.rfind("spawn: person " + std::to_string(at) + ": ", 0), 0U) << message;
    EXPECT_EQ(hash_world(simulation), before);
    EXPECT_EQ(simulation.people().size(), people.size());
  };
  SpawnRequest wrong = people[0];
  wrong.body.height_m = 5;
  refused(0, wrong);
  wrong = people[0];
  wrong.gait.speed_m_s = 50;
  refused(69, wrong);
  wrong = people[0];
  wrong.x_m = NAN;
  refused(17, wrong);
  wrong = people[0];
  wrong.muscles = muscles_of_kind(1);
  wrong.muscles->muscles = 0;
  refused(33, wrong);
  wrong.muscles = muscles_of_kind(1);
  wrong.muscles->modal.modes = 33;
  refused(34, wrong);
  wrong.muscles = muscles_of_kind(3);
  wrong.muscles->dt_s = 0.016;
  refused(64, wrong);
  EXPECT_FALSE(simulation.spawn(people, std::span(made).first(3)));
  EXPECT_EQ(hash_world(simulation), before);
}

TEST(SpawnBatch, StaleOrRepeatedHandlesAreNotDespawned) {
  Simulation simulation(sharing());
  std::vector<SpawnRequest> people(20);
  for (std::size_t i = 0; i < people.size(); ++i) people[i] = request(static_cast<int>(i % 3));
  std::vector<Entity> made(people.size());
  ASSERT_TRUE(simulation.spawn(people, made));
  const Entity gone = spawn_alone(simulation, people[2]);
  ASSERT_EQ(simulation.despawn(gone), Status::ok);
  const std::uint64_t before = hash_world(simulation);
  const Entity muscle = simulation.muscles(made[0])[0].entity[0];
  for (const std::vector<Entity>& wrong : {std::vector<Entity>{made[1], made[2], made[1]}, {made[0], gone}, {muscle}}) {
    EXPECT_EQ(simulation.despawn(wrong), Status::stale_entity);
    EXPECT_EQ(hash_world(simulation), before);
    for (const Entity person : made) EXPECT_TRUE(simulation.person(person));
  }
}

TEST(SpawnBatch, PreparingChangesNoBits) {
  for (const int kind : {2, 3}) {
    Simulation simulation(sharing({.threads = 2}));
    ASSERT_TRUE(simulation.muscle_library().prepare(muscles_of_kind(kind)));
    std::vector<SpawnRequest> people = {request(kind), request(8 + kind), request(16 + kind)};
    std::vector<Entity> made(people.size());
    ASSERT_TRUE(simulation.spawn(people, made));
    for (int t = 0; t < 3; ++t) simulation.tick();
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(hash_person(simulation, made[static_cast<std::size_t>(i)]), hash_alone(8 * i + kind));
    }
  }
}

TEST(SpawnBatch, NothingIsPreparedForAChoiceOutOfRange) {
  Simulation simulation(sharing());
  LegMuscles wrong = muscles_of_kind(1);
  wrong.modal.modes = 40;
  const auto refused = simulation.muscle_library().prepare(wrong);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message.rfind("prepare: ", 0), 0U);
  EXPECT_EQ(refused.error().message.find('\n'), std::string::npos);
  wrong = muscles_of_kind(0);
  wrong.muscles = 0;
  EXPECT_FALSE(simulation.muscle_library().prepare(wrong));
}

RC_GTEST_PROP(SpawnBatch, SpawnsAndDespawnsLeaveOthersUnchanged, ()) {
  Simulation& simulation = empty_world(*rc::gen::arbitrary<bool>());
  std::vector<std::pair<Entity, int>> here;
  for (int round = 0; round < 5; ++round) {
    const auto who = *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 36));
    std::vector<SpawnRequest> people;
    for (const int i : who) people.push_back(request(i));
    std::vector<Entity> made(people.size());
    RC_ASSERT(simulation.spawn(people, made).has_value());
    for (std::size_t i = 0; i < who.size(); ++i) here.emplace_back(made[i], who[i]);
    std::vector<Entity> leave;
    std::vector<std::pair<Entity, int>> stay;
    for (const auto& one : here) {
      if (*rc::gen::arbitrary<bool>()) {
        leave.push_back(one.first);
      } else {
        stay.push_back(one);
      }
    }
    RC_ASSERT(simulation.despawn(leave) == Status::ok);
    for (const Entity gone : leave) RC_ASSERT(!simulation.person(gone));
    here = stay;
    RC_ASSERT(simulation.people().size() == here.size());
    std::size_t expected = here.size();
    for (const auto& [person, i] : here) expected += 2 * simulation.muscles(person).size();
    RC_ASSERT(rows(simulation.world()) == expected);
    for (const auto& [person, i] : here) {
      RC_ASSERT(simulation.muscles(person).size() == (request(i).muscles ? 2U : 0U));
    }
  }
  for (int t = 0; t < 3; ++t) simulation.tick();
  for (const auto& [person, i] : here) RC_ASSERT(hash_person(simulation, person) == hash_alone(i));
}

}  // namespace mobil::spawn_batch_test
