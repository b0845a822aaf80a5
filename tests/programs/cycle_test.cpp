// `mobil walk --cycle`, `--root-motion` and `--in-place`, and the same of crowds: animations that close, and ways that
// are those of the library's roots.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <mobil/engine/world.h>
#include <mobil/simulation.h>
#include <mobil/systems/muscles/person.h>
#include <mobil/systems/poses/roots.h>
#include <mobil/usual_gait.h>
#include "tests/files/export_fixture.h"
#include "tests/labels.h"
#include "tests/program/program.h"

MOBIL_TEST_LABELS("long");

namespace mobil::cycle_test {
using Eigen::Vector3d;
using export_fixture::Viewer;
using export_fixture::widened;

struct Written {
  TemporaryFolder folder;
  Ran ran;
  explicit Written(const std::string& options) : ran(run_mobil("walk --quiet --out out " + options, folder.path)) {
    EXPECT_EQ(ran.status, 0) << options << ": " << ran.err;
  }
  Viewer glb() const { return Viewer(folder.path / "out" / "walk.glb"); }
};

std::size_t keys_of(const Viewer& viewer) {
  std::size_t keys = 0;
  for (const auto& sampler : viewer.model.animations.at(0).samplers)
    keys = std::max(keys, viewer.floats(sampler.input).size());
  return keys;
}

/// Returns the largest change from the first key to the last of all channels but those of a node.
double gap(const Viewer& viewer, const std::string& but_node) {
  double largest = 0;
  const std::size_t last = keys_of(viewer) - 1;
  for (const auto& channel : viewer.model.animations.at(0).channels) {
    const auto n = static_cast<std::size_t>(channel.target_node);
    if (viewer.model.nodes[n].name == but_node && channel.target_path == "translation") continue;
    const auto first = viewer.key(n, channel.target_path, 0), end = viewer.key(n, channel.target_path, last);
    for (std::size_t i = 0; i < first.size(); ++i) largest = std::max(largest, std::abs(first[i] - end[i]));
  }
  return largest;
}

TEST(Cycle, LastKeyIsTheFirstOfAnyGaitWithSkinAndMuscles) {
  for (const char* const options :
       {"--cycle 1 --skin --skin-anatomy", "--cycle 2 --speed 2m/s --set step_asymmetry=0.1",
        "--cycle 1 --speed 2.2km/h --height 1.6 --sex woman --mass 90 --method static",
        "--cycle 1 --method modal --activation phase --inertia",
        "--cycle 3 --no-forces --muscles soleus --method newmark"}) {
    const Written written(std::string(options) + " --root-motion");
    const Viewer viewer = written.glb();
    EXPECT_LT(gap(viewer, "walker"), 1e-5) << options;
    const auto& extras = viewer.model.nodes[viewer.node.at("walker")].extras;
    const double stride_s = extras.Get("stride_s").GetNumberAsDouble(),
                 speed = extras.Get("speed_m_s").GetNumberAsDouble();
    const std::size_t keys = keys_of(viewer);
    const double strides = std::stod(std::string(options).substr(8, 1));
    const auto times = viewer.floats(viewer.model.animations[0].samplers[0].input);
    EXPECT_NEAR(static_cast<double>(times.back()), strides * stride_s, 1e-4) << options;
    EXPECT_NEAR(stride_s * strides / static_cast<double>(keys - 1), 1.0 / 30, 1e-3) << options;
    const auto begin = viewer.key(viewer.node.at("walker"), "translation", 0),
               end = viewer.key(viewer.node.at("walker"), "translation", keys - 1);
    EXPECT_EQ(begin, (std::vector<double>{0, 0, 0}));
    EXPECT_NEAR(end[2], strides * stride_s * speed, 2e-4 * end[2]) << options;
  }
}

TEST(Cycle, RootIsTheLibrarysAndThePelvisIsRelativeToIt) {
  const Written written("--cycle 1 --root-motion");
  const Viewer viewer = written.glb();
  const GaitRequest gait{.speed_m_s = static_cast<float>(5 / 3.6), .style = usual_style({})};
  Simulation asked;
  const float stride_s = 2 / asked.person(asked.spawn(BodyRequest{}, gait).value())->gait.step_frequency_hz;
  const std::size_t keys = keys_of(viewer), frames = keys - 1;
  Simulation simulation({.tick_s = static_cast<double>(stride_s) / (2.0 * static_cast<double>(frames))});
  const Entity person = simulation.spawn(BodyRequest{}, gait).value();
  simulation.tick(static_cast<std::uint32_t>(2 * frames * 4));
  Root first;
  for (std::size_t f = 0; f < keys; ++f) {
    simulation.tick(f == 0 ? 1 : 2);
    Root now;
    ASSERT_TRUE(simulation.roots({&person, 1}, {&now, 1}));
    if (f == 0) first = now;
    const auto place = viewer.key(viewer.node.at("walker"), "translation", f);
    EXPECT_NEAR(place[0], now.x_m - first.x_m, 1e-5);
    EXPECT_EQ(place[1], 0);
    EXPECT_NEAR(place[2], now.z_m - first.z_m, 1e-5);
    if (f == frames) continue;  // is closed
    const Pose<float> pose = *simulation.get<Pose>(person);
    for (std::size_t s = 0; s < segment_count; ++s) {
      const Vector3d expected = widened(pose.position_m[s]) - Vector3d(first.x_m, 0, first.z_m);
      const auto world = viewer.world(viewer.node.at(std::string(segment_name[s])), f);
      ASSERT_LT((world.translation() - expected).norm(), 2e-5) << segment_name[s] << " at " << f;
    }
  }
}

TEST(Cycle, InPlaceIsTheSameWithoutTheRootsWay) {
  const Written moving("--cycle 1 --root-motion --export walk.usda"), still("--cycle 1 --in-place --export walk.bvh");
  const Viewer with = moving.glb(), without = still.glb();
  EXPECT_TRUE(without.key(without.node.at("walker"), "translation", 0).empty());
  for (std::size_t f = 0; f < keys_of(with); ++f) {
    for (const std::string path : {"translation", "rotation"}) {
      const auto a = with.key(with.node.at("pelvis"), path, f), b = without.key(without.node.at("pelvis"), path, f);
      ASSERT_EQ(a.size(), b.size());
      for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 2e-6) << path << " at " << f;
    }
  }
  const std::string bvh = read_bytes(still.folder.path / "out" / "walk.bvh");
  std::istringstream lines(bvh.substr(bvh.find("Frame Time")));
  std::vector<std::vector<double>> rows;
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::istringstream row(line);
    rows.emplace_back(std::istream_iterator<double>(row), std::istream_iterator<double>());
  }
  ASSERT_EQ(rows.size(), 2 * (keys_of(with) - 1) + 1);  // every tick
  for (std::size_t i = 0; i < rows[0].size(); ++i) EXPECT_NEAR(rows.front()[i], rows.back()[i], 2e-3) << i;
  const std::string usd = read_bytes(moving.folder.path / "out" / "walk.usda");
  EXPECT_NE(usd.find("double3 xformOp:translate.timeSamples"), std::string::npos);
  EXPECT_NE(usd.find("uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:rotateY\"]"), std::string::npos);
}

