// Sleepers match people who never slept to the bit; muscles match within the promised error.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/engine/world.h>
#include <mobil/forces.h>
#include <mobil/host_parts.h>
#include <mobil/rows.h>
#include <mobil/simulation.h>
#include <mobil/systems/muscles/person.h>
#include <mobil/systems/snapshot/restore_limits.h>
#include <mobil/systems/surfaces/nodal_view.h>
#include "demo/scene/crowd_people.h"
#include "systems/gait/asleep.h"
#include "systems/gait/gait.h"
#include "tests/engine/counting_heap.h"
#include "tests/simulation/simulation_hash.h"

namespace mobil::sleep_test {
namespace {

/// Equal people in two simulations. In one of them some sleep.
struct Twins {
  explicit Twins(std::size_t count, int threads = 1, bool muscles = false)
      : dozing({.threads = threads}), waking({.threads = threads}) {
    std::vector<SpawnRequest> requests;
    for (std::uint64_t number = 0; requests.size() < count; ++number) {
      const CrowdPerson person = crowd_person(7, number, 0);
      const CrowdPlace place = crowd_place(7, number);
      SpawnRequest request{.body = person.body, .gait = person.gait};
      if (number % 3 != 0) request.gait.style = snapped(person.gait.style);
      request.x_m = 400 * place.across;
      request.z_m = 400 * place.along;
      request.heading_rad = place.heading_rad;
      const auto body = make_body(request.body);
      if (!body || !resolve_gait(*body, request.gait)) continue;
      if (muscles) {
        request.muscles = LegMuscles{};
        request.muscles->method = Method::modal;
        request.muscles->modal.control_points = false;
      }
      requests.push_back(request);
    }
    for (Simulation* const one : {&dozing, &waking}) {
      auto& people = one == &dozing ? dozers : wakers;
      people.resize(count);
      EXPECT_TRUE(one->spawn(requests, people));
    }
    changes.resize(count);
  }
  void tick() {
    dozing.tick();
    waking.tick();
  }
  void tick(int count) {
    for (int i = 0; i < count; ++i) tick();
  }
  /// Makes the next change of a crowd's person.
  void change(std::size_t i) {
    const CrowdChange change = crowd_change(7, i, changes[i]++, changes[i] % 5 == 4);
    if (change.speed_m_s >= 0) {
      for (Simulation* const one : {&dozing, &waking})
        one->change_gait(one == &dozing ? dozers[i] : wakers[i], {.speed_m_s = change.speed_m_s});
    }
    if (change.turn_rad != 0) {
      const float heading = waking.get<Gait>(wakers[i])->heading_rad + change.turn_rad;
      EXPECT_TRUE(dozing.turn_to(dozers[i], heading));
      EXPECT_TRUE(waking.turn_to(wakers[i], heading));
    }
  }
  bool all_same(std::size_t i) const { return walk_alike(dozing, dozers[i], waking, wakers[i]); }
  std::size_t asleep() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(dozers, [&](Entity one) { return (dozing.state(one) == PersonState::asleep); }));
  }

  Simulation dozing{sharing()}, waking{sharing()};
  std::vector<Entity> dozers, wakers;
  std::vector<std::uint32_t> changes;
};

TEST(Sleep, WokenPeopleMatchNeverSleepingOnes) {
  Twins twins(160);
  std::mt19937 random(5);
  twins.tick(50);
  std::size_t slept = 0, woken = 0, most = 0, read = 0;
  for (int second = 0; second < 100; ++second) {
    std::vector<Entity> tired, rested;
    for (std::size_t i = 0; i < twins.dozers.size(); ++i) {
      const auto draw = random() % 100;
      if (draw < 7) twins.change(i);
      if (twins.dozing.state(twins.dozers[i]) == PersonState::asleep) {
        if (draw >= 90) rested.push_back(twins.dozers[i]);
      } else if (draw >= 30) {
        tired.push_back(twins.dozers[i]);
      }
    }
    const auto sleeping = twins.dozing.set_state(tired, PersonState::asleep);
    ASSERT_TRUE(sleeping) << sleeping.error().message;
    slept += *sleeping;
    ASSERT_TRUE(twins.dozing.set_state(rested, PersonState::full));
    woken += rested.size();
    most = std::max(most, twins.asleep());
    twins.tick(20 + static_cast<int>(random() % 30));
    for (auto i = static_cast<std::size_t>(second % 7); i < twins.dozers.size(); i += 7) {
      ASSERT_TRUE(twins.all_same(i)) << "person " << i << " in second " << second << ", "
                                     << ((twins.dozing.state(twins.dozers[i]) == PersonState::asleep) ? "asleep"
                                                                                                      : "awake");
      read += (twins.dozing.state(twins.dozers[i]) == PersonState::asleep) ? 1 : 0;
    }
  }
  ASSERT_TRUE(twins.dozing.set_state(twins.dozers, PersonState::full));
  EXPECT_EQ(twins.asleep(), 0U);
  EXPECT_EQ(twins.dozing.state_hash(), twins.waking.state_hash());
  EXPECT_GT(slept, 1000U);
  EXPECT_GT(woken, 500U);
  EXPECT_GT(most, 120U);
  EXPECT_GT(read, 1000U);
}

