// Documented properties of `mobil walk`, checked in the files that the program writes.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <set>

#include <mobil/anthropometry.h>
#include <mobil/components/gait.h>
#include <mobil/components/muscle.h>
#include <mobil/muscle_table.h>
#include <mobil/usual_gait.h>
#include "assets/gait/step_lookup.h"
#include "demo/walk/walk_tables.h"
#include "tests/labels.h"
#include "tests/program/program.h"

MOBIL_TEST_LABELS("long");

namespace mobil::walk_test {
namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr double tick_s = 1.0 / 60;
const std::vector<std::string> sides = {"right", "left"};

/// Three people and their requested gaits.
struct Asked {
  std::string arguments;
  double height_m, mass_kg, speed_m_s, step_m, seconds;
};
double usual_step_m(double height_m, double speed_m_s) {
  const double leg = make_body({.height_m = static_cast<float>(height_m)})->hip_height_m;
  return shod_step_factor * usual_step_length(static_cast<float>(speed_m_s / std::sqrt(9.81 * leg))) * leg;
}
const std::vector<Asked> everybody = {
    {"--height 1.80 --mass 80 --constitution athletic --speed 5km/h --seconds 3", 1.80, 80, 5 / 3.6,
     usual_step_m(1.80, 5 / 3.6), 3},
    {"--height 155cm --mass 50 --constitution thin --speed 1.0 --step-length 55cm --seconds 4s", 1.55, 50, 1.0, 0.55,
     4},
    {"--height 1.95 --mass 120kg --constitution heavy --step-length 0.85 --step-frequency 120steps/min --seconds 3",
     1.95, 120, 1.70, 0.85, 3},
};

/// One run of the program and its tables.
struct Walk {
  TemporaryFolder folder;
  Ran ran;
  std::unique_ptr<Csv> motion, muscles;

