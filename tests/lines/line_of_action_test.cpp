// Lines of action in lanes, compared with the same paths in double precision, and properties that hold for any pose.
#include "systems/lines/line_of_action.h"
#include "systems/lines/leg_path-inl.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include <mobil/muscle_table.h>
#include "tests/lines/leg_block.h"

namespace mobil::line_of_action_test {
using namespace geometry;
using test::about;
using test::degree;
using test::LegAngles;
using test::posed;

using test::Block;
using test::every_muscle;
using test::Random;
using test::set;

Vec at(const Vec3<Lanes<float>>& v, std::size_t l) {
  return {static_cast<double>(v.x[l]), static_cast<double>(v.y[l]), static_cast<double>(v.z[l])};
}
Quat<double> at(const Quat<Lanes<float>>& q, std::size_t l) {
  return {static_cast<double>(q.x[l]), static_cast<double>(q.y[l]), static_cast<double>(q.z[l]),
          static_cast<double>(q.w[l])};
}

TEST(LineOfAction, LanesAgreeWithDouble) {
  Random random;
  for (const Muscle muscle : every_muscle()) {
    const MuscleLines lines = make_muscle_lines(muscle);
    for (int i = 0; i < 200; ++i) {
      Block block;
      std::array<double, lane_count> expected{};
      std::array<LegFrames<double>, lane_count> leg;
      for (std::size_t l = 0; l < lane_count; ++l) {
        const Body body = random.body();
        leg[l] = random.leg(body);
        set(block, body, leg[l], muscle, l);
        expected[l] = muscle_length(muscle, leg_scale(body), leg[l]);
      }
      lines_of_action(lines, block.scale, block.legs, FarEnd::held, block.line, block.end);
      Lanes<float> flexion;
      {
        using namespace HWY_NAMESPACE;
        store(HWY_NAMESPACE::knee_flexion(load(block.legs.thigh), load(block.legs.shank)), flexion);
      }
      for (std::size_t l = 0; l < lane_count; ++l) {
        EXPECT_NEAR(block.line.length_m[l], expected[l], 4e-6);
        EXPECT_NEAR(flexion[l], knee_flexion(leg[l]), 2e-6);
        const auto elongation =
            static_cast<double>(block.line.length_m[l]) - static_cast<double>(block.line.rest_length_m[l]);
        EXPECT_NEAR(block.end.to[l], elongation, 1e-7);
        EXPECT_NEAR(block.line.force_n[l], -static_cast<double>(block.line.stiffness_n_per_m[l]) * elongation, 1e-4);
      }
    }
  }
}

TEST(LineOfAction, StandingLinesAreUnstretchedInThePlannedFrame) {
  Random random;
  for (const Muscle muscle : every_muscle()) {
    const MuscleLines lines = make_muscle_lines(muscle);
    Block block;
    std::array<MusclePlan, lane_count> plan;
    for (std::size_t l = 0; l < lane_count; ++l) {
      const Body body = random.body();
      plan[l] = make_muscle_plan(body, muscle).value();
      set(block, body, anatomical_leg(body), muscle, l);
    }
    lines_of_action(lines, block.scale, block.legs, FarEnd::held, block.line, block.end);
    for (std::size_t l = 0; l < lane_count; ++l) {
      EXPECT_NEAR(block.end.to[l], 0, 3e-7);  // rounding of joint centres a metre above the ground
      EXPECT_EQ(block.end.from[l], block.end.to[l]);
      EXPECT_LT(length(at(block.line.start_m, l) - plan[l].start_m), 1e-6);
      const Quat<double> q = at(block.line.rotation, l), r = plan[l].rotation;
      EXPECT_NEAR(std::abs(q.x * r.x + q.y * r.y + q.z * r.z + q.w * r.w), 1, 1e-6);
    }
  }
}

TEST(LineOfAction, FrameIsOrthonormalAndAlignedWithTheLine) {
  Random random;
  for (const Muscle muscle : every_muscle()) {
    const MuscleLines lines = make_muscle_lines(muscle);
    const DrawnLine& drawn = muscle_row(muscle).drawn;
    for (int i = 0; i < 50; ++i) {
      Block block;
      std::array<Vec, lane_count> anchor;
      for (std::size_t l = 0; l < lane_count; ++l) {
        const Body body = random.body();
        const LegFrames<double> leg = random.leg(body);
        const LegScale<double> scale = leg_scale(body);
        set(block, body, leg, muscle, l);
        const Vec p = drawn.anchor.at_m;
        anchor[l] = drawn.anchor.bone == LegBone::pelvis ? leg.hip_m + rotated(leg.pelvis, scale.across * p)
                    : drawn.anchor.bone == LegBone::thigh
                        ? leg.hip_m + rotated(leg.thigh, {scale.across * p.x, scale.thigh * p.y, scale.across * p.z})
                        : leg.knee_m + rotated(leg.shank, {scale.across * p.x, scale.shank * p.y, scale.across * p.z});
      }
      lines_of_action(lines, block.scale, block.legs, FarEnd::held, block.line, block.end);
      for (std::size_t l = 0; l < lane_count; ++l) {
        const Quat<double> q = at(block.line.rotation, l);
        EXPECT_NEAR(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w, 1, 2e-6);
        // The start is start_m along z from the anchor.
        const Vec z = rotated(q, {0, 0, 1}), from = at(block.line.start_m, l) - anchor[l];
        EXPECT_NEAR(length(z), 1, 2e-6);
        EXPECT_NEAR(dot(from, z), length(from), 2e-6);
        EXPECT_EQ(drawn.start_m > 0, length(from) > 1e-4);
      }
    }
  }
}

TEST(LineOfAction, LengthAndFrameAreContinuousInTheJoints) {
  // No muscle's moment arm reaches 0.13 m at any joint in a body of 1.8 m.
  constexpr double longest_arm_m = 0.13, step_deg = 0.25;
  const Body body = make_body({1.8F, 80}).value();
  Random random;
  for (const Muscle muscle : every_muscle()) {
    const MuscleLines lines = make_muscle_lines(muscle);
    for (int path = 0; path < 40; ++path) {
      const LegAngles from = random.angles(), to = random.angles();
      const double most = std::abs(to.hip_deg - from.hip_deg) + std::abs(to.knee_deg - from.knee_deg) +
                          std::abs(to.ankle_deg - from.ankle_deg);
      const int steps = 1 + static_cast<int>(most / step_deg);
      double before = 0;
      Quat<double> frame_before{};
      for (int i = 0; i <= steps; i += static_cast<int>(lane_count)) {
        Block block;
        for (std::size_t l = 0; l < lane_count; ++l) {
          const double t = std::min(1.0, static_cast<double>(i + static_cast<int>(l)) / steps);
          const auto mix = [t](double a, double b) { return a + t * (b - a); };
          set(block, body,
              posed(body, {mix(from.hip_deg, to.hip_deg), mix(from.knee_deg, to.knee_deg),
                           mix(from.ankle_deg, to.ankle_deg)}),
              muscle, l);
        }
        lines_of_action(lines, block.scale, block.legs, FarEnd::held, block.line, block.end);
        for (std::size_t l = 0; l < lane_count; ++l) {
          const auto now = static_cast<double>(block.line.length_m[l]);
          const Quat<double> q = at(block.line.rotation, l), p = frame_before;
          if (i > 0 || l > 0) {
            EXPECT_LE(std::abs(now - before), longest_arm_m * most / steps * degree + 2e-6);
            // A frame turns with its bones, by at most three times their angle.
            const double turn = 2 * std::acos(std::min(1.0, std::abs(q.x * p.x + q.y * p.y + q.z * p.z + q.w * p.w)));
            EXPECT_LT(turn, 3 * most / steps * degree + 2e-3);
          }
          before = now;
          frame_before = q;
        }
      }
    }
  }
}

Pose<float> pose_of(const LegFrames<double>& leg, Side side) {
  Pose<float> pose{};
  const auto put = [&](Segment s, const Vec& p, const Quat<double>& q) {
    pose.position_m[index(s)] = to_float(p);
    pose.rotation[index(s)] = {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z),
                               static_cast<float>(q.w)};
  };
  put(Segment::pelvis, leg.hip_m, leg.pelvis);
  put(on_side(Segment::thigh_right, side), leg.hip_m, leg.thigh);
  put(on_side(Segment::shank_right, side), leg.knee_m, leg.shank);
  put(on_side(Segment::foot_right, side), leg.ankle_m, leg.foot);
  return pose;
}

