// Moment arms of muscles: close to the published model, of the right sign, and continuous.
#include <gtest/gtest.h>

#include <cmath>
#include <string_view>
#include <vector>

#include <mobil/muscle_table.h>
#include "systems/lines/line_motion.h"
#include "systems/lines/line_of_action.h"
#include "tests/files/reference_data.h"
#include "tests/lines/leg_block.h"
#include "tests/muscles/find_member.h"
#include "tests/muscles/published_lengths.h"

namespace mobil::moment_arm_test {
using namespace geometry;
using test::Block;
using test::degree;
using test::every_muscle;
using test::flexed;
using test::Joint;
using test::LegAngles;
using test::posed;
using test::Random;
using test::set;

/// Returns a body with the leg dimensions that the paths were published for.
Body published_body() {
  Body body = make_body({1.80F, 80}).value();
  body.thigh_length_m = static_cast<float>(published_leg::thigh_m);
  body.shank_length_m = static_cast<float>(published_leg::shank_m);
  return body;
}

LegAngles with(LegAngles angles, Joint joint, double deg) {
  (joint == Joint::hip ? angles.hip_deg : joint == Joint::knee ? angles.knee_deg : angles.ankle_deg) = deg;
  return angles;
}

/// Returns −ΔL/Δθ, mm, from one angle of a joint to another.
double mean_arm_mm(const MemberMuscle& muscle, const LegAngles& at, Joint joint, double from_deg, double to_deg) {
  static const Body body = published_body();
  const auto length_at = [&](double deg) {
    return member_length(muscle, leg_scale(body), posed(body, with(at, joint, deg)));
  };
  return -1e3 * (length_at(to_deg) - length_at(from_deg)) / ((to_deg - from_deg) * degree);
}

/// The published ankle's axis is oblique, the model's is not: a ninth of tibialis anterior's arm.
double allowed_mm(double published) {
  return std::max(0.12 * std::abs(published), 2.5);
}

// Arms of the published model (gait2392 of OpenSim, CC BY 3.0, Delp et al. 1990), mm: −ΔL/Δθ over intervals of ten
// degrees, with the other joints at zero.
TEST(MomentArms, MatchThePublishedModel) {
  struct Row {
    std::string_view muscle;
    Joint joint;
    std::vector<double> arms_mm;
  };
  const std::vector<Row> rows = {
      {"semimembranosus", Joint::hip, {-29.7, -38.5, -46.1, -51.8, -55.3, -57.5, -57.5, -56.1, -52.7}},
      {"semimembranosus", Joint::knee, {33.7, 37.1, 38.2, 39.2, 40.1, 40.1, 39.2, 36.6, 32.8, 28.0}},
      {"semitendinosus", Joint::hip, {-29.2, -41.7, -52.3, -60.5, -66.1, -69.5, -70.9, -69.5, -66.6}},
      {"semitendinosus", Joint::knee, {40.1, 42.5, 44.6, 46.7, 48.3, 48.0, 46.4, 43.0, 38.5, 31.8}},
      {"biceps_femoris_long_head", Joint::hip, {-34.4, -44.8, -53.2, -59.5, -63.8, -65.5, -65.5, -63.6, -59.7}},
      {"biceps_femoris_long_head", Joint::knee, {29.6, 33.0, 34.4, 34.7, 33.9, 31.8, 29.1, 25.0, 20.0, 14.4}},
      {"biceps_femoris_short_head", Joint::knee, {23.4, 28.8, 31.3, 32.7, 33.7, 33.6, 32.2, 29.6, 26.0, 21.0}},
      {"rectus_femoris", Joint::hip, {26.6, 33.4, 39.7, 44.9, 49.4, 52.2, 53.8, 53.8, 52.0}},
      {"rectus_femoris", Joint::knee, {-48.7, -49.6, -50.1, -48.2, -45.4, -41.8, -37.9, -32.7, -28.0, -25.9}},
      {"vastus_medialis", Joint::knee, {-45.0, -45.3, -45.0, -42.7, -40.2, -37.2, -33.8, -32.2, -30.6, -28.0}},
      {"vastus_intermedius", Joint::knee, {-46.1, -45.6, -45.3, -43.6, -41.4, -38.9, -35.7, -32.1, -28.6, -26.6}},
      {"vastus_lateralis", Joint::knee, {-42.7, -45.9, -46.5, -43.9, -40.8, -37.3, -33.1, -31.2, -29.6, -27.1}},
      {"gastrocnemius_medial", Joint::knee, {21.7, 23.2, 22.2, 19.6, 20.4, 18.1, 17.3, 16.3, 14.7, 13.2}},
      {"gastrocnemius_medial", Joint::ankle, {-44.2, -46.5, -47.5, -47.0, -45.2, -42.1, -37.7}},
      {"gastrocnemius_lateral", Joint::knee, {21.8, 23.3, 22.3, 20.2, 18.7, 18.2, 16.9, 15.1, 13.1, 11.0}},
      {"gastrocnemius_lateral", Joint::ankle, {-45.6, -47.9, -48.7, -47.9, -45.9, -42.8, -38.2}},
      {"soleus", Joint::ankle, {-46.6, -48.1, -47.9, -46.6, -43.7, -40.1, -35.2}},
      {"tibialis_anterior", Joint::ankle, {32.7, 35.9, 38.8, 41.1, 42.6, 43.5, 42.8}}};
  for (const Row& row : rows) {
    const double first = row.joint == Joint::hip ? -30 : row.joint == Joint::knee ? 0 : -40;
    for (std::size_t i = 0; i < row.arms_mm.size(); ++i) {
      const double from = first + 10 * static_cast<double>(i);
      const double ours = mean_arm_mm(*find_member_muscle(row.muscle), {}, row.joint, from, from + 10);
      EXPECT_NEAR(ours, row.arms_mm[i], allowed_mm(row.arms_mm[i])) << row.muscle << " from " << from;
    }
  }
}

TEST(MomentArms, MatchThePublishedModelOverItsWholeMap) {
  const auto of_thigh = test::reference_table("mt_length_map_hip_knee.csv"),
             of_shank = test::reference_table("mt_length_map_knee_ankle.csv");
  if (!of_thigh || !of_shank) GTEST_SKIP() << test::no_table;
  constexpr double step_deg = 10;
  const Body body = published_body();
  std::size_t compared = 0;
  double worst = 0;
  std::string of;
  for (const auto& file : {*of_thigh, *of_shank}) {
    const auto rows = test::read_table(file);
    const auto angles = [](const test::TableRow& row) {
      return LegAngles{row("hip_flexion_deg"), row("knee_flexion_deg"), row("ankle_dorsiflexion_deg")};
    };
    for (const auto& [name, theirs] : test::published_name) {
      const std::string column = theirs + "_norm";
      const MemberMuscle& muscle = *find_member_muscle(name);
      const double rest = member_length(muscle, leg_scale(body), posed(body, {}));
      for (const auto& row : rows) {
        if (!row.has(column)) continue;
        const LegAngles from = angles(row);
        for (const Joint joint : {Joint::hip, Joint::knee, Joint::ankle}) {
          const double at = joint == Joint::hip ? from.hip_deg : joint == Joint::knee ? from.knee_deg : from.ankle_deg;
          const LegAngles to = with(from, joint, at + step_deg);
          for (const auto& next : rows) {
            const LegAngles there = angles(next);
            if (there.hip_deg != to.hip_deg || there.knee_deg != to.knee_deg || there.ankle_deg != to.ankle_deg) {
              continue;
            }
            const double published = -1e3 * rest * (next(column) - row(column)) / (step_deg * degree);
            const double ours = mean_arm_mm(muscle, from, joint, at, at + step_deg);
            const double misfit = std::abs(ours - published) / allowed_mm(published);
            if (misfit > worst) worst = misfit, of = name;
            ++compared;
          }
        }
      }
    }
  }
  EXPECT_GT(compared, 1000U);
  EXPECT_LT(worst, 1) << of;
}

/// Returns arms in lanes for sixteen poses of one body.
LineMotion<Lanes<float>> motion_of(const MuscleLines& lines, Block& block) {
  lines_of_action(lines, block.scale, block.legs, FarEnd::held, block.line, block.end);
  LineMotion<Lanes<float>> motion{};
  line_motion(lines, block.scale, block.legs, block.line, motion, 0.01F);
  return motion;
}

// Hip from −30° to 120°, knee to 115°, ankle from −50° to 30°, all combinations. Beyond 115° of knee flexion the
// published lines of the hamstrings pass in front of the knee's axis.
TEST(MomentArms, FlexorsFlexAndExtensorsExtend) {
  const auto sign = [](std::string_view name, Joint joint) {
    const bool ham =
        name == "semimembranosus" || name == "semitendinosus" || name.starts_with("biceps") || name == "hamstrings";
    const bool calf = name.starts_with("gastrocnemius") || name == "plantaris" || name == "triceps_surae";
    const bool quads = name.starts_with("vastus") || name == "rectus_femoris" || name == "quadriceps";
    switch (joint) {
      case Joint::hip:
        return name == "biceps_femoris_short_head" ? 0 : ham ? -1 : name == "rectus_femoris" || name == "quadriceps";
      case Joint::knee:
        return ham || calf ? 1 : quads ? -1 : 0;
      case Joint::ankle:
        break;
    }
    const bool extends_toes = name.starts_with("extensor") || name == "toe_extensors" || name == "peroneus_tertius";
    const bool behind = name.starts_with("flexor") || name == "deep_calf" || name == "tibialis_posterior" ||
                        name.starts_with("peroneus") || name == "peroneals";
    return calf || name == "soleus" ? -1 : name == "tibialis_anterior" || extends_toes ? 1 : behind ? -1 : 0;
  };
  const auto crosses = [](Muscle muscle, Joint joint) {
    return std::ranges::any_of(members_of(muscle), [&](const MemberMuscle& line) {
      const LegBone last = line.kneecap ? LegBone::shank : line.path.back().bone;
      const auto distal = static_cast<LegBone>(static_cast<int>(joint) + 1);
      return line.path.front().bone < distal && last >= distal;
    });
  };
  Random random;
  for (const Muscle muscle : every_muscle()) {
    const MuscleLines lines = make_muscle_lines(muscle);
    for (int i = 0; i < 60; ++i) {
      Block block;
      std::array<LegAngles, lane_count> angles;
      for (std::size_t l = 0; l < lane_count; ++l) {
        angles[l] = {random.between(-30, 120), random.between(-5, 115), random.between(-50, 30)};
        const Body body = random.body();
        set(block, body, posed(body, angles[l]), muscle, l);
      }
      const auto motion = motion_of(lines, block);
      for (std::size_t l = 0; l < lane_count; ++l) {
        const auto name = muscle_name(muscle);
        const auto check = [&](float arm, Joint joint) {
          EXPECT_GE(static_cast<float>(sign(name, joint)) * arm, 0)
              << name << " at " << angles[l].hip_deg << ' ' << angles[l].knee_deg << ' ' << angles[l].ankle_deg;
          EXPECT_EQ(arm != 0, crosses(muscle, joint)) << name;
        };
        check(motion.hip_flexion_arm_m[l], Joint::hip);
        check(motion.knee_flexion_arm_m[l], Joint::knee);
        check(motion.ankle_dorsiflexion_arm_m[l], Joint::ankle);
      }
    }
  }
}

// Any body, any pose, any small turn of any joints: the length changes as the arms predict, to second order.
TEST(MomentArms, LengthIsDifferentiableEverywhere) {
  constexpr double usual_bend_m = 0.25, bend_at_pelvis_m = 0.5;  // no arm changes by more per radian
  constexpr double longest_m = 0.13;                             // nor is any longer, in a body of 2.2 m
  Random random;
  for (const Muscle muscle : every_muscle()) {
    const MuscleLines lines = make_muscle_lines(muscle);
    const bool over_pelvis = muscle == Muscle::iliacus || muscle == Muscle::psoas || muscle == Muscle::iliopsoas;
    const double bend_m = over_pelvis ? bend_at_pelvis_m : usual_bend_m;
    for (int i = 0; i < 150; ++i) {
      Block block;
      std::array<double, lane_count> change, most;
      std::array<std::array<double, 3>, lane_count> by;
      for (std::size_t l = 0; l < lane_count; ++l) {
        const Body body = random.body();
        const LegFrames<double> leg = random.leg(body);
        set(block, body, leg, muscle, l);
        LegFrames<double> moved = leg;
        most[l] = 0;
        for (const Joint joint : {Joint::ankle, Joint::knee, Joint::hip}) {
          const double deg = random.between(-0.5, 0.5);
          by[l][static_cast<std::size_t>(joint)] = deg * degree;
          most[l] += std::abs(deg) * degree;
          moved = flexed(moved, joint, deg);
        }
        change[l] = muscle_length(muscle, leg_scale(body), moved) - muscle_length(muscle, leg_scale(body), leg);
      }
      const auto motion = motion_of(lines, block);
      for (std::size_t l = 0; l < lane_count; ++l) {
        const double arms[] = {static_cast<double>(motion.hip_flexion_arm_m[l]),
                               static_cast<double>(motion.knee_flexion_arm_m[l]),
                               static_cast<double>(motion.ankle_dorsiflexion_arm_m[l])};
        double by_arms = 0;
        for (std::size_t j = 0; j < 3; ++j) {
          by_arms -= arms[j] * by[l][j];
          EXPECT_LT(std::abs(arms[j]), longest_m);
        }
        EXPECT_NEAR(change[l], by_arms, 0.5 * bend_m * most[l] * most[l] + 2e-7) << muscle_name(muscle);
        EXPECT_LE(std::abs(change[l]), longest_m * most[l]) << muscle_name(muscle);
      }
    }
  }
}

// A fine sweep of each joint over its full range: second differences detect a jump of a micrometre.
TEST(MomentArms, NoJumpAnywhereInTheRangeOfAnyJoint) {
  constexpr double step_deg = 0.05, bend_m = 0.25;
  constexpr double most = bend_m * step_deg * degree * step_deg * degree;
  Random random;
  for (const auto& member : member_muscles()) {
    for (int i = 0; i < 4; ++i) {
      const Body body = random.body();
      const LegScale<double> scale = leg_scale(body);
      const LegAngles at = random.angles();
      for (const Joint joint : {Joint::hip, Joint::knee, Joint::ankle}) {
        const double from = joint == Joint::hip ? -30 : joint == Joint::knee ? -5 : -50;
        const double to = joint == Joint::hip ? 120 : joint == Joint::knee ? 144 : 30;
        double worst = 0, last = 0, before = 0;
        for (int k = 0; from + k * step_deg <= to; ++k) {
          const double now = member_length(member, scale, posed(body, with(at, joint, from + k * step_deg)));
          if (k > 1) worst = std::max(worst, std::abs(now - 2 * last + before));
          before = last;
          last = now;
        }
        EXPECT_LT(worst, most) << member.name << ' ' << static_cast<int>(joint);
      }
    }
  }
}

}  // namespace mobil::moment_arm_test