TEST(Sleep, RepeatedWakingAllocatesNothing) {
  Twins twins(200);
  Simulation& simulation = twins.dozing;
  twins.tick(200);
  const auto tired = std::span(twins.dozers).first(20);  // large shrinks of tables return memory
  for (int round = 0; round < 4; ++round) {
    ASSERT_GT(simulation.set_state(tired, PersonState::asleep).value(), 10U);
    const std::size_t before = heap_requests;
    const bool woken = simulation.set_state(tired, PersonState::full).has_value();
    const std::size_t requests = heap_requests - before;
    ASSERT_TRUE(woken);
    if (round > 0) {
      EXPECT_EQ(requests, 0U);
    }
    twins.tick(10);
  }
}

template <class F>
struct Mark {
  F value;
  UInt32<F> count;
};

TEST(Sleep, HostComponentsStay) {
  Simulation simulation({.modules = {{.name = "marks", .parts = {component_id<Mark>()}}}});
  const Entity person = *simulation.spawn({});
  ASSERT_TRUE(simulation.parts().add(person, Mark<float>{2.5F, 7}));
  ASSERT_EQ(simulation.set_state({&person, 1}, PersonState::asleep).value(), 1U);
  EXPECT_EQ(simulation.get<Mark>(person)->value, 2.5F);
  ASSERT_TRUE(simulation.parts().set(person, Mark<float>{3.5F, 8}));
  simulation.tick();
  ASSERT_TRUE(simulation.set_state({&person, 1}, PersonState::full));
  EXPECT_NE(simulation.state(person), PersonState::asleep);
  EXPECT_EQ(simulation.get<Mark>(person)->value, 3.5F);
  EXPECT_EQ(simulation.get<Mark>(person)->count, 8U);
}

TEST(Sleep, ForcesAndMusclesAreRestored) {
  Simulation simulation(sharing());
  const Entity person = *simulation.spawn({});
  LegMuscles choice;
  choice.method = Method::modal;
  choice.inertia = true;
  choice.muscles = MuscleSet(5);
  ASSERT_TRUE(simulation.enable(person, Feature::forces));
  ASSERT_TRUE(simulation.set_muscles(person, choice));
  const Entity muscle = simulation.muscle(person, Muscle::hamstrings, Side::right);
  for (int i = 0; i < 30; ++i) simulation.tick();
  ASSERT_EQ(simulation.set_state({&person, 1}, PersonState::asleep).value(), 1U);
  EXPECT_TRUE(simulation.is_person(person));
  EXPECT_EQ(simulation.people(), std::vector{person});
  EXPECT_TRUE(simulation.muscles(person).empty());
  EXPECT_FALSE(simulation.get<LineOfAction>(muscle));
  EXPECT_EQ(simulation.person(person)->leg_muscles, choice);
  simulation.tick();
  ASSERT_TRUE(simulation.set_state({&person, 1}, PersonState::full));
  EXPECT_TRUE(simulation.get<GroundReaction>(person));
  EXPECT_EQ(simulation.person(person)->leg_muscles, choice);
  EXPECT_EQ(simulation.muscles(person).size(), 2U);
  EXPECT_EQ(simulation.method(person, Muscle::hamstrings).method, Method::modal);
}

/// A person who sleeps, and an equal one who never does, with muscles.
struct MuscleTwins {
  Simulation dozes{sharing()}, wakes{sharing()};
  Entity sleeper, waker;

