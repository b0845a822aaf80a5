// Line speeds and moment arms in lanes, compared with differences of the lengths in double precision.
#include "systems/lines/line_motion.h"

#include <gtest/gtest.h>

#include <mobil/muscle_table.h>
#include "systems/lines/line_of_action.h"
#include "tests/engine/instruction_sets.h"
#include "tests/lines/leg_block.h"

namespace mobil::line_motion_test {
using namespace geometry;
using test::Block;
using test::degree;
using test::every_muscle;
using test::flexed;
using test::Joint;
using test::Random;
using test::set;

using Motion = LineMotion<Lanes<float>>;

double arm_at(const Motion& motion, Joint joint, std::size_t l) {
  return static_cast<double>(joint == Joint::hip    ? motion.hip_flexion_arm_m[l]
                             : joint == Joint::knee ? motion.knee_flexion_arm_m[l]
                                                    : motion.ankle_dorsiflexion_arm_m[l]);
}

TEST(LineMotion, ArmsAreDerivativesOfLengths) {
  Random random;
  for (const Muscle muscle : every_muscle()) {
    const MuscleLines lines = make_muscle_lines(muscle);
    for (int i = 0; i < 40; ++i) {
      Block block;
      Motion motion{};
      std::array<Body, lane_count> body;
      std::array<LegFrames<double>, lane_count> leg;
      for (std::size_t l = 0; l < lane_count; ++l) {
        body[l] = random.body();
        leg[l] = random.leg(body[l]);
        set(block, body[l], leg[l], muscle, l);
      }
      line_motion(lines, block.scale, block.legs, block.line, motion, 0.01F);
      for (std::size_t l = 0; l < lane_count; ++l) {
        const LegScale<double> scale = leg_scale(body[l]);
        for (const Joint joint : {Joint::hip, Joint::knee, Joint::ankle}) {
          constexpr double step_deg = 1e-3;
          const auto length_at = [&](double deg) { return muscle_length(muscle, scale, flexed(leg[l], joint, deg)); };
          const double arm = (length_at(-step_deg) - length_at(step_deg)) / (2 * step_deg * degree);
          EXPECT_NEAR(arm_at(motion, joint, l), arm, 8e-6) << muscle_name(muscle) << ' ' << static_cast<int>(joint);
        }
      }
    }
  }
}

TEST(LineMotion, SpeedIsTheLengthChangePerTick) {
  Random random;
  constexpr float tick_s = 1.0F / 60;
  for (const Muscle muscle : every_muscle()) {
    const MuscleLines lines = make_muscle_lines(muscle);
    Block block;
    Motion motion{};
    Lanes<float> before{};
    for (int tick = 0; tick < 4; ++tick) {
      for (std::size_t l = 0; l < lane_count; ++l) {
        const Body body = random.body();
        set(block, body, random.leg(body), muscle, l);
      }
      lines_of_action(lines, block.scale, block.legs, FarEnd::held, block.line, block.end);
      line_motion(lines, block.scale, block.legs, block.line, motion, tick_s);
      for (std::size_t l = 0; l < lane_count; ++l) {
        const float expected = tick == 0 ? 0 : (block.line.length_m[l] - before[l]) / tick_s;
        EXPECT_EQ(motion.speed_m_s[l], expected);
        EXPECT_EQ(motion.length_m[l], block.line.length_m[l]);
      }
      before = block.line.length_m;
    }
  }
}

}  // namespace mobil::line_motion_test
