// The same people have the same bits for any partition and number of threads, on each instruction set, in any spawn
// order and next to any other world. With MOBIL_STATE_HASHES=FILE in the environment the hashes are written to that
// file as well, to compare builds (tests/run --long).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <map>
#include <random>
#include <set>
#include <vector>

#include <mobil/schedule.h>
#include <mobil/step_report.h>
#include "tests/engine/instruction_sets.h"
#include "tests/engine/wilful_pool.h"
#include "tests/labels.h"
#include "tests/simulation/crowd_play.h"

MOBIL_TEST_LABELS("threads;long");

namespace mobil::crowd_determinism_test {
constexpr int ticks = 120, apart = 30;
constexpr play::Script script{.avoidance = false};

/// Hashes by person's number, and of all people together, every `apart` ticks.
using Hashes = std::vector<std::map<int, std::uint64_t>>;

Hashes run(const SimulationOptions& options, const std::vector<int>& order = play::Crowd::in_turn(script)) {
  play::Crowd crowd(options, script, order);
  Hashes all;
  for (int i = 1; i <= ticks; ++i) {
    crowd.tick();
    if (i % apart == 0) all.push_back(crowd.hashes());
  }
  return all;
}

const Hashes& alone() {
  static const Hashes hashes = run(sharing());
  return hashes;
}

TEST(CrowdDeterminism, AllSystemsAndPeopleAreCovered) {
  MOBIL_SLOW();
  play::Crowd crowd({}, script);  // makes shared data itself
  Hashes seen_hashes;
  std::set<std::string_view> worked;
  std::set<int> seen;
  const auto note_work = [&](play::Crowd& at) {
    for (const SystemReport& system : at.simulation().report().systems)
      if (system.entities > 0) worked.insert(system.name);
  };
  for (int i = 0; i < ticks; ++i) {
    crowd.tick();
    for (const auto& [who, person] : crowd.people()) seen.insert(who);
    note_work(crowd);
    if ((i + 1) % apart == 0) seen_hashes.push_back(crowd.hashes());
  }
  EXPECT_EQ(seen_hashes, alone());
  play::Crowd avoiders(sharing(), play::Script{});
  avoiders.tick();
  note_work(avoiders);
  for (const System& system : crowd.simulation().schedule().systems())
    EXPECT_TRUE(worked.contains(system.name)) << system.name;
  EXPECT_EQ(seen.size(), static_cast<std::size_t>(script.everybody()));
  EXPECT_LT(crowd.people().size(), seen.size());
  // the compared hashes are mostly different
  std::set<std::uint64_t> different;
  std::size_t count = 0;
  for (const auto& hashes : alone()) {
    for (const auto& [who, hash] : hashes) different.insert(hash);
    count += hashes.size();
  }
  EXPECT_GT(different.size(), count * 95 / 100);  // people who stand asleep have equal hashes each quarter of a second
}

TEST(CrowdDeterminism, ThreadsDoNotMatter) {
  EXPECT_EQ(run({.threads = 2}), alone());
  EXPECT_EQ(run(sharing({.threads = 0})), alone());
  for (const std::size_t threads : {std::size_t{3}, std::size_t{8}}) {
    WilfulPool pool(threads);
    EXPECT_EQ(run(sharing({.jobs = pool.jobs()})), alone()) << threads << " threads";
  }
}

TEST(CrowdDeterminism, IndependentOfTheCallersPartition) {
  MOBIL_SLOW();
  EXPECT_EQ(run(sharing({.jobs = backwards()})), alone());
  WilfulPool more_than_promised(4, 2);
  EXPECT_EQ(run(sharing({.jobs = more_than_promised.jobs(1)})), alone());
}

TEST(CrowdDeterminism, InstructionSetsDoNotMatter) {
  MOBIL_SLOW();
  int sets = 0;
  const Hashes& reference = alone();
  for_each_fused_instruction_set([&] {
    EXPECT_EQ(run({}), reference) << hwy::TargetName(hwy::SupportedTargets() & -hwy::SupportedTargets());
    ++sets;
  });
  if (sets < 2) GTEST_SKIP() << "this machine has " << sets << " instruction sets with fused multiply-add";
}

TEST(CrowdDeterminism, SpawnOrderIndependent) {
  MOBIL_SLOW();
  std::mt19937 random(3);
  for (int i = 0; i < 2; ++i) {
    auto order = play::Crowd::in_turn(script);
    std::shuffle(order.begin(), order.end(), random);
    EXPECT_EQ(run(sharing(), order), alone());
  }
}

/// A person's bits do not depend on other people's requests or gaits.
TEST(CrowdDeterminism, IndependentOfOtherPeople) {
  MOBIL_SLOW();
  std::mt19937 random(5);
  for (const std::size_t size : {std::size_t{17}, std::size_t{1}}) {
    auto some = play::Crowd::in_turn(script);
    std::shuffle(some.begin(), some.end(), random);
    some.resize(size);
    const Hashes hashes = run(sharing(), some);
    for (std::size_t i = 0; i < hashes.size(); ++i) {
      for (const auto& [who, hash] : hashes[i])
        EXPECT_TRUE(who < 0 || hash == alone()[i].at(who)) << "person " << who << ", tick " << (i + 1) * apart;
    }
  }
}

TEST(CrowdDeterminism, TwoWorldsAtOnceAreIndependent) {
  MOBIL_SLOW();
  WilfulPool pool(2, 4);  // the same for both
  play::Crowd a(sharing({.jobs = pool.jobs()}), script);
  play::Crowd b(sharing({.tick_s = 1.0 / 50, .jobs = pool.jobs()}), {.seed = 2});
  Hashes in_a, in_b, b_alone;
  for (int i = 1; i <= ticks; ++i) {
    a.tick();
    if (i % 3 != 0) b.tick();
    if (i % apart == 0) {
      in_a.push_back(a.hashes());
      in_b.push_back(b.hashes());
    }
  }
  EXPECT_EQ(in_a, alone());
  play::Crowd same_as_b(sharing({.tick_s = 1.0 / 50}), {.seed = 2});
  for (int i = 1; i <= ticks / 3 * 2; ++i) {
    same_as_b.tick();
    if (i % (apart / 3 * 2) == 0) b_alone.push_back(same_as_b.hashes());
  }
  EXPECT_EQ(in_b, b_alone);
  EXPECT_NE(in_a, in_b);
}

TEST(CrowdDeterminism, HashesGoToAFileWhereOneIsNamed) {
  const char* file = std::getenv("MOBIL_STATE_HASHES");
  if (file == nullptr) GTEST_SKIP() << "MOBIL_STATE_HASHES names no file";
  std::ofstream out(file);
  for (std::size_t i = 0; i < alone().size(); ++i) {
    for (const auto& [who, hash] : alone()[i])
      out << (i + 1) * apart << ' ' << who << ' ' << std::hex << hash << std::dec << '\n';
  }
  EXPECT_TRUE(out.flush());
}

}  // namespace mobil::crowd_determinism_test