TEST(Cycle, TurningWalksHaveTheirHeadingOnTheRoot) {
  const TemporaryFolder folder;
  std::ofstream(folder.path / "turn.csv") << "time_s,parameter,value\n0.5,heading,60\n";
  const Ran ran = run_mobil("walk --quiet --seconds 3 --script turn.csv --root-motion --out out", folder.path);
  ASSERT_EQ(ran.status, 0) << ran.err;
  const Viewer viewer(folder.path / "out" / "walk.glb");
  const std::size_t last = keys_of(viewer) - 1;
  const auto q = viewer.key(viewer.node.at("walker"), "rotation", last);
  EXPECT_NEAR(2 * std::atan2(q[1], q[3]), 60 * export_fixture::pi / 180, 0.02);
  for (std::size_t f = 0; f <= last; ++f) {
    const auto t = viewer.key(viewer.node.at("pelvis"), "translation", f);
    EXPECT_LT(std::hypot(t[0], t[2]), 0.15) << f;  // sways round the root
  }
}

TEST(Cycle, PeopleOfACrowdHaveTheirOwnRoots) {
  const TemporaryFolder folder;
  const std::string crowd = "crowd --people 6 --seconds 0.1 --tolerance 100mm --near 0 --export-seconds 1 --export ";
  for (const std::string way : {"--root-motion", "--in-place"}) {
    const Ran ran = run_mobil(crowd + "crowd.glb " + way, folder.path);
    ASSERT_EQ(ran.status, 0) << ran.err;
    const Viewer viewer(folder.path / "crowd.glb");
    std::size_t people = 0;
    for (const auto& [name, n] : viewer.node) {
      if (!viewer.model.nodes[n].extras.Has("height_m")) continue;
      ++people;
      const auto begin = viewer.key(n, "translation", 0), end = viewer.key(n, "translation", 30);
      const double way_m = std::hypot(end.at(0) - begin.at(0), end.at(2) - begin.at(2));
      EXPECT_TRUE(way == "--in-place" ? way_m == 0 : way_m > 0.2) << way << " " << way_m;
      const auto pelvis = viewer.key(viewer.node.at(name + "_pelvis"), "translation", 15);
      EXPECT_LT(std::hypot(pelvis.at(0), pelvis.at(2)), 0.15) << name;
    }
    EXPECT_EQ(people, 6U);
  }
}

TEST(Cycle, SenselessCombinationsAreRefusedInOneLine) {
  const TemporaryFolder folder;
  expect_refused("walk",
                 {{"--cycle 0", {"--cycle", "1 to 20"}},
                  {"--cycle 1.5", {"--cycle", "1 to 20"}},
                  {"--cycle 2 --seconds 3", {"--cycle", "--seconds"}},
                  {"--cycle 1 --ground slope:10%", {"--cycle", "--ground"}},
                  {"--cycle 1 --speed 0", {"--cycle", "--speed"}},
                  {"--root-motion --in-place", {"--root-motion", "--in-place"}},
                  {"--in-place --export a.mot", {"a.mot", "--in-place"}},
                  {"--skin-anatomy", {"--skin-anatomy", "--skin"}}},
                 folder.path);
  expect_refused("crowd",
                 {{"--root-motion", {"--root-motion", "--export"}},
                  {"--in-place --root-motion --export a.glb", {"--root-motion", "--in-place"}}},
                 folder.path);
}

}  // namespace mobil::cycle_test
