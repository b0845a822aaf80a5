// Threads at work on everything that a crowd does, for ThreadSanitizer to watch; what comes of it is what one thread
// makes of it.
#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <thread>
#include <vector>

#include "tests/simulation/crowd_play.h"
#include "tests/simulation/crowd_pool.h"

namespace mobil::crowd_threads_test {
constexpr play::Script script{.at_first = 20, .comers = 8};
constexpr int ticks = 40;

using Hashes = std::map<int, std::uint64_t>;

Hashes run(const SimulationOptions& options) {
  play::Crowd crowd(options, script);
  for (int i = 0; i < ticks; ++i) crowd.tick();
  return crowd.hashes();
}

const Hashes& alone() {
  static const Hashes hashes = run({});
  return hashes;
}

TEST(CrowdThreads, TheBuiltInPool) {
  EXPECT_EQ(run({.threads = 2}), alone());
  EXPECT_EQ(run({.threads = 0}), alone());
}

TEST(CrowdThreads, MoreThanWerePromised) {
  WilfulPool pool(4);
  EXPECT_EQ(run({.jobs = pool.jobs(1)}), alone());
}

TEST(CrowdThreads, WorldsOnThreadsOfTheirOwn) {
  const Hashes& expected = alone();
  std::vector<Hashes> all(3);
  {
    std::vector<std::jthread> threads;
    for (Hashes& hashes : all) {
      threads.emplace_back([&hashes, pooled = &hashes == &all[0]] { hashes = run({.threads = pooled ? 2 : 1}); });
    }
  }
  for (const Hashes& hashes : all) EXPECT_EQ(hashes, expected);
}

TEST(CrowdThreads, ManyComeAndGoAtOnce) {
  constexpr int many = 40;
  std::vector<SpawnRequest> requests;
  for (int i = 0; i < many; ++i) {
    const Person p = person(i);
    SpawnRequest& request = requests.emplace_back();
    request.body = p.body;
    request.gait = p.gait;
    request.x_m = static_cast<float>(i);
    if (i % 3 != 0) request.muscles = play::choice_of(static_cast<std::uint64_t>(i));
  }
  const auto come_and_go = [&](const SimulationOptions& options) {
    Simulation simulation(options);
    std::vector<Entity> people(many), half;
    for (int round = 0; round < 2; ++round) {
      const auto done = simulation.spawn(requests, people);
      EXPECT_TRUE(done) << done.error().message;
      for (int i = 0; i < 5; ++i) simulation.tick();
      half.assign(people.begin() + many / 2, people.end());
      EXPECT_EQ(simulation.despawn(half), Status::ok);
    }
    std::vector<std::uint64_t> hashes;
    for (int i = 0; i < many / 2; ++i) hashes.push_back(hash_human(simulation, people[static_cast<std::size_t>(i)]));
    return hashes;
  };
  WilfulPool pool(3);
  const auto expected = come_and_go({});
  EXPECT_EQ(come_and_go({.threads = 2}), expected);
  EXPECT_EQ(come_and_go({.jobs = pool.jobs()}), expected);
}

}  // namespace mobil::crowd_threads_test
