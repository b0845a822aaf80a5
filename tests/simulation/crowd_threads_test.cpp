// All work of a crowd on several threads, for ThreadSanitizer. The results equal those of one thread.
#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <thread>
#include <vector>

#include <mobil/each.h>
#include <mobil/engine/world.h>
#include <mobil/host_parts.h>
#include <mobil/pose_writer.h>
#include <mobil/step_report.h>
#include <mobil/systems/muscles/person.h>
#include <mobil/systems/surfaces/nodal_view.h>
#include "tests/engine/wilful_pool.h"
#include "tests/labels.h"
#include "tests/simulation/crowd_play.h"

MOBIL_TEST_LABELS("threads;slow");

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
  static const Hashes hashes = run(sharing());
  return hashes;
}

TEST(CrowdThreads, WorldsOnSeparateThreads) {
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

TEST(CrowdThreads, BatchSpawnAndDespawnAtOnce) {
  constexpr int many = 40;
  std::vector<SpawnRequest> requests;
  for (int i = 0; i < many; ++i) {
    const SamplePerson p = sample_person(i);
    SpawnRequest& request = requests.emplace_back();
    request.body = p.body;
    request.gait = p.gait;
    request.x_m = static_cast<float>(i);
    if (i % 3 != 0) request.muscles = play::choice_of(static_cast<std::uint64_t>(i));
  }
  const auto come_and_go = [&](const SimulationOptions& options) {
    Simulation simulation(sharing(options));
    std::vector<Entity> people(many), half;
    for (int round = 0; round < 2; ++round) {
      const auto done = simulation.spawn(requests, people);
      EXPECT_TRUE(done) << done.error().message;
      for (int i = 0; i < 5; ++i) simulation.tick();
      half.assign(people.begin() + many / 2, people.end());
      EXPECT_EQ(simulation.despawn(half), Status::ok);
    }
    std::vector<std::uint64_t> hashes;
    for (int i = 0; i < many / 2; ++i) hashes.push_back(hash_person(simulation, people[static_cast<std::size_t>(i)]));
    return hashes;
  };
  WilfulPool pool(3);
  const auto expected = come_and_go({});
  EXPECT_EQ(come_and_go({.threads = 2}), expected);
  EXPECT_EQ(come_and_go({.jobs = pool.jobs()}), expected);
}

/// Concurrent reads between changes, as simulation.h promises.
TEST(CrowdThreads, ConcurrentReadsAtOnce) {
  play::Crowd crowd(sharing(), script);
  for (int i = 0; i < 5; ++i) crowd.tick();
  const Simulation& simulation = crowd.simulation();
  std::vector<Entity> people = simulation.people();
  std::erase_if(people, [&](Entity person) { return (simulation.state(person) == PersonState::asleep); });
  std::vector<double> seen(4);
  {
    std::vector<std::jthread> readers;
    for (double& sum : seen) {
      readers.emplace_back([&simulation, &people, &sum] {
        PoseWriter writer;
        std::vector<std::byte> bytes(people.size() * segment_count * 28);
        EXPECT_TRUE(writer.write(simulation.world(), people, 0.01, {}, {bytes}));
        for (const Entity person : simulation.people()) {
          sum += static_cast<double>(simulation.get<Pose>(person)->position_m[0].y);
          sum += static_cast<double>(simulation.person(person)->body.request.height_m);
          for (const MuscleRef& own : simulation.muscles(person)) {
            sum += static_cast<double>(own.muscle) +
                   (nodal_displacement(simulation.world(), own.entity[Side::left]).first != nullptr);
          }
        }
        each(simulation.world(), [&sum](const Rows& rows, const Pose<Lanes<float>>& pose) {
          for (std::uint32_t lane = 0; lane < rows.live; ++lane) sum += static_cast<double>(pose.position_m[0].x[lane]);
        });
        sum += simulation.report().ticks + static_cast<double>(bytes[2]);
      });
    }
  }
  for (const double sum : seen) EXPECT_EQ(sum, seen[0]);
}

}  // namespace mobil::crowd_threads_test
