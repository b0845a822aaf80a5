// `mobil walk --export` and `mobil crowd --export`: their files, which agree with the tables. The tests share a walk,
// so they run in one process.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "tests/files/opensim_table.h"
#include "tests/labels.h"
#include "tests/program/program.h"

MOBIL_TEST_LABELS("long");

namespace mobil::formats_program_test {
namespace fs = std::filesystem;

const std::vector<std::string> files = {"walk.bvh",  "walk.mot", "walk.sto", "walk.xml", "walk.osim",
                                        "walk.usda", "walk.wrl", "walk.x3d", "walk.gl"};

/// One walk in all formats.
struct Exported {
  TemporaryFolder folder;
  Ran ran;
  fs::path out = folder.path / "out";
  std::unique_ptr<Csv> motion;

  Exported() {
    std::string arguments = "walk --height 1.80 --mass 80 --speed 5km/h --seconds 1.5 --out out";
    for (const auto& file : files) arguments += " --export " + file;
    ran = run_mobil(arguments + " --export walk.glb", folder.path);
    if (ran.status == 0) motion = std::make_unique<Csv>(out / "motion.csv");
  }
};
const Exported& exported() {
  static const Exported once;
  return once;
}

TEST(WalkFormats, AllAppearNextToTheUsualFiles) {
  ASSERT_EQ(exported().ran.status, 0) << exported().ran.err;
  std::set<std::string> expected(files.begin(), files.end()), found;
  expected.insert({"walk.glb", "walk_motion.csv", "motion.csv", "muscles.csv", "summary.json"});
  for (const auto& entry : fs::directory_iterator(exported().out)) found.insert(entry.path().filename());
  EXPECT_EQ(found, expected);
  for (const auto& file : files) EXPECT_NE(exported().ran.out.find(file), std::string::npos) << file;
}

TEST(WalkFormats, OpensimAnglesMatchTheTableAtEveryTick) {
  ASSERT_EQ(exported().ran.status, 0) << exported().ran.err;
  const OpensimTable table(exported().out / "walk.mot");
  const Csv& motion = *exported().motion;
  ASSERT_EQ(table.column.at("time").size(), motion.rows.size());
  constexpr double level_deg = 11.5;  // tilt of the anatomical position in motion.csv, which is 0 in the model
  const struct {
    std::string coordinate, column;
    double sign, within_deg, more_deg = 0;
  } pairs[] = {// the knee has one axis; elsewhere the table counts angles in another order than the model does
               {"knee_angle_r", "knee_flexion_right_deg", -1, 0.01},
               {"knee_angle_l", "knee_flexion_left_deg", -1, 0.01},
               {"ankle_angle_r", "ankle_dorsiflexion_right_deg", 1, 0.3},
               {"ankle_angle_l", "ankle_dorsiflexion_left_deg", 1, 0.3},
               {"hip_flexion_r", "hip_flexion_right_deg", 1, 0.5, -level_deg},
               {"hip_flexion_l", "hip_flexion_left_deg", 1, 0.5, -level_deg},
               {"pelvis_tilt", "pelvis_tilt_deg", -1, 0.5, level_deg},
               {"pelvis_list", "pelvis_list_deg", -1, 0.1},
               {"pelvis_rotation", "pelvis_rotation_deg", 1, 0.1}};
  for (const auto& [coordinate, column, sign, within_deg, more_deg] : pairs) {
    double largest = 0;
    for (std::size_t i = 0; i < motion.rows.size(); ++i) {
      EXPECT_NEAR(table.at("time", i), motion.number(i, "time_s"), 2e-6);
      largest = std::max(largest, std::abs(table.at(coordinate, i) - more_deg - sign * motion.number(i, column)));
    }
    EXPECT_LT(largest, within_deg) << coordinate;
    RecordProperty(coordinate, std::to_string(largest));
  }
}

TEST(WalkFormats, OpensimForcesMatchTheTable) {
  ASSERT_EQ(exported().ran.status, 0) << exported().ran.err;
  const OpensimTable table(exported().out / "walk.sto");
  const Csv& motion = *exported().motion;
  for (std::size_t i = 0; i < motion.rows.size(); ++i) {
    EXPECT_NEAR(table.at("ground_force_vy", i), motion.number(i, "grf_vertical_right_n"), 2e-3);
    EXPECT_NEAR(table.at("1_ground_force_vy", i), motion.number(i, "grf_vertical_left_n"), 2e-3);
    EXPECT_NEAR(table.at("ground_force_vx", i), motion.number(i, "grf_anterior_right_n"), 2e-3);
  }
}

TEST(WalkFormats, RefusalsAreOneLine) {
  const TemporaryFolder folder;
  expect_refused("walk",
                 {{"--export walk.fbx", {"--export walk.fbx", ".glb, .bvh", ".gl"}},
                  {"--export walk", {"--export walk", "known format"}},
                  {"--export else/walk.bvh", {"--export else/walk.bvh", "without folders"}},
                  {"--export a.bvh --export a.bvh", {"--export a.bvh", "twice"}},
                  {"--export ''", {"--export", "empty"}},
                  {"--export a.sto --no-forces", {"--export a.sto", "--no-forces"}},
                  {"--export a.xml --in-place", {"--export a.xml", "MuJoCo", "--in-place"}},
                  {"--eye-distance 1m", {"--eye-distance", "0.001 to 0.5 m"}},
                  {"--fat --view skin", {"--fat", "--frames"}},
                  {"--fat --frames", {"--fat", "--view skin"}},
                  {"--eye-distance 7cm", {"--eye-distance", "--stereo"}}},
                 folder.path);
  expect_refused("crowd",
                 {{"--export crowd.bvh", {"--export crowd.bvh", ".glb, .usda"}},
                  {"--export absent/crowd.glb", {"--export", "absent"}},
                  {"--export a.glb --export a.glb", {"--export a.glb", "twice"}},
                  {"--export a.glb --churn 5", {"--export", "--churn"}},
                  {"--export a.glb --raise", {"--raise", "--export"}},
                  {"--people 100000 --export a.glb --export-seconds 60", {"--export", "800000", "--export-seconds"}},
                  {"--export-seconds 2h", {"--export-seconds", "unknown unit"}}},
                 folder.path);
}

TEST(CrowdFormats, CrowdIsOneValidGlbAndOneUsda) {
  const TemporaryFolder folder;
  const Ran ran = run_mobil(
      "crowd --people 12 --seconds 0.1 --tolerance 100mm --near 0 --export crowd.glb --export crowd.usda "
      "--export-seconds 0.5",
      folder.path);
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_NE(ran.out.find("written crowd.glb"), std::string::npos) << ran.out;
  const std::string bytes = read_bytes(folder.path / "crowd.glb");
  std::uint32_t json_length = 0;
  std::memcpy(&json_length, bytes.data() + 12, 4);
  const auto scene = nlohmann::json::parse(bytes.substr(20, json_length));
  EXPECT_EQ(scene.at("skins").size(), 12U);
  EXPECT_EQ(scene.at("animations").size(), 1U);
  std::set<nlohmann::json> positions;
  for (const auto& mesh : scene.at("meshes")) {
    for (const auto& primitive : mesh.at("primitives")) positions.insert(primitive.at("attributes").at("POSITION"));
  }
  // Skin, legs, lips, hair, shirt, shorts, shoes: common to all people of similar build.
  EXPECT_EQ(positions.size() % 7, 0U);
  EXPECT_LT(positions.size(), 7U * 12);
  if (run_shell("python3 --version", folder.path).status == 0) {
    const Ran read =
        run_shell("python3 '" MOBIL_SOURCE_DIR "/tests/files/read_formats.py' bones crowd.usda 14", folder.path);
    EXPECT_EQ(read.status, 0) << read.err;
    EXPECT_GT(std::ranges::count(read.out, '\n'), 12 * 100);
  }
  if (run_shell("node --version", folder.path).status != 0) GTEST_SKIP() << "node is not installed";
  const Ran valid = run_shell("node '" MOBIL_SOURCE_DIR "/tests/validate_glb.mjs' crowd.glb", folder.path);
  if (valid.status == 77) GTEST_SKIP() << valid.err;
  EXPECT_NE(valid.out.find("0 errors, 0 warnings"), std::string::npos) << valid.out;
}

}  // namespace mobil::formats_program_test