  explicit Walk(const std::string& arguments) : ran(run_mobil("walk " + arguments + " --out out", folder.path)) {
    if (ran.status != 0) throw std::runtime_error("mobil walk " + arguments + ": " + ran.err);
    motion = std::make_unique<Csv>(file("motion.csv"));
    muscles = std::make_unique<Csv>(file("muscles.csv"));
  }
  fs::path file(const std::string& name) const { return folder.path / "out" / name; }
  Json summary() const { return Json::parse(read_bytes(file("summary.json"))); }
  /// Returns the phase of toe-off: half a cycle and a double support after the heel strike.
  double toe_off() const { return 0.5 + summary().at("gait").at("double_support_cycle").get<double>(); }
};

const Walk& walk_of(std::size_t i) {
  static std::vector<std::unique_ptr<Walk>> walks(everybody.size());
  if (!walks[i]) walks[i] = std::make_unique<Walk>(everybody[i].arguments);
  return *walks[i];
}

class WalkOf : public testing::TestWithParam<std::size_t> {
 protected:
  const Asked& asked = everybody[GetParam()];
  const Walk& walk = walk_of(GetParam());
  const Csv& motion = *walk.motion;
  const Csv& muscles = *walk.muscles;
};
INSTANTIATE_TEST_SUITE_P(ThreePeople, WalkOf, testing::Values(0U, 1U, 2U));

TEST_P(WalkOf, HasAllDocumentedColumnsAndRows) {
  std::vector<std::string> promised = {"time_s",  "phase_right",         "phase_left",      "com_x_m",        "com_y_m",
                                       "com_z_m", "pelvis_rotation_deg", "pelvis_list_deg", "pelvis_tilt_deg"};
  for (const auto& side : sides) {
    for (const std::string joint :
         {"hip_flexion", "knee_flexion", "ankle_dorsiflexion", "shoulder_flexion", "elbow_flexion"}) {
      promised.push_back(joint + "_" + side + "_deg");
    }
    for (const std::string direction : {"vertical", "anterior"})
      promised.push_back("grf_" + direction + "_" + side + "_n");
    for (const std::string joint : {"hip", "knee", "ankle"}) promised.push_back(joint + "_moment_" + side + "_nm");
    for (const std::string point : {"heel", "toe"}) {
      for (const char axis : {'x', 'y', 'z'}) promised.push_back(fmt::format("{}_{}_{}_m", point, axis, side));
    }
  }
  for (const auto& column : promised) EXPECT_TRUE(motion.has(column)) << column;
  EXPECT_EQ(std::set(motion.columns.begin(), motion.columns.end()).size(), motion.columns.size());

  for (const std::string column :
       {"time_s", "side", "group", "line_length_m", "rest_length_m", "line_ratio", "stiffness_n_per_m", "force_n",
        "belly_elongation_m", "volume_ratio", "kinetic_energy_j", "strain_energy_j", "method"}) {
    EXPECT_TRUE(muscles.has(column)) << column;
  }

  const auto ticks = static_cast<std::size_t>(std::lround(asked.seconds / tick_s));
  ASSERT_EQ(motion.rows.size(), ticks);
  for (std::size_t i = 0; i < ticks; ++i) {
    EXPECT_NEAR(motion.number(i, "time_s"), static_cast<double>(i + 1) * tick_s, 1e-6);
  }
  ASSERT_EQ(muscles.rows.size() % ticks, 0U);
  const std::size_t each = muscles.rows.size() / ticks;
  std::set<std::string> kinds;
  for (std::size_t i = 0; i < each; ++i) kinds.insert(muscles.text(i, "side") + " " + muscles.text(i, "group"));
  EXPECT_EQ(kinds.size(), each);
  for (const auto& side : sides) {
    for (std::size_t g = 0; g < usual_muscle_count; ++g) {
      const auto group = muscle_name(static_cast<Muscle>(g));
      EXPECT_TRUE(kinds.contains(fmt::format("{} {}", side, group))) << group;
    }
  }
}
TEST_P(WalkOf, MeanSpeedIsTheRequestedOne) {
  // Over complete strides, from right heel strike to right heel strike, each between two rows.
  std::vector<double> times, places;
  for (std::size_t i = 1; i < motion.rows.size(); ++i) {
    const double before = motion.number(i - 1, "phase_right") - 1, now = motion.number(i, "phase_right");
    if (now > before + 0.5) continue;
    const double t = before / (before - now);
    times.push_back(motion.number(i - 1, "time_s") + t * tick_s);
    places.push_back(motion.number(i - 1, "com_z_m") +
                     t * (motion.number(i, "com_z_m") - motion.number(i - 1, "com_z_m")));
  }
  ASSERT_GE(times.size(), 2U);
  const double speed = (places.back() - places.front()) / (times.back() - times.front());
  EXPECT_NEAR(speed / asked.speed_m_s, 1, 0.01);
}

TEST_P(WalkOf, BelliesFollowTheirLines) {
  for (std::size_t i = 0; i < muscles.rows.size(); ++i) {
    const double length = muscles.number(i, "line_length_m"), rest = muscles.number(i, "rest_length_m");
    EXPECT_NEAR(muscles.number(i, "line_ratio"), length / rest, 2e-5);
    EXPECT_NEAR(muscles.number(i, "belly_elongation_m"), length - rest, 1.2e-5);
    EXPECT_NEAR(muscles.number(i, "force_n"), -muscles.number(i, "stiffness_n_per_m") * (length - rest), 2e-3);
    EXPECT_GT(muscles.number(i, "volume_ratio"), 0.7);
    EXPECT_LT(muscles.number(i, "volume_ratio"), 1.4);
    EXPECT_GE(muscles.number(i, "kinetic_energy_j"), 0);
    EXPECT_LT(muscles.number(i, "kinetic_energy_j"), 5);
    EXPECT_LT(std::abs(muscles.number(i, "strain_energy_j")), 20);
    EXPECT_FALSE(muscles.text(i, "method").empty());
  }
}

TEST_P(WalkOf, SummaryHasRequestResultAndCost) {
  const Json summary = walk.summary();
  EXPECT_NEAR(summary.at("body").at("height_m"), asked.height_m, 1e-6);
  EXPECT_NEAR(summary.at("body").at("mass_kg"), asked.mass_kg, 1e-5);
  EXPECT_NEAR(summary.at("gait").at("speed_m_s"), asked.speed_m_s, 1e-5);
  EXPECT_NEAR(summary.at("gait").at("step_length_m"), asked.step_m, 1e-5);
  EXPECT_NEAR(summary.at("gait").at("step_frequency_hz"), asked.speed_m_s / asked.step_m, 1e-5);
  EXPECT_EQ(summary.at("drive"), "displacement");
  const Json& time = summary.at("time");
  EXPECT_NEAR(time.at("simulated_s"), asked.seconds, 1e-6);
  EXPECT_EQ(time.at("ticks"), motion.rows.size());
  double stages_us = 0;
  for (const std::string stage : {"gait", "kinematics", "lines of action", "deformation"}) {
    const double us = time.at("stages").at(stage).at("us_per_tick");
    EXPECT_GT(us, 0) << stage;
    stages_us += us;
  }
  EXPECT_LE(stages_us, time.at("us_per_tick").get<double>());
  EXPECT_GT(time.at("times_faster_than_real_time"), 0);
  ASSERT_EQ(summary.at("muscles").size(), 2 * usual_muscle_count);
  for (const Json& muscle : summary.at("muscles")) {
    const double dt = muscle.at("dt_s"), critical = muscle.at("critical_dt_s");
    EXPECT_GT(dt, 0);
    EXPECT_LE(dt, 0.9 * critical * (1 + 1e-9)) << muscle;
    EXPECT_NEAR(dt * muscle.at("substeps_per_tick").get<double>(), tick_s, 1e-9);
  }
}

TEST_P(WalkOf, SceneIsValidToKhronosValidator) {
  if (run_shell("node --version", walk.folder.path).status != 0) GTEST_SKIP() << "node is not installed";
  const Ran ran = run_shell("node '" MOBIL_SOURCE_DIR "/tests/validate_glb.mjs' out/walk.glb", walk.folder.path);
  if (ran.status == 77) GTEST_SKIP() << ran.err;
  EXPECT_EQ(ran.status, 0) << ran.out << ran.err;
  EXPECT_NE(ran.out.find("0 errors, 0 warnings"), std::string::npos) << ran.out;
}

TEST(Walk, TheSameCommandWritesTheSameBytes) {
  MOBIL_SLOW();
  const Walk again(everybody[0].arguments);
  for (const std::string name : {"motion.csv", "muscles.csv", "walk.glb"}) {
    const std::string first = read_bytes(walk_of(0).file(name));
    EXPECT_GT(first.size(), 1000U) << name;
    EXPECT_TRUE(first == read_bytes(again.file(name))) << name;
    EXPECT_FALSE(first == read_bytes(walk_of(1).file(name))) << name;
  }
}

TEST(Walk, OnlyDocumentedFilesAndNoProgressWithoutATerminal) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(walk_of(0).folder.path / "out"))
    names.insert(entry.path().filename());
  EXPECT_EQ(names, (std::set<std::string>{"motion.csv", "muscles.csv", "summary.json", "walk.glb"}));
  EXPECT_EQ(walk_of(0).ran.err, "");
  for (const auto& name : names) EXPECT_NE(walk_of(0).ran.out.find(name), std::string::npos) << name;
}

