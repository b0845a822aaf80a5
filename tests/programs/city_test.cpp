// `mobil crowd` in several shards: refusals, and a state that is independent of threads and of interruptions. (Ranks by
// MPI: tests/cluster/mpi_test.sh.)
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/program/program.h"

namespace mobil::city_test {
using Json = nlohmann::json;

struct City {
  Json report;
  std::string out;
  std::string hash() const {
    return report["state_hash"].empty() ? "" : report["state_hash"].back().get<std::string>();
  }
};

City city(const std::string& arguments, const std::filesystem::path& in, const std::string& command = "crowd") {
  const Ran ran = run_mobil(command + " --quiet --report city.json " + arguments, in);
  EXPECT_EQ(ran.status, 0) << arguments << ": " << ran.err;
  EXPECT_EQ(ran.err, "") << arguments;
  return {Json::parse(read_bytes(in / "city.json"), nullptr, false), ran.out};
}

const std::string walkers = "--people 90 --shards 5 --effects none --churn 40 --burst 2 ";

TEST(City, StateIsIndependentOfThreads) {
  const TemporaryFolder folder;
  const City one = city(walkers + "--seconds 2 --threads 1", folder.path);
  const City two = city(walkers + "--seconds 2 --threads 2", folder.path);
  EXPECT_EQ(one.hash().size(), 16U);
  EXPECT_EQ(one.hash(), two.hash());
  EXPECT_EQ(one.report["people"], 90);
  EXPECT_EQ(one.report["shards"], 5);
  EXPECT_EQ(one.report["ticks"], 120);
  EXPECT_GE(one.report["spawns"].get<int>(), 80);
  EXPECT_EQ(one.report["spawns"], one.report["despawns"]);
  EXPECT_NE(one.out.find("90 people on 15 m x 15 m, 1 rank"), std::string::npos) << one.out;
  EXPECT_NE(one.out.find("state hash " + one.hash()), std::string::npos);
}

TEST(City, ResumesWhereItWasSaved) {
  const TemporaryFolder folder;
  const std::string whole = city(walkers + "--seconds 4", folder.path).hash();
  city(walkers + "--seconds 2.5 --save run --save-every 1s", folder.path);
  const City went_on = city(walkers + "--seconds 4 --resume run", folder.path);
  EXPECT_EQ(went_on.hash(), whole);
  EXPECT_LT(went_on.report["ticks"].get<int>(), 240 - 60) << "only what was left";
  EXPECT_GT(went_on.report["of_rank"][0]["replayed_ticks"].get<int>(), 0);
}

/// With muscles, some of them seen, whose methods change as people approach.
TEST(City, MusclesResumeWhereTheyWereSaved) {
  const TemporaryFolder folder;
  const std::string seen = "--people 50 --shards 3 --near 12 --seed 2 ";
  const City whole = city(seen + "--seconds 3 --threads 2", folder.path);
  EXPECT_GT(whole.report["muscles_by_method"].size(), 1U);
  city(seen + "--seconds 2 --save run --save-every 1.5s", folder.path);
  EXPECT_EQ(city(seen + "--seconds 3 --threads 1 --resume run", folder.path).hash(), whole.hash());
}

TEST(City, SleepersResume) {
  const TemporaryFolder folder;
  const std::string alive = "--people 1500 --in-view 150 --effects none --shards 3 --seed 4 ";
  const std::string whole = city(alive + "--seconds 12", folder.path, "city").hash();
  city(alive + "--seconds 8 --save run --save-every 3s", folder.path, "city");
  EXPECT_EQ(city(alive + "--seconds 12 --resume run", folder.path, "city").hash(), whole);
}

TEST(City, RefusesConflictingOptionsInOneLine) {
  const TemporaryFolder folder;
  expect_refused("crowd",
                 {{"--shards 0", {"--shards 0", "1 to 4096"}},
                  {"--shards 2 --raise", {"--raise", "--shards"}},
                  {"--shards 2 --frames 3 --capture dir", {"--frames", "--shards"}},
                  {"--shards 2 --export a.glb", {"--export", "--shards"}},
                  {"--save-every 2s", {"--save-every", "--shards", "mpirun"}},
                  {"--silence 2s", {"--silence", "--shards"}},
                  {"--shards 2 --save a --save-every 0", {"--save-every", "0.1 to 3600 s"}},
                  {"--shards 2 --silence 0.1s", {"--silence", "1 to 3600 s"}},
                  {"--save a --resume b", {"--save", "--resume"}},
                  {"--people 20 --effects none --resume nowhere", {"nowhere", "no snapshot", "--save"}}},
                 folder.path);
}

TEST(City, AnotherRunIsNotResumed) {
  const TemporaryFolder folder;
  city("--people 30 --shards 2 --effects none --seconds 0.5 --save run", folder.path);
  const Ran other = run_mobil("crowd --people 31 --shards 2 --effects none --seconds 1 --resume run", folder.path);
  EXPECT_EQ(other.status, 2);
  EXPECT_NE(other.err.find("--people 30"), std::string::npos) << other.err;
  EXPECT_NE(other.err.find("--people 31"), std::string::npos) << other.err;
  EXPECT_EQ(std::count(other.err.begin(), other.err.end(), '\n'), 1) << other.err;
}

}  // namespace mobil::city_test