  MuscleTwins(const SpawnRequest& request) {
    for (const auto& [simulation, person] : {std::pair{&dozes, &sleeper}, std::pair{&wakes, &waker}}) {
      EXPECT_TRUE(simulation->spawn({&request, 1}, {person, 1}));
      for (int i = 0; i < 120; ++i) simulation->tick();
    }
    EXPECT_EQ(dozes.set_state({&sleeper, 1}, PersonState::asleep).value(), 1U);
    tick(303);
  }
  void tick(int count) {
    for (int i = 0; i < count; ++i) dozes.tick(), wakes.tick();
  }
  /// Returns the largest distance between control points, m.
  double off_m() const {
    double most = 0;
    for (const MuscleRef& own : wakes.muscles(waker)) {
      for (const Side side : {Side::right, Side::left}) {
        const NodalView a = nodal_displacement(dozes.world(), dozes.muscle(sleeper, own.muscle, side));
        const NodalView b = nodal_displacement(wakes.world(), own.entity[side]);
        EXPECT_EQ(a.nodes, b.nodes);
        for (std::size_t w = 0; w < std::size_t{3} * b.nodes; ++w)
          most = std::max(most, std::abs(double{a.first[w * lane_count]} - double{b.first[w * lane_count]}));
      }
    }
    return most;
  }
};

SpawnRequest with_muscles(std::uint64_t number, Method method) {
  const CrowdPerson person = crowd_person(7, number, 0);
  SpawnRequest request{.body = person.body, .gait = person.gait, .muscles = LegMuscles{}};
  request.muscles->method = method;
  return request;
}

TEST(Sleep, MusclesAtRestOnWakingConverge) {
  MuscleTwins twins(with_muscles(1, Method::modal));
  ASSERT_TRUE(twins.dozes.set_state({&twins.sleeper, 1}, PersonState::full, 1));
  EXPECT_GT(twins.off_m(), 1e-4);
  EXPECT_LT(twins.off_m(), 0.015);
  twins.tick(30);
  EXPECT_LT(twins.off_m(), 0.005);
  twins.tick(30);
  EXPECT_LT(twins.off_m(), 0.001);
  twins.tick(60);
  EXPECT_LT(twins.off_m(), 2e-5);
}

TEST(Sleep, MusclesWarmUpToTheRequestedError) {
  for (const std::uint64_t number : {2U, 8U}) {
    for (const float within_m : {0.005F, 0.001F, 4e-6F}) {
      MuscleTwins twins(with_muscles(number, Method::modal));
      ASSERT_TRUE(twins.dozes.set_state({&twins.sleeper, 1}, PersonState::full, within_m));
      EXPECT_LT(twins.off_m(), double{within_m}) << "person " << number;
      const double first = twins.off_m();
      twins.tick(1);
      EXPECT_LT(twins.off_m(), 2 * first + 1e-6) << "person " << number;
    }
  }
  // With any method: here the full mesh, step by step.
  MuscleTwins twins(with_muscles(4, Method::explicit_central));
  ASSERT_TRUE(twins.dozes.set_state({&twins.sleeper, 1}, PersonState::full, 0.001F));
  EXPECT_LT(twins.off_m(), 0.001);
}

TEST(Sleep, SnapshotsIncludeSleepers) {
  Twins twins(64);
  twins.tick(60);
  ASSERT_TRUE(twins.dozing.set_state(twins.dozers, PersonState::asleep));
  EXPECT_LT(twins.dozing.snapshot_bytes(), 64U * 400);
  for (std::size_t i = 0; i < 64; i += 2) twins.change(i);
  twins.tick(5);
  std::vector<std::byte> bytes(twins.dozing.snapshot_bytes());
  ASSERT_TRUE(twins.dozing.save(bytes));
  Simulation other(sharing());
  const auto restored = other.restore(bytes, RestoreLimits::none());
  ASSERT_TRUE(restored) << restored.error().message;
  EXPECT_EQ(other.state_hash(), twins.dozing.state_hash());
  for (int i = 0; i < 200; ++i) other.tick();
  twins.tick(200);
  EXPECT_EQ(other.state_hash(), twins.dozing.state_hash());
  ASSERT_TRUE(other.set_state(twins.dozers, PersonState::full));
  EXPECT_EQ(other.state_hash(), twins.waking.state_hash());
}