TEST(Walk, UnitsGiveEqualResults) {
  const Walk metric("--height 1.8288 --mass 80 --speed 1.25 --seconds 0.5");
  const Walk other("--height 6ft --mass 80000g --speed 4.5km/h --seconds 500ms");
  EXPECT_EQ(read_bytes(metric.file("motion.csv")), read_bytes(other.file("motion.csv")));
}

TEST(Walk, MusclesMoveByTheRequestedMethod) {
  for (const std::string method : {"explicit-central", "implicit-central", "newmark", "static"}) {
    const Walk walk(fmt::format("--seconds 0.5 --inertia --element bbar --method {}", method));
    const auto& summary = walk.summary();
    EXPECT_EQ(summary.at("method"), method);
    EXPECT_EQ(summary.at("element"), "bbar");
    EXPECT_EQ(summary.at("inertia"), true);
    for (const auto& muscle : summary.at("muscles")) {
      EXPECT_EQ(muscle.at("dt_s").is_null(), method == "static");
      EXPECT_EQ(muscle.at("critical_dt_s").is_null(), method == "newmark" || method == "static");
      if (method == "newmark") {
        EXPECT_EQ(muscle.at("substeps_per_tick"), 1);
      }
    }
    for (std::size_t i = 0; i < walk.muscles->rows.size(); ++i) {
      EXPECT_EQ(walk.muscles->text(i, "method"), method);
      EXPECT_LT(std::abs(walk.muscles->number(i, "volume_ratio") - 1), 0.2);
    }
  }
  const Walk pulled("--seconds 0.2 --drive force --method newmark");
  EXPECT_EQ(pulled.muscles->text(0, "method"), "newmark_force");
}

