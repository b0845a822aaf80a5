// A window of the last ticks.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <map>
#include <type_traits>
#include <vector>

#include <mobil/lod.h>
#include <mobil/snapshot_file.h>
#include "tests/engine/counting_heap.h"
#include "tests/interfaces.h"
#include "tests/simulation/crowd_play.h"
#include "tests/simulation/people.h"

namespace mobil::rollback_test {
std::vector<Entity> fill(Simulation& simulation, int count, const LegMuscles& choice) {
  std::vector<Entity> people;
  for (int i = 0; i < count; ++i) {
    people.push_back(*simulation.spawn(sample_person(i).body, sample_person(i).gait));
    EXPECT_TRUE(simulation.set_muscles(people.back(), choice));
  }
  return people;
}

/// Makes the requests of a tick, determined by its number.
void steer(Simulation& simulation, const std::vector<Entity>& people) {
  const std::uint64_t draw = play::mixed(3, simulation.ticks(), 0);
  const Entity one = people[draw % people.size()];
  if (draw % 4 == 0) {
    ASSERT_TRUE(simulation.turn_to(one, static_cast<float>(draw % 7) - 3));
  }
  if (draw % 4 == 1) {
    ASSERT_TRUE(simulation.set_method(one, Muscle::hamstrings, play::every_method()[draw / 4 % 9]));
  }
}

TEST(Rollback, RerunsWithTheSameBitsFromAnyTick) {
  Simulation simulation(sharing());
  const auto people = fill(simulation, 7, play::choice_of(4));
  Rollback window(8);
  std::map<std::uint32_t, std::uint64_t> hashes;
  const auto run = [&](std::size_t ticks) {
    for (std::size_t t = 0; t < ticks; ++t) {
      ASSERT_TRUE(window.keep(simulation));
      const auto [at, anew] = hashes.try_emplace(simulation.ticks(), simulation.state_hash());
      ASSERT_TRUE(anew || at->second == simulation.state_hash()) << simulation.ticks();
      steer(simulation, people);
      simulation.tick();
    }
  };
  run(8);
  rc::check([&] {
    const auto times = *rc::gen::inRange<std::size_t>(1, window.depth() + 1);
    const std::uint32_t ticks = simulation.ticks();
    RC_ASSERT(window.back(simulation, times).has_value());
    RC_ASSERT(simulation.ticks() == ticks - times);
    run(times + *rc::gen::inRange<std::size_t>(0, 3));
    RC_ASSERT(window.depth() == 8U);
  });
}

TEST(Rollback, BeyondTheWindowIsRefused) {
  Simulation simulation(sharing());
  const auto people = fill(simulation, 2, play::choice_of(5));
  Rollback window(3);
  EXPECT_FALSE(window.back(simulation, 1));
  for (int tick = 0; tick < 5; ++tick) {
    ASSERT_TRUE(window.keep(simulation));
    simulation.tick();
  }
  EXPECT_EQ(window.depth(), 3U);
  EXPECT_FALSE(window.back(simulation, 4));
  EXPECT_FALSE(window.back(simulation, 0));
  EXPECT_EQ(simulation.ticks(), 5U);
  ASSERT_TRUE(window.back(simulation, 3));
  EXPECT_EQ(simulation.ticks(), 2U);
  EXPECT_EQ(window.depth(), 0U);
  EXPECT_FALSE(window.back(simulation, 1));
}

TEST(Rollback, SavingAndRestoringAllocatesNothing) {
  Simulation simulation(sharing());
  fill(simulation, 5, play::choice_of(4));
  Rollback window(4);
  const auto round = [&] {
    for (int tick = 0; tick < 6; ++tick) {
      ASSERT_TRUE(window.keep(simulation));
      simulation.tick();
    }
    ASSERT_TRUE(window.back(simulation, 3));
  };
  round();
  const std::size_t before = heap_requests;
  round();
  EXPECT_EQ(heap_requests, before);
}

TEST(Rollback, LevelOfDetailIsRolledBack) {
  Simulation simulation;
  Lod lod = lod_of(simulation, {.switches = 3, .stagger = 3, .machine_factor = 1});
  for (int i = 0; i < 40; ++i) {
    const Entity person = *simulation.spawn(sample_person(i).body, sample_person(i).gait);
    ASSERT_TRUE(lod.manage(person, {.muscles = 1}));
  }
  LodScene scene;
  scene.tolerance_m = 0.004F;
  scene.budget_s = 2e-5;
  const auto run = [&] {
    std::vector<std::uint64_t> hashes;
    for (int tick = 0; tick < 25; ++tick) {
      simulation.tick();
      hashes.push_back(simulation.state_hash());
    }
    return hashes;
  };
  ASSERT_TRUE(lod.set_scene(scene));
  run();
  scene.budget_s = 5e-5;
  ASSERT_TRUE(lod.set_scene(scene));
  Rollback window(1);
  ASSERT_TRUE(window.keep(simulation));
  const auto first = run();
  ASSERT_TRUE(window.back(simulation, 1));
  EXPECT_EQ(run(), first);
}

}  // namespace mobil::rollback_test
