// Snapshot files that survive any end of the program.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <random>
#include <set>

#include <mobil/snapshot_file.h>
#include "tests/files/temporary_folder.h"
#include "tests/labels.h"
#include "tests/refused.h"
#include "tests/simulation/crowd_play.h"
#include "tests/simulation/people.h"

MOBIL_TEST_LABELS("threads");

namespace mobil::snapshot_file_test {
namespace fs = std::filesystem;

class SnapshotFile : public ::testing::Test {
 protected:
  fs::path file() const { return folder_.path / "crowd.snapshot"; }

  TemporaryFolder folder_;
};

void fill(Simulation& simulation) {
  for (int i = 0; i < 6; ++i) {
    const auto person = simulation.spawn(sample_person(i).body, sample_person(i).gait);
    ASSERT_TRUE(person);
    ASSERT_TRUE(simulation.set_muscles(*person, play::choice_of(static_cast<std::uint64_t>(i))));
  }
}

TEST_F(SnapshotFile, AnotherSimulationContinuesFromIt) {
  Simulation first(sharing()), second(sharing({.threads = 2}));
  fill(first);
  first.tick();
  ASSERT_TRUE(save_file(first, file()));
  const auto done = restore_file(second, file());
  ASSERT_TRUE(done) << done.error().message;
  for (int tick = 0; tick < 10; ++tick) {
    ASSERT_EQ(first.state_hash(), second.state_hash());
    first.tick();
    second.tick();
  }
  EXPECT_EQ(folder_.files(), 1U);
}

TEST_F(SnapshotFile, CutAlteredOrMissingFileIsRefusedByName) {
  Simulation simulation(sharing());
  fill(simulation);
  const std::uint64_t state = simulation.state_hash();
  const auto expect_refused = [&] {
    EXPECT_TRUE(is_refused(restore_file(simulation, file()), file().string()));
    EXPECT_EQ(simulation.state_hash(), state);
  };
  expect_refused();
  ASSERT_TRUE(save_file(simulation, file()));
  const auto size = fs::file_size(file());
  for (const auto length : {size - 1, size / 2, std::uintmax_t{1}, std::uintmax_t{0}}) {
    fs::resize_file(file(), length);
    expect_refused();
  }
  ASSERT_TRUE(save_file(simulation, file()));
  std::fstream(file(), std::ios::in | std::ios::out | std::ios::binary).seekp(static_cast<std::streamoff>(size / 2))
      << 'x';
  expect_refused();
}

TEST_F(SnapshotFile, FailedWritesKeepTheOldFile) {
  Simulation simulation(sharing());
  fill(simulation);
  EXPECT_TRUE(is_refused(save_file(simulation, folder_.path / "none" / "crowd.snapshot"), "none"));
  fs::create_directories(file() / "taken");
  EXPECT_FALSE(save_file(simulation, file()));
  EXPECT_TRUE(fs::is_directory(file() / "taken"));
  EXPECT_EQ(folder_.files(), 1U);
}

TEST_F(SnapshotFile, KillAtAnyTimeKeepsTheLastGoodFile) {
  Simulation simulation(sharing());
  fill(simulation);
  ASSERT_TRUE(save_file(simulation, file()));
  std::mt19937 random(5);
  std::set<std::uint32_t> ticks;
  unsigned longest_us = 20000;
  for (int round = 0; round < 40; ++round) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      for (;;) {
        simulation.tick();
        if (!save_file(simulation, file())) ::_exit(1);
      }
    }
    ::usleep(static_cast<useconds_t>(random() % longest_us));
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status));
    const auto done = restore_file(simulation, file());
    ASSERT_TRUE(done) << done.error().message;
    // A machine on which children make no progress gets more time.
    if (!ticks.insert(simulation.ticks()).second) longest_us = std::min(longest_us + longest_us / 2, 900000U);
  }
  EXPECT_GT(ticks.size(), 3U);  // children made progress
}

}  // namespace mobil::snapshot_file_test