/// Columns of ground reaction and moments, which are empty without forces.
const std::vector<std::string> force_columns = [] {
  std::vector<std::string> names;
  for (const auto& side : sides) {
    for (const std::string column : {"grf_vertical_", "grf_anterior_"}) names.push_back(column + side + "_n");
    for (const std::string column :
         {"hip_moment_", "knee_moment_", "ankle_moment_", "hip_abduction_", "hip_rotation_", "free_moment_"})
      names.push_back(column + side + "_nm");
  }
  return names;
}();

TEST(Motion, GroundReactionIsWrittenAlongTheHeading) {
  ASSERT_TRUE(rc::check("force columns", [] {
    const auto number = [] { return static_cast<float>(*rc::gen::inRange(-100000, 100000)) / 100.0F; };
    MotionRow row{};
    row.heading_rad = number() / 200;
    WalkForces forces{};
    for (std::size_t side = 0; side < 2; ++side) {
      forces.ground.force_n[side] = {number(), number(), number()};
      forces.moments.hip_nm[side] = number();
      forces.moments.knee_nm[side] = number();
      forces.moments.ankle_nm[side] = number();
      forces.moments.hip_abduction_nm[side] = number();
      forces.moments.hip_rotation_nm[side] = number();
      forces.ground.free_moment_nm[side] = number();
    }
    MotionTable table;
    table.add(row, forces);
    table.add(row, std::nullopt);
    const TemporaryFolder folder;
    std::ofstream(folder.path / "motion.csv") << table.text;
    const Csv motion(folder.path / "motion.csv");
    const auto near = [&](const std::string& column, double value) {
      return std::abs(motion.number(0, column) - value) < 1e-3;
    };
    const double heading = row.heading_rad;
    for (std::size_t side = 0; side < 2; ++side) {
      const Vec3<float> force = forces.ground.force_n[side];
      // rotated back by the heading, the walker moves toward +z
      const double ahead =
          std::cos(heading) * static_cast<double>(force.z) + std::sin(heading) * static_cast<double>(force.x);
      RC_ASSERT(near("grf_vertical_" + sides[side] + "_n", force.y));
      RC_ASSERT(near("grf_anterior_" + sides[side] + "_n", ahead));
      RC_ASSERT(near("hip_moment_" + sides[side] + "_nm", forces.moments.hip_nm[side]));
      RC_ASSERT(near("knee_moment_" + sides[side] + "_nm", forces.moments.knee_nm[side]));
      RC_ASSERT(near("ankle_moment_" + sides[side] + "_nm", forces.moments.ankle_nm[side]));
      RC_ASSERT(near("hip_abduction_" + sides[side] + "_nm", forces.moments.hip_abduction_nm[side]));
      RC_ASSERT(near("hip_rotation_" + sides[side] + "_nm", forces.moments.hip_rotation_nm[side]));
      RC_ASSERT(near("free_moment_" + sides[side] + "_nm", forces.ground.free_moment_nm[side]));
    }
    for (const auto& column : force_columns) RC_ASSERT(motion.text(1, column).empty());
  }));
}

TEST(Walk, WithoutForcesTheirCellsAreEmptyAndOthersEqual) {
  const Walk bare(everybody[0].arguments + " --no-forces");
  const Csv& full = *walk_of(0).motion;
  ASSERT_EQ(bare.motion->rows.size(), full.rows.size());
  for (std::size_t i = 0; i < full.rows.size(); ++i) {
    for (const auto& column : full.columns) {
      const bool force = std::ranges::find(force_columns, column) != force_columns.end();
      EXPECT_EQ(bare.motion->text(i, column), force ? "" : full.text(i, column)) << column << " row " << i;
    }
  }
  EXPECT_EQ(bare.summary().at("time").at("ticks"), full.rows.size());
}

