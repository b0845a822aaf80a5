// Turning walkers: planted feet stay in place, footholds follow the line, and motion has no jumps.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>

#include "systems/gait/gait.h"
#include "tests/gait/walkers.h"

namespace mobil::turning_test {
constexpr double pi = 3.14159265358979323846, degree = pi / 180.0;
constexpr double max_turn = 30.0 * degree;

/// Returns natural walks toward random headings.
std::unique_ptr<Walkers> turning(unsigned seed) {
  auto w = random_walkers(seed);
  Dice dice{std::mt19937(seed + 100)};
  for (std::size_t l = 0; l < lane_count; ++l) {
    w->gait.heading_rad[l] = dice.single(-3, 3);
    w->state.line_x_m[l] = w->state.anchor_x_m[l] = dice.single(-5, 5);
    w->state.line_z_m[l] = w->state.anchor_z_m[l] = dice.single(-5, 5);
    w->state.heading_rad[l] = dice.single(-3, 3);
  }
  return w;
}

double wrapped(double angle) {
  return angle - 2 * pi * std::round(angle / (2 * pi));
}

/// A turn is limited per step, by the lateral foot offset, and by the requested heading.
TEST(Turning, TurnsTheShorterWayWithinItsLimits) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const auto w = turning(seed);
    for (int step = 0; step < 30; ++step) {
      const auto before = w->state;
      w->strike();
      for (std::size_t l = 0; l < lane_count; ++l) {
        const double off = wrapped(double{w->gait.heading_rad[l]} - w->state.heading_rad[l]);
        const double turn = w->state.turn_rad[l], bend = w->state.bend_next_per_m[l], height = w->size.leg_scale_m[l];
        const double sideways = std::pow(w->plan.to.speed_m_s[l], 2) * bend;
        EXPECT_LE(std::fabs(turn), max_turn + 1e-6);
        EXPECT_LE(std::fabs(sideways), 1.1 + 1e-5);
        EXPECT_LE(std::fabs(0.56 * height / 9.81 * sideways + w->state.shift_next_m[l]), 0.012 * height + 1e-5);
        EXPECT_LE(std::fabs(turn), std::fabs(off) + 0.07);  // foot placement is limited: a slight overshoot, and back
        EXPECT_GE(turn * off, -2e-3);
        EXPECT_EQ(w->state.turn_before_rad[l], before.turn_rad[l]);
        EXPECT_EQ(w->state.bend_before_per_m[l], before.bend_per_m[l]);
        EXPECT_EQ(w->state.bend_per_m[l], before.bend_next_per_m[l]);
        EXPECT_EQ(w->state.heading_rad[l], before.heading_rad[l] + before.turn_rad[l]);
      }
    }
    for (std::size_t l = 0; l < lane_count; ++l)
      EXPECT_NEAR(wrapped(double{w->gait.heading_rad[l]} - w->state.heading_rad[l]), 0.0, 2e-6);
  }
}

/// Up to 30° a step of 0.4 s, in place. A foot moves only while it is in the air, and both feet end at the requested
/// heading.
TEST(Turning, StandingPeopleTurnInPlace) {
  const auto w = turning(30);
  for (std::size_t l = 0; l < lane_count; ++l) w->ask(l, {.speed_m_s = 0.0F});
  plan_first_step(w->size, w->gait, w->plan);
  const GaitState<Lanes<float>> first = w->state;
  w->place();
  auto last = std::make_unique<Walkers>(*w);
  double slid = 0, lifted = 0;
  for (int i = 0; i < 480; ++i) {
    w->tick(1.0F / 60.0F);
    for (std::size_t l = 0; l < lane_count; ++l) {
      for (const std::size_t side : {Side::right, Side::left}) {
        const bool stands = side == w->state.stance_side[l] || w->state.time_s[l] < w->plan.double_support_s[l];
        const bool stood = side == last->state.stance_side[l] || last->state.time_s[l] < last->plan.double_support_s[l];
        const Vec3<float> toe = at(w->feet.toe_m[side], l);
        lifted = std::fmax(lifted, double{toe.y});
        if (stands && stood && w->state.steps[l] == last->state.steps[l])
          slid = std::fmax(slid, distance(toe, at(last->feet.toe_m[side], l)));
      }
    }
    *last = *w;
  }
  EXPECT_LT(slid, 1e-5);
  EXPECT_GT(lifted, 0.01);
  for (std::size_t l = 0; l < lane_count; ++l) {
    const double way = std::fabs(wrapped(double{w->gait.heading_rad[l]} - first.heading_rad[l]));
    EXPECT_LT(std::fabs(wrapped(double{w->gait.heading_rad[l]} - w->state.heading_rad[l])), 0.021);
    EXPECT_LE(w->state.steps[l], 2 + static_cast<unsigned>(way / max_turn));
    EXPECT_EQ(w->state.turn_before_rad[l], 0);
    EXPECT_EQ(w->state.line_x_m[l], first.line_x_m[l]);
    EXPECT_EQ(w->state.line_z_m[l], first.line_z_m[l]);
    for (const std::size_t side : {Side::right, Side::left}) {
      const double out = (side == Side::left ? 1.0 : -1.0) * w->plan.from.half_width_m[l],
                   heading = w->state.heading_rad[l];
      const Vec3<float> ankle = at(w->pose.position_m[index(on_side(Segment::foot_right, side))], l);
      EXPECT_NEAR(ankle.x, w->state.line_x_m[l] + out * std::cos(heading), 1e-4);
      EXPECT_NEAR(ankle.z, w->state.line_z_m[l] - out * std::sin(heading), 1e-4);
    }
  }
}

