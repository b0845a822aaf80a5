// `mobil crowd`: refusals, consistent figures of its report, and a crowd that is determined by its seed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "demo/bake/baked_file.h"
#include "demo/crowd/crowd_run.h"
#include "demo/crowd/crowd_scene.h"
#include "demo/crowd/heap_count.h"
#include "demo/scene/crowd_people.h"
#include "tests/program/program.h"

namespace mobil::crowd_command_test {
using Json = nlohmann::json;

/// Returns the report of a crowd with those arguments.
Json report_of(const std::string& arguments, const std::string& command = "crowd") {
  const TemporaryFolder folder;
  const Ran ran = run_mobil(command + " --quiet --report crowd.json " + arguments, folder.path);
  EXPECT_EQ(ran.status, 0) << arguments << ": " << ran.err;
  EXPECT_EQ(ran.err, "") << arguments;
  return Json::parse(read_bytes(folder.path / "crowd.json"), nullptr, false);
}

// All muscles are lines only, so no bases have to be made first.
const std::string lines_alone = "--tolerance 100mm --near 0 ";

TEST(CrowdCommand, RefusesValuesOutOfRangeInOneLine) {
  const TemporaryFolder folder;
  expect_refused("crowd",
                 {{"--people 0", {"--people 0", "1 to 200000"}},
                  {"--people many", {"--people many", "1 to 200000"}},
                  {"--seconds 0", {"--seconds", "0.1 to 3600 s"}},
                  {"--seconds 5km/h", {"--seconds", "unknown unit"}},
                  {"--threads 257", {"--threads 257", "0 to 256"}},
                  {"--seed -1", {"--seed"}},
                  {"--churn -3", {"--churn", "0 to 100000"}},
                  {"--people 10 --burst 11", {"--burst 11", "0 to 10"}},
                  {"--tolerance 2m", {"--tolerance", "1e-05 to 1 m"}},
                  {"--near-tolerance 0", {"--near-tolerance"}},
                  {"--near x", {"--near x"}},
                  {"--budget 0", {"--budget"}},
                  {"--budget 1 --effects none", {"--budget", "add muscles"}},
                  {"--effects wings", {"'wings'", "muscles, forces, inertia, line-motion, activation"}},
                  {"--effects inertia", {"add muscles"}},
                  {"--effects ''", {"--effects", "empty"}},
                  {"--muscles wings", {"--muscles 'wings'", "usual, groups, all"}},
                  {"--report missing/crowd.json", {"--report", "no folder missing"}},
                  {"--capture crowd.jpg", {"--capture", ".png"}},
                  {"--frames 3", {"--frames", "--capture"}},
                  {"--raise --capture crowd.png", {"--raise"}},
                  {"--person 3", {"there is no option --person", "--people"}}},
                 folder.path);
  expect_refused("city",
                 {{"--people 10", {"--people 10", "100 to 20000000"}},
                  {"--people 1000 --in-view 300", {"--in-view 300", "quarter"}},
                  {"--churn 3", {"there is no option --churn"}}},
                 folder.path);
  expect_refused("bake", {{"--muscles soleus,wings", {"--muscles", "'wings'", "usual, groups, all"}}}, folder.path);
}

TEST(CrowdCommand, ReportHasEveryFigureAndTheyAgree) {
  const Json report =
      report_of("--people 40 --seconds 2.5 --threads 2 --seed 7 --effects muscles,forces " + lines_alone);
  ASSERT_TRUE(report.is_object());
  for (const char* key : {"people",
                          "muscles_by_method",
                          "ticks",
                          "missed_ticks",
                          "tick_ms_p50",
                          "tick_ms_p99",
                          "tick_ms_max",
                          "tick_cpu_ms_p50",
                          "tick_cpu_ms_p99",
                          "system_ms",
                          "host_ms",
                          "lod_ms",
                          "bytes_per_person",
                          "far_bytes_per_person",
                          "peak_bytes",
                          "steady_allocations",
                          "steady_ticks",
                          "spawns",
                          "despawns",
                          "state_hash",
                          "threads",
                          "machine",
                          "seed",
                          "options"}) {
    EXPECT_TRUE(report.contains(key)) << key;
  }
  EXPECT_EQ(report["people"], 40);
  EXPECT_EQ(report["seed"], 7);
  EXPECT_EQ(report["ticks"], 150);
  EXPECT_EQ(report["state_hash"].size(), 3U);  // each second, and the last tick
  EXPECT_NE(report["state_hash"][0], report["state_hash"][1]);
  EXPECT_LE(report["missed_ticks"], report["ticks"]);
  EXPECT_LE(report["steady_ticks"], report["ticks"]);
  EXPECT_LE(report["tick_ms_p50"], report["tick_ms_p99"]);
  EXPECT_LE(report["tick_ms_p99"], report["tick_ms_max"]);
  EXPECT_GT(report["tick_ms_p50"], 0);
  EXPECT_GT(report["tick_cpu_ms_p50"], 0);
  EXPECT_GT(report["system_ms"]["kinematics"], 0);
  EXPECT_GT(report["system_ms"]["forces"], 0);
  EXPECT_GT(report["far_bytes_per_person"], 1000);
  EXPECT_GT(report["peak_bytes"], 1e6);
  EXPECT_EQ(report["options"]["effects"], Json({"muscles", "forces"}));
  std::size_t muscles = 0;
  for (const auto& [method, count] : report["muscles_by_method"].items()) muscles += count.get<std::size_t>();
  EXPECT_EQ(muscles, 40U * 8U);
  if (heap_is_counted()) {
    EXPECT_EQ(report["steady_allocations"], 0);
  }
}

TEST(CrowdCommand, PeopleHaveTheChosenMuscles) {
  for (const auto& [names, count] : {std::pair("groups", 12U), std::pair("soleus,iliopsoas", 2U)}) {
    const Json report =
        report_of("--people 10 --seconds 0.5 --muscles " + std::string(names) + " --tolerance 1m --near 0");
    std::size_t muscles = 0;
    for (const auto& [method, those] : report["muscles_by_method"].items()) muscles += those.get<std::size_t>();
    EXPECT_EQ(muscles, 10U * 2 * count) << names;
    EXPECT_NE(report["options"]["muscles"].get<std::string>().find("iliopsoas"), std::string::npos) << names;
  }
}

TEST(CrowdCommand, AnotherSeedGivesAnotherCrowd) {
  const std::string asked = "--people 20 --seconds 1 --effects none ";
  const Json first = report_of(asked + "--seed 1"), again = report_of(asked + "--seed 1"),
             other = report_of(asked + "--seed 2");
  EXPECT_EQ(first["state_hash"], again["state_hash"]);
  EXPECT_NE(first["state_hash"], other["state_hash"]);
}

TEST(CrowdCommand, MostPeopleSleepAndDependOnlyOnTheSeed) {
  const std::string asked = "--people 4000 --in-view 300 --seconds 2 --effects none --seed 5 --threads ";
  const Json one = report_of(asked + "1", "city"), two = report_of(asked + "2", "city");
  ASSERT_TRUE(one.is_object());
  EXPECT_EQ(one["alive"], 4000);
  EXPECT_EQ(one["ticks"], 120);
  EXPECT_EQ(one["state_hash"].size(), 2U);
  EXPECT_EQ(one["state_hash"], two["state_hash"]);
  EXPECT_NEAR(one["seen"].get<double>(), 300, 90);
  EXPECT_LT(one["awake"].get<double>(), 2000);
  EXPECT_GT(one["asked"].get<double>(), 100);
  EXPECT_GT(one["woken"].get<double>(), 300);
  EXPECT_GT(one["slept"].get<double>(), 0);
  EXPECT_GT(one["tick_ms_p99"].get<double>(), 0);
}

TEST(CrowdCommand, SpawnsEqualDespawns) {
  const Json report = report_of("--people 30 --seconds 4 --churn 12 --burst 5 " + lines_alone);
  EXPECT_EQ(report["people"], 30);
  EXPECT_EQ(report["spawns"], report["despawns"]);
  EXPECT_EQ(report["spawns"], 4 * (12 + 5));
  EXPECT_LT(report["steady_ticks"], report["ticks"]);
}

TEST(CrowdScene, IsRaisedUntilTicksAreMissedOrTheLimit) {
  constexpr std::size_t most = 50;
  CrowdRequest request;
  request.people = 8;
  request.effects.muscles = false;
  auto scene = CrowdScene::make(request);
  ASSERT_TRUE(scene) << scene.error().message;
  std::size_t told = 0;
  const auto limit = raise_crowd(**scene, 3, most, [&](const CrowdLimit::Tried&) { ++told; }, {});
  ASSERT_TRUE(limit) << limit.error().message;
  EXPECT_EQ(told, limit->tried.size());
  EXPECT_EQ(limit->tried.front().people, 8U);
  if (limit->missed_with == 0) {
    EXPECT_EQ(limit->people, most);
    EXPECT_EQ((*scene)->walkers().size(), most);
  } else {
    EXPECT_LT(limit->people, limit->missed_with);
  }
}

TEST(CrowdScene, PeopleReturnToTheSquare) {
  CrowdRequest request;
  request.people = 60;
  request.effects.muscles = false;
  auto made = CrowdScene::make(request);
  ASSERT_TRUE(made) << made.error().message;
  CrowdScene& scene = **made;
  float farthest_m = 0;
  for (int tick = 0; tick < 60 * 60; ++tick) {
    ASSERT_TRUE(scene.decide());
    scene.tick();
    for (const CrowdWalker& walker : scene.walkers()) {
      farthest_m = std::max({farthest_m, std::abs(walker.x_m), std::abs(walker.z_m)});
    }
  }
  const double half_m = 0.5 * scene.side_m();
  EXPECT_GT(farthest_m, half_m);       // they do get there,
  EXPECT_LT(farthest_m, half_m + 15);  // and turn within the steps of a turn
}

TEST(CrowdPeople, PeopleFollowFromNumberAndSeed) {
  std::set<float> heights;
  for (std::uint64_t number = 0; number < 1000; ++number) {
    const CrowdPerson person = crowd_person(3, number, 0), same = crowd_person(3, number, 0);
    EXPECT_EQ(person.body.height_m, same.body.height_m);
    EXPECT_EQ(person.gait.speed_m_s, same.gait.speed_m_s);
    heights.insert(person.body.height_m);
    const CrowdPlace place = crowd_place(3, number);
    EXPECT_LE(std::max(std::abs(place.across), std::abs(place.along)), 0.5F);
  }
  EXPECT_GT(heights.size(), 990U);
}

}  // namespace mobil::crowd_command_test