TEST(Sleep, KeepsSexAndAge) {
  Simulation simulation(sharing());
  std::vector<Entity> people;
  for (const auto& [sex, age_y] : {std::pair{Sex::man, 8.5F}, {Sex::woman, 67.0F}, {Sex::man, 25.0F}})
    people.push_back(*simulation.spawn(typical_body(sex, age_y)));
  for (int i = 0; i < 60; ++i) simulation.tick();
  std::vector<Person> awake;
  for (const Entity one : people) awake.push_back(*simulation.person(one));
  ASSERT_EQ(*simulation.set_state(people, PersonState::asleep), people.size());
  std::vector<std::byte> bytes(simulation.snapshot_bytes());
  ASSERT_TRUE(simulation.save(bytes));
  Simulation other(sharing());
  ASSERT_TRUE(other.restore(bytes, RestoreLimits::none()));
  ASSERT_TRUE(other.set_state(people, PersonState::full));
  for (std::size_t i = 0; i < people.size(); ++i) {
    for (const Simulation* one : {&simulation, &other}) {  // asleep and woken
      const auto person = one->person(people[i]);
      EXPECT_EQ(person->body.request.age_y, awake[i].body.request.age_y);
      EXPECT_EQ(person->body.request.sex, awake[i].body.request.sex);
      EXPECT_EQ(person->body.mass_kg, awake[i].body.mass_kg);
    }
  }
}

TEST(Sleep, PeopleUnableToSleepStayAwake) {
  Simulation simulation(sharing());
  const Entity posed = *simulation.spawn_posed({});
  GaitRequest limps;
  limps.style.step_asymmetry = 0.1F;
  const Entity uneven = *simulation.spawn({}, limps);
  const Entity turning = *simulation.spawn({});
  ASSERT_TRUE(simulation.turn_to(turning, 1));
  const Entity unlike = *simulation.spawn({});
  LegMuscles choice;
  choice.method = Method::modal;
  ASSERT_TRUE(simulation.set_muscles(unlike, choice));
  ASSERT_TRUE(simulation.set_method(unlike, Muscle::hamstrings, {Method::statics}));
  for (int i = 0; i < 3; ++i) simulation.tick();
  const std::vector<Entity> all = {posed, uneven, turning, unlike};
  EXPECT_EQ(simulation.set_state(all, PersonState::asleep).value(), 0U);
  for (const Entity person : all) EXPECT_NE(simulation.state(person), PersonState::asleep);
  const std::vector<Entity> twice = {turning, turning};
  EXPECT_FALSE(simulation.set_state(twice, PersonState::asleep));
  EXPECT_FALSE(simulation.set_state(twice, PersonState::full));
  ASSERT_TRUE(simulation.despawn(turning));
  EXPECT_FALSE(simulation.set_state(all, PersonState::asleep));
  EXPECT_NE(simulation.state(turning), PersonState::asleep);
}

TEST(Sleep, UnsupportedRequestsWakeSleepers) {
  Simulation simulation(sharing());
  const auto asleep = [&] {
    const Entity person = *simulation.spawn({}, {.speed_m_s = 0.0F});
    EXPECT_EQ(simulation.set_state({&person, 1}, PersonState::asleep).value(), 1U);
    return person;
  };
  Entity person = asleep();
  ASSERT_TRUE(simulation.step_aside(person, 0.1F, 0));
  EXPECT_NE(simulation.state(person), PersonState::asleep);
  person = asleep();
  ASSERT_TRUE(simulation.place(person, 3, 4, 1));  // sleepers can be placed
  EXPECT_EQ(simulation.state(person), PersonState::asleep);
  person = asleep();
  GaitChange lopsided;
  lopsided.style = GaitStyle{.toe_out_deg = 9};
  ASSERT_TRUE(simulation.change_gait(person, lopsided));
  EXPECT_NE(simulation.state(person), PersonState::asleep);
  person = asleep();
  ASSERT_TRUE(simulation.change_gait(person, {.speed_m_s = 1.2F}));
  EXPECT_EQ(simulation.state(person), PersonState::asleep);
  ASSERT_TRUE(simulation.turn_to(person, 1));  // at once: part of the same request
  EXPECT_EQ(simulation.state(person), PersonState::asleep);
  simulation.tick();
  ASSERT_TRUE(simulation.turn_to(person, 2));
  EXPECT_NE(simulation.state(person), PersonState::asleep);
  person = asleep();
  ASSERT_TRUE(simulation.change_gait(person, {.speed_m_s = 1.2F}));
  EXPECT_FALSE(simulation.change_gait(person, {.speed_m_s = 12.0F}));
  EXPECT_EQ(simulation.state(person), PersonState::asleep);
  EXPECT_FLOAT_EQ(*simulation.gait_request(person)->speed_m_s, 1.2F);
  ASSERT_TRUE(simulation.despawn(person));
  EXPECT_FALSE(simulation.is_person(person));
}

}  // namespace
}  // namespace mobil::sleep_test