/// The line moves by the chord of each step. The foot that lands is next to the line's new point:
///
///                        o left foot: half_width + shift to the left of the point
///      *---- chord ----->*---- chord ----->*
///      o right foot                        o right foot
TEST(Turning, NextFootholdFollowsTheLine) {
  const auto w = turning(31);
  w->strike();
  for (int step = 0; step < 12; ++step) {
    const auto before = std::make_unique<Walkers>(*w);
    w->strike();
    for (std::size_t l = 0; l < lane_count; ++l) {
      const double chord = double{before->state.heading_rad[l]} + double{before->state.chord_rad[l]};
      const double length = before->plan.step_length_m[l];
      EXPECT_NEAR(w->state.line_x_m[l] - before->state.line_x_m[l], length * std::sin(chord), 3e-6);
      EXPECT_NEAR(w->state.line_z_m[l] - before->state.line_z_m[l], length * std::cos(chord), 3e-6);
    }
    for (std::size_t l = 0; l < lane_count; ++l) w->state.time_s[l] = 1.05F * flat_s(w->plan, l);
    w->place();
    for (std::size_t l = 0; l < lane_count; ++l) {
      const std::size_t side = w->state.stance_side[l];
      const double heading = w->state.heading_rad[l];
      const double left_of = (side == Side::left ? 1.0 : -1.0) * w->plan.from.half_width_m[l] + w->state.shift_m[l];
      const Vec3<float> ankle = at(w->pose.position_m[index(on_side(Segment::foot_right, side))], l);
      EXPECT_NEAR(ankle.x, w->state.line_x_m[l] + left_of * std::cos(heading), 3e-5);
      EXPECT_NEAR(ankle.z, w->state.line_z_m[l] - left_of * std::sin(heading), 3e-5);
      EXPECT_NEAR(ankle.y, fraction::ankle_height * w->size.leg_scale_m[l], 1e-3);  // the heel can be rising already
    }
  }
}

TEST(Turning, PlantedFeetDoNotMove) {
  double slid = 0, turned = 0;
  long counted = 0;
  for (unsigned seed = 41; seed <= 44; ++seed) {
    const auto w = turning(seed);
    for (int step = 0; step < 8; ++step) {
      // Observes the stance foot from foot flat to the end of the step, then as the other foot until it leaves the
      // ground.
      std::array<Vec3<float>, lane_count> ball, heading;
      std::array<std::size_t, lane_count> side;
      auto ahead = [&](std::size_t l, std::size_t s) {
        // The direction of the foot: along its third axis, projected to the ground.
        const Vec3<float> z = rotated(at(w->pose.rotation[index(on_side(Segment::foot_right, s))], l), {0, 0, 1});
        const float r = std::sqrt(z.x * z.x + z.z * z.z);
        return Vec3<float>{z.x / r, 0, z.z / r};
      };
      for (int i = 0; i <= 10; ++i) {
        for (std::size_t l = 0; l < lane_count; ++l) {
          const float flat = 1.05F * flat_s(w->plan, l);
          w->state.time_s[l] = flat + (w->plan.duration_s[l] - flat) * static_cast<float>(i) / 10.0F;
        }
        w->place();
        for (std::size_t l = 0; l < lane_count; ++l) {
          side[l] = w->state.stance_side[l];
          if (i == 0) ball[l] = at(w->feet.tip_m[side[l]], l), heading[l] = ahead(l, side[l]);
          slid = std::fmax(slid, distance(ball[l], at(w->feet.tip_m[side[l]], l)));
          turned = std::fmax(turned, distance(heading[l], ahead(l, side[l])));
        }
      }
      w->strike();
      for (int i = 0; i < 10; ++i) {
        for (std::size_t l = 0; l < lane_count; ++l)
          w->state.time_s[l] = w->plan.double_support_s[l] * static_cast<float>(i) / 10.0F;
        w->place();
        for (std::size_t l = 0; l < lane_count; ++l) {
          ++counted;
          slid = std::fmax(slid, distance(ball[l], at(w->feet.tip_m[side[l]], l)));
          turned = std::fmax(turned, distance(heading[l], ahead(l, side[l])));
        }
      }
    }
  }
  EXPECT_GT(counted, 4000);
  EXPECT_LT(slid, 1e-4);
  EXPECT_LT(turned, 1e-4);
}

TEST(Turning, WalkersArePlannedExactlyAtStrikes) {
  // For any tick, including steps that end within rounding of a tick.
  Dice dice{std::mt19937(61)};
  const auto w = random_walkers(61);
  for (int trial = 0; trial < 20000; ++trial) {
    const float tick_s = dice.single(1.0 / 240, 1.0 / 30);
    for (std::size_t l = 0; l < lane_count; ++l) {
      const float step = dice.single(0.3, 1.5);
      const auto what = static_cast<int>(dice(0, 5));
      w->plan.duration_s[l] = step;
      w->plan.settled[l] = 0;
      w->state.time_s[l] = what == 0   ? std::nextafter(step, 0.0F)
                           : what == 1 ? step - tick_s
                           : what == 2 ? std::nextafter(step - tick_s, 0.0F)
                                       : dice.single(0, step);
      if (w->state.time_s[l] >= step) w->state.time_s[l] = std::nextafter(step, 0.0F);
    }
    const auto before = w->state;
    advance_gait(w->plan, w->state, tick_s);
    const std::uint32_t lanes = lanes_to_plan(w->plan, w->gait, w->state, tick_s);
    for (std::size_t l = 0; l < lane_count; ++l) {
      const bool struck = w->state.steps[l] != before.steps[l];
      ASSERT_EQ((lanes >> l & 1U) != 0, struck)
          << "a step of " << w->plan.duration_s[l] << " s, tick " << tick_s << " s from " << before.time_s[l];
    }
  }
}

}  // namespace mobil::turning_test
