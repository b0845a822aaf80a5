// `mobil town`, and the people of crowds.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include <mobil/components/footing.h>
#include <mobil/step_report.h>
#include "demo/scene/crowd_people.h"
#include "demo/town/town_map.h"
#include "demo/town/town_scene.h"
#include "tests/program/program.h"

namespace mobil::town_test {
namespace {

/// Returns the height of the ground. At an edge it is that of the lower side.
float lowest_near(float x_m, float z_m) {
  constexpr float e = 0.002F;
  return std::min({town_ground(x_m - e, z_m).height_m, town_ground(x_m + e, z_m).height_m,
                   town_ground(x_m, z_m - e).height_m, town_ground(x_m, z_m + e).height_m});
}

/// All people reach goals without collisions, on kerbs, stairs and ramp.
TEST(Town, PeopleReachGoalsWithoutCollisions) {
  auto made = TownScene::make({.people = 30, .seed = 3, .threads = 1});
  ASSERT_TRUE(made) << made.error().message;
  TownScene& scene = *made;
  float highest_m = 0;
  constexpr int seconds = 60;
  for (int tick = 0; tick < 60 * seconds; ++tick) {
    scene.tick();
    const Root guide = scene.guide();
    highest_m = std::max(highest_m, town_ground(static_cast<float>(guide.x_m), static_cast<float>(guide.z_m)).height_m);
    if (tick % 30 != 0) continue;
    for (const Entity person : scene.people()) {  // feet are not in the ground
      const Feet<float> feet = *scene.simulation().get<Feet>(person);
      const auto side = scene.simulation().get<GaitState>(person)->stance_side;
      for (const Vec3<float>& at : {feet.heel_m[side], feet.toe_m[side]})
        ASSERT_GT(at.y, lowest_near(at.x, at.z) - 0.05F) << "at " << at.x << ", " << at.z;
    }
  }
  const TownReport& report = scene.report();
  EXPECT_TRUE(scene.tour_over());
  EXPECT_GT(highest_m, 1);  // over the terrace
  EXPECT_GT(report.arrivals, 60U);
  EXPECT_GT(report.walked_m / seconds / 30, 0.8);
  EXPECT_GT(report.nearest_m, -0.05);
  EXPECT_LT(report.longest_wait_s, 20);
}

TEST(Town, PathsGoRoundWallsAndOverStairs) {
  const auto made = TownPaths::make();
  ASSERT_TRUE(made) << made.error().message;
  std::vector<GroundPoint> way;
  const auto places = town_places();
  for (const GroundPoint& from : places) {
    for (const GroundPoint& to : places) {
      if (&from == &to) continue;
      made->find(from, to, way);
      ASSERT_FALSE(way.empty());
      EXPECT_LT(std::hypot(way.back().x_m - to.x_m, way.back().z_m - to.z_m), 0.3F);
      GroundPoint at = from;
      for (const GroundPoint& corner : way) {
        for (int k = 0; k <= 50; ++k) {
          const float u = 0.02F * static_cast<float>(k);
          const float x = std::lerp(at.x_m, corner.x_m, u), z = std::lerp(at.z_m, corner.z_m, u);
          for (const TownBlock& block : town_blocks()) {
            const bool within = x > block.low_x_m && x < block.high_x_m && z > block.low_z_m && z < block.high_z_m;
            EXPECT_FALSE(within && block.use == TownBlock::Use::wall) << x << ", " << z;
          }
        }
        at = corner;
      }
    }
  }
}

TEST(Town, ReportMatchesTheRun) {
  const TemporaryFolder folder;
  const Ran ran = run_mobil("town --people 12 --seconds 5 --report town.json", folder.path);
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_NE(ran.out.find("12 people, 5 s"), std::string::npos);
  const auto report = nlohmann::json::parse(read_bytes(folder.path / "town.json"));
  EXPECT_EQ(report["people"], 12);
  EXPECT_GT(report["nearest_m"], -0.05);
  const Ran again = run_mobil("town --people 12 --seconds 5 --threads 1 --report again.json", folder.path);
  ASSERT_EQ(again.status, 0);
  EXPECT_EQ(report["state_hash"], nlohmann::json::parse(read_bytes(folder.path / "again.json"))["state_hash"]);
}

TEST(Town, InvalidOptionsAreRefusedInOneLine) {
  const TemporaryFolder folder;
  expect_refused("town",
                 {{"--people 0", {"--people 0", "1 to 300"}},
                  {"--seconds 0", {"--seconds", "0.1"}},
                  {"--view below", {"--view", "follow"}},
                  {"--capture town.gif", {"--capture town.gif", ".mp4"}},
                  {"--capture nowhere/town.png", {"--capture", "nowhere"}},
                  {"--report nowhere/town.json", {"--report", "nowhere"}}},
                 folder.path);
}

TEST(CrowdPeople, StandOnStraightLegs) {
  for (std::uint64_t number = 0; number < 60; ++number) {
    const CrowdPerson person = crowd_person(1, number, 0);
    Simulation simulation;
    GaitRequest stands = person.gait;
    stands.speed_m_s = 0;
    const Entity one = simulation.spawn(person.body, stands).value();
    simulation.tick(30);
    const JointAngles<float> angles = *simulation.get<JointAngles>(one);
    // The leg's spring does not stiffen with mass: heavy people bend their knees further.
    const float mass_index = person.body.mass_kg / (person.body.height_m * person.body.height_m);
    const float most_rad = mass_index < 27 ? 0.35F : 0.45F;
    for (const float knee : angles.knee_flexion) EXPECT_LT(knee, most_rad) << number;
  }
}

}  // namespace
}  // namespace mobil::town_test