LegFrames<double> mirror_image(LegFrames<double> leg) {
  for (auto* p : {&leg.hip_m, &leg.knee_m, &leg.ankle_m}) p->x = -p->x;
  for (auto* q : {&leg.pelvis, &leg.thigh, &leg.shank, &leg.foot}) *q = {q->x, -q->y, -q->z, q->w};
  return leg;
}

TEST(LineOfAction, LeftLegIsTheMirrorImageOfTheRight) {
  Random random;
  for (const Muscle muscle : every_muscle()) {
    const MuscleLines lines = make_muscle_lines(muscle);
    Block of_right, of_left;
    for (std::size_t l = 0; l < lane_count; ++l) {
      const Body body = random.body();
      const LegFrames<double> leg = random.leg(body);
      for (auto* block : {&of_right, &of_left}) set(*block, body, leg, muscle, l);
      gather_leg(pose_of(leg, Side::right), Side::right, of_right.legs, l);
      gather_leg(pose_of(mirror_image(leg), Side::left), Side::left, of_left.legs, l);
    }
    lines_of_action(lines, of_right.scale, of_right.legs, FarEnd::held, of_right.line, of_right.end);
    lines_of_action(lines, of_left.scale, of_left.legs, FarEnd::held, of_left.line, of_left.end);
    EXPECT_EQ(std::memcmp(&of_right.line, &of_left.line, sizeof of_left.line), 0);
  }
}

