// Walks in MuJoCo: its inverse dynamics of the exported motion have mobil's joint moments and leave little at the root.
#include <gtest/gtest.h>

#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tests/labels.h"
#include "tests/program/program.h"

MOBIL_TEST_LABELS("long");

namespace mobil::mujoco_test {

struct MujocoWalk {
  const char* name;
  double mass_kg;
  bool steady;
  const char* arguments;
  double roll_nm_kg = 0.02, moment_nm = 1;
};
// In fast walks the soles are too narrow to balance roll. Slender rods of the legs cost 1 % of the hip's moment.
const MujocoWalk walks[] = {
    {"usual", 80, true, "--height 1.80 --mass 80 --speed 5km/h"},
    {"slow", 80, true, "--height 1.80 --mass 80 --speed 0.8"},
    {"fast", 80, true, "--height 1.80 --mass 80 --speed 2.0", 0.04},
    {"heavy", 95, true, "--height 1.65 --mass 95 --speed 1.2 --constitution heavy"},
    {"turn", 80, false, "--height 1.80 --mass 80 --speed 5km/h --script turn.csv", 0, 1.2},
};

using Results = std::map<std::string, std::vector<double>>;
Results parsed(const std::string& text) {
  Results results;
  std::istringstream lines(text);
  for (std::string line, name; std::getline(lines, line);) {
    std::istringstream in(line);
    in >> name;
    for (double value = 0; in >> value;) results[name].push_back(value);
  }
  return results;
}

class Mujoco : public ::testing::TestWithParam<MujocoWalk> {};

TEST_P(Mujoco, HasTheSameMomentsAndLittleResidual) {
  const MujocoWalk& walk = GetParam();
  const TemporaryFolder folder;
  std::ofstream(folder.path / "turn.csv") << "time_s,parameter,value\n0.6,heading,57.3\n0.6,speed,1.7\n";
  const Ran ran =
      run_mobil(fmt::format("walk {} --seconds {} --method none --muscles single --export walk.xml --out out",
                            walk.arguments, walk.steady ? 2 : 4),
                folder.path);
  ASSERT_EQ(ran.status, 0) << ran.err;
  const Ran node = run_shell("node '" MOBIL_SOURCE_DIR "/tests/hosts/inverse_dynamics.mjs' out", folder.path);
  if (node.status == 77 || node.status == 127) GTEST_SKIP() << node.err;
  ASSERT_EQ(node.status, 0) << node.out << node.err;
  RecordProperty("results", node.out);
  const Results results = parsed(node.out);
  const auto of = [&](const std::string& name, std::size_t i) { return results.at(name).at(i); };
  constexpr std::size_t rms = 2;

  EXPECT_NEAR(of("mass", 0), walk.mass_kg, 1e-3);
  EXPECT_LT(of("keyframe", 0), 1e-6);
  EXPECT_LT(of("centre", 1), 0.01);
  EXPECT_EQ(of("limits", 0), 0) << "a walk passes a joint's range";
  for (const char* moment : {"hip", "abduction"}) EXPECT_LT(of(moment, rms), walk.moment_nm) << moment;
  EXPECT_LT(of("knee", rms), 0.7);
  for (const char* moment : {"rotation", "ankle"}) EXPECT_LT(of(moment, rms), 0.3) << moment;
  EXPECT_LT(of("force", 0), 0.005 * 9.81 * walk.mass_kg);
  if (walk.steady) {
    EXPECT_LT(of("pitch", 0), 0.02 * walk.mass_kg);
    EXPECT_LT(of("roll", 0), walk.roll_nm_kg * walk.mass_kg);
    EXPECT_LT(of("yaw", 0), 0.05 * walk.mass_kg);
  }
  for (const auto& [name, values] : results) {
    if (!name.starts_with("tendon_")) continue;
    const auto is = [&name = name](const char* muscle) { return name.find(muscle) != std::string::npos; };
    const bool follows = is("soleus") || is("tibialis"), calf = is("gastrocnemius") || is("plantaris");
    const bool kneecap = is("vastus") || is("rectus");  // it leaves the published track
    EXPECT_LT(values.at(2), follows ? 0.01 : calf ? 1 : kneecap ? 23 : 1.3) << name;
  }
  EXPECT_GT(of("touch", 0), 0.1 * 9.81 * walk.mass_kg);
}

INSTANTIATE_TEST_SUITE_P(Walks, Mujoco, ::testing::ValuesIn(walks), [](const auto& walk) { return walk.param.name; });

}  // namespace mobil::mujoco_test