TEST(Walk, SetParametersAreInTheSummaryAndTheWalk) {
  const std::string still = "--set arm_back_deg=0 --set arm_forward_deg=0 --set toe_out_deg=12deg --seconds 1.5";
  const Walk walk("--speed 1.3 " + still), plain("--speed 1.3 --seconds 1.5");
  const Json parameters = walk.summary().at("gait").at("parameters");
  EXPECT_EQ(parameters.size(), gait_parameters.size());
  for (const GaitParameter& p : gait_parameters) {
    const double expected = p.name.starts_with("arm_back") || p.name.starts_with("arm_forward") ? 0
                            : p.name == "toe_out_deg"                                           ? 12
                                                      : static_cast<double>(usual_style({}).*p.value);
    EXPECT_NEAR(parameters.at(std::string(p.name)).get<double>(), expected, 1e-6 * std::abs(expected)) << p.name;
  }
  const auto swing = [](const Csv& motion) {
    double low = 1e9, high = -1e9;
    for (std::size_t i = 0; i < motion.rows.size(); ++i) {
      low = std::min(low, motion.number(i, "shoulder_flexion_right_deg"));
      high = std::max(high, motion.number(i, "shoulder_flexion_right_deg"));
    }
    return high - low;
  };
  EXPECT_LT(swing(*walk.motion), 0.5 * swing(*plain.motion));
}

TEST(Walk, ScriptWithoutChangesChangesNothing) {
  const TemporaryFolder folder;
  std::ofstream(folder.path / "same.csv") << "time_s,parameter,value\n0,heading,0\n0.4,toe_out_deg,6\n0.4,heading,0\n"
                                             "0.6,pelvis_list_deg,3.5\n5,stop,\n";
  const auto file = (folder.path / "same.csv").string();
  const Walk scripted("--speed 1.3 --seconds 1.5 --script '" + file + "'"), plain("--speed 1.3 --seconds 1.5");
  for (std::size_t i = 0; i < plain.motion->rows.size(); ++i) {  // the step can be solved again
    for (const auto& column : plain.motion->columns) {
      if (!column.ends_with("_deg") && !column.ends_with("_m")) continue;
      EXPECT_NEAR(scripted.motion->number(i, column), plain.motion->number(i, column), 1e-2) << column << " row " << i;
    }
  }
  EXPECT_EQ(scripted.summary().at("script").at("changes"), 3);
  EXPECT_EQ(scripted.summary().at("script").at("file"), file);
  EXPECT_NE(scripted.ran.out.find("1 of 4 changes"), std::string::npos) << scripted.ran.out;
  EXPECT_FALSE(plain.summary().contains("script"));
}

/// Returns width and height of a PNG: big-endian, after its signature and the head of its first chunk.
std::pair<unsigned, unsigned> picture_size(const std::string& png) {
  if (png.size() < 24 || !png.starts_with("\x89PNG\r\n\x1a\n")) return {0, 0};
  const auto word = [&](std::size_t at) {
    unsigned value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = 256 * value + static_cast<unsigned char>(png[at + i]);
    return value;
  };
  return {word(16), word(20)};
}

TEST(Walk, PicturesOfEveryView) {
  std::set<std::string> pictures;
  for (const std::string view : {"stick", "wireframe", "surface --stereo", "surface --stereo --eye-distance 2cm"}) {
    const TemporaryFolder folder;
    const Ran ran = run_mobil("walk --frames --seconds 0.1 --out out --view " + view, folder.path);
    if (ran.status == 2 && ran.err.find("EGL") != std::string::npos) GTEST_SKIP() << ran.err;
    ASSERT_EQ(ran.status, 0) << ran.err;
    std::size_t frames = 0;
    for (const auto& entry : fs::directory_iterator(folder.path / "out")) {
      const std::string name = entry.path().filename();
      EXPECT_EQ(name.find("partial"), std::string::npos) << name;
      if (!name.starts_with("frame_")) continue;
      ++frames;
      const std::string png = read_bytes(entry.path());
      EXPECT_EQ(picture_size(png), (std::pair{1280U, 720U})) << name;
      EXPECT_GT(png.size(), 5000U) << name;  // not one colour
      pictures.insert(png);
    }
    EXPECT_EQ(frames, 3U) << view;  // 30 a second
  }
  EXPECT_EQ(pictures.size(), 12U);  // all different
}

}  // namespace mobil::walk_test