TEST(LineOfAction, GatheringFromABlockAndFromARowAreEqual) {
  Random random;
  std::vector<Lanes<float>> words(7 * segment_count);
  for (auto& word : words) {
    for (auto& value : word.lane) value = static_cast<float>(random.between(-1, 1));
  }
  for (std::size_t person = 0; person < lane_count; ++person) {
    Pose<float> row{};
    for (std::size_t s = 0; s < segment_count; ++s) {
      row.position_m[s] = {words[3 * s][person], words[3 * s + 1][person], words[3 * s + 2][person]};
      const std::size_t q = 3 * segment_count + 4 * s;
      row.rotation[s] = {words[q][person], words[q + 1][person], words[q + 2][person], words[q + 3][person]};
    }
    for (const Side side : {Side::right, Side::left}) {
      LegFrames<Lanes<float>> from_row{}, from_block{};
      gather_leg(row, side, from_row, 5);
      gather_leg(&words[0].lane[person], side, from_block, 5);
      EXPECT_EQ(std::memcmp(&from_row, &from_block, sizeof from_row), 0);
      const float mirror = side == Side::left ? -1.0F : 1.0F;
      EXPECT_EQ(from_row.knee_m.x[5], mirror * row.position_m[index(on_side(Segment::shank_right, side))].x);
      EXPECT_EQ(from_row.foot.y[5], mirror * row.rotation[index(on_side(Segment::foot_right, side))].y);
    }
  }
}

TEST(LineOfAction, LengthIsIndependentOfPositionAndHeading) {
  Random random;
  const Body body = make_body({1.7F, 65}).value();
  for (const Muscle muscle : every_muscle()) {
    const MuscleLines lines = make_muscle_lines(muscle);
    for (int i = 0; i < 20; ++i) {
      Block block;
      const LegAngles angles = random.angles();
      for (std::size_t l = 0; l < lane_count; ++l) {
        set(block, body, posed(body, angles, random.turn(180), random.place(l == 0 ? 0 : 20)), muscle, l);
      }
      lines_of_action(lines, block.scale, block.legs, FarEnd::held, block.line, block.end);
      for (std::size_t l = 1; l < lane_count; ++l) EXPECT_NEAR(block.line.length_m[l], block.line.length_m[0], 1e-5);
    }
  }
}

TEST(LineOfAction, TickStartsWhereTheLastOneEnded) {
  Random random;
  const Body body = make_body({1.9F, 90}).value();
  const MuscleLines lines = make_muscle_lines(Muscle::quadriceps);
  Block block, pulled;
  EndDrive<Lanes<float>> force{};
  EndDrive<Lanes<float>> last{};
  EndDrive<Lanes<float>> last_force{};
  for (int tick = 0; tick < 5; ++tick) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      const LegFrames<double> leg = random.leg(body);
      set(block, body, leg, Muscle::quadriceps, l);
      set(pulled, body, leg, Muscle::quadriceps, l);
    }
    lines_of_action(lines, block.scale, block.legs, FarEnd::held, block.line, block.end);
    lines_of_action(lines, pulled.scale, pulled.legs, FarEnd::sliding, pulled.line, force);
    for (std::size_t l = 0; l < lane_count; ++l) {
      EXPECT_EQ(block.end.from[l], tick == 0 ? block.end.to[l] : last.to[l]);
      EXPECT_EQ(force.from[l], tick == 0 ? force.to[l] : last_force.to[l]);
      EXPECT_EQ(force.to[l], -pulled.line.force_n[l]);  // the load is the spring's opposite
    }
    last = block.end;
    last_force = force;
  }
}

}  // namespace mobil::line_of_action_test
