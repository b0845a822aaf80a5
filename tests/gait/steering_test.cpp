// Walking that changes its mind: a thousand requests to walkers of all builds at random times. Poses go on without a
// jump, feet stay where they stand, and everybody does as asked.
// One process for all tests of a suite: the crowds walk once.
#include "tests/gait/steering.h"

#include <gtest/gtest.h>

#include "tests/labels.h"

MOBIL_TEST_LABELS("slow");

namespace mobil::steering::steering_test {
constexpr double degree = std::numbers::pi / 180;

/// Greatest rates of the mean curves of measured walking, central differences over 2 % of the cycle: hip flexion and
/// ankle plantarflexion of Schwartz, Rozumalski & Trost 2008 (fast, cadence 0.662 √(g/leg) at a leg of 0.90 m), knee
/// extension of Winter 1991 (fast, 123.1 steps a minute). rad/s.
constexpr std::array<double, 3> fastest_measured = {240 * degree, 408 * degree, 348 * degree};

Findings crowds(int count, double tick_s, std::uint64_t seed, const Asking& asking, double seconds) {
  Findings all;
  for (int i = 0; i < count; ++i) {
    all.keep(Crowd(tick_s, seed + static_cast<std::uint64_t>(i), asking).walk(seconds));
  }
  return all;
}

/// The usual style up to the fast walk of the measured: speeds, stops and headings.
const Findings& usual() {
  static const Findings all = crowds(3, 1.0 / 240, 100, {.slowest = 0.5, .fastest = 1.66}, 20);
  return all;
}

/// The same without the headings.
const Findings& straight() {
  static const Findings all = crowds(2, 1.0 / 240, 150, {.heading = false, .slowest = 0.5, .fastest = 1.66}, 20);
  return all;
}

/// Everything that may be asked, at two ticks.
const Findings& anything() {
  static const Findings all = [] {
    const Asking asking{.step_length = true, .limp = true, .style = true};
    Findings f = crowds(2, 1.0 / 240, 200, asking, 20);
    f.keep(crowds(3, 1.0 / 60, 300, asking, 20));
    return f;
  }();
  return all;
}

#define EXPECT_WITHIN(worst, most) EXPECT_LE((worst).value, most) << (worst).where

TEST(Steering, AThousandRequestsLeaveEverythingFinite) {
  EXPECT_GE(usual().changes + anything().changes, 1000);
  EXPECT_WITHIN(usual().not_finite, 0);
  EXPECT_WITHIN(anything().not_finite, 0);
}

TEST(Steering, NoSegmentIsFasterThanAFootSwings) {
  // Of the walk's speed and half a metre a second.
  EXPECT_WITHIN(usual().origin_speed, 4.3);     // the feet of who turns on the spot
  EXPECT_WITHIN(anything().origin_speed, 7.2);  // odd styles at the limits of what can be walked
}

TEST(Steering, JointRatesDoNotJump) {
  const Asking asking{.slowest = 0.5, .fastest = 1.66};
  const Findings coarse = Crowd(1.0 / 960, 400, asking).walk(10);
  const Findings fine = Crowd(1.0 / 3840, 400, asking).walk(10);
  ASSERT_EQ(coarse.changes, fine.changes);
  for (std::size_t j = 0; j < joint_names.size(); ++j) {
    // Of a smooth motion the change from tick to tick shrinks with the tick, of a jump it does not. The aim is to allow
    // for rounding alone; standing legs still jump by as much as this.
    EXPECT_WITHIN(fine.kink[j], 0.4 * coarse.kink[j].value + 35 * degree);
    EXPECT_GT(fine.kink[j].value, 0.1 * coarse.kink[j].value);  // the same motion
  }
}

TEST(Steering, WhatStandsStaysWhereItIs) {
  // Nothing but the heel's pad, which yields as the heel strikes.
  EXPECT_WITHIN(usual().slide, 0.005);
  EXPECT_WITHIN(usual().turning_slide, 0.005);
  EXPECT_WITHIN(anything().slide, 0.008);
  EXPECT_WITHIN(anything().turning_slide, 0.008);
}

TEST(Steering, NothingSinksIntoTheGround) {
  // The aim is a millimetre: tips of toes dip as they leave the ground, most in the step to a stand.
  EXPECT_WITHIN(usual().sunk, 0.01);
  EXPECT_WITHIN(anything().sunk, 0.018);
}

TEST(Steering, LegsReachTheirFeet) {
  EXPECT_WITHIN(usual().apart, 2e-5);
  EXPECT_WITHIN(anything().apart, 2e-5);
}

TEST(Steering, NoJointTurnsMuchFasterThanMeasured) {
  // The aim is 1.5 each, turning or not: the ankle is faster, at toe-off of fast walks.
  for (const Findings* walks : {&straight(), &usual()}) {
    EXPECT_WITHIN(walks->joint_rate[0], 1.5 * fastest_measured[0]);
    EXPECT_WITHIN(walks->joint_rate[1], 1.5 * fastest_measured[1]);
    EXPECT_WITHIN(walks->joint_rate[2], 2.9 * fastest_measured[2]);
  }
}

TEST(Steering, SteadySpeedIsTheAskedOne) {
  EXPECT_GT(usual().steady_steps, 100);
  EXPECT_GT(anything().steady_steps, 100);
  EXPECT_WITHIN(usual().speed_off, 0.01);
  EXPECT_WITHIN(anything().speed_off, 0.01);
}

// ------------------------------------------------------------------------------------------------ doing as asked

/// One walker, and the footholds as they come.
struct One {
  Simulation simulation;
  Entity entity;
  double scale = 1;

  explicit One(Source& random, double tick_s, const GaitRequest& gait = {}) : simulation({.tick_s = tick_s}) {
    for (;;) {
      const BodyRequest body = any_body(random);
      const auto made = make_body(body);
      GaitRequest first = gait;
      scale = std::sqrt(static_cast<double>(made->thigh_length_m + made->shank_length_m) / 0.90);
      if (!first.speed_m_s) first.speed_m_s = static_cast<float>(random.uniform(0.5, 1.7) * scale);
      const auto spawned = simulation.spawn(body, first);
      if (!spawned) continue;
      entity = *spawned;
      return;
    }
  }

  GaitState<float> state() const { return *simulation.get<GaitState>(entity); }
  StepPlan<float> plan() const { return *simulation.get<StepPlan>(entity); }
  void walk(double seconds) {
    const auto ticks = static_cast<int>(std::lround(seconds / simulation.tick_s()));
    for (int i = 0; i < ticks; ++i) simulation.tick();
  }
  /// Until the next foothold, and when the heel struck there.
  double step() {
    const std::uint32_t before = state().steps;
    for (int i = 0; i < 10000 && state().steps == before; ++i) simulation.tick();
    EXPECT_NE(state().steps, before) << "no step in " << 10000 * simulation.tick_s() << " s";
    return simulation.time_s() - static_cast<double>(state().time_s);
  }
};

TEST(Steering, AWalkerAskedToStopStandsStillAndStartsAgain) {
  Source random{std::mt19937_64(500)};
  for (int i = 0; i < 40; ++i) {
    One one(random, i % 2 == 0 ? 1.0 / 240 : 1.0 / 60);
    one.walk(random.uniform(0, 2));
    const std::uint32_t steps = one.state().steps;
    ASSERT_TRUE(one.simulation.change_gait(one.entity, {.speed_m_s = 0.0F}));
    one.walk(6);
    // The step under way; then slower by at least 0.5 m/s each, and one to stand.
    EXPECT_LE(one.state().steps - steps, 6U) << i;
    const auto still = *one.simulation.get<Pose>(one.entity);
    const std::uint32_t stood = one.state().steps;
    double moved = 0;
    for (int tick = 0; tick < 60; ++tick) {
      one.simulation.tick();
      const auto now = *one.simulation.get<Pose>(one.entity);
      for (std::size_t s = 0; s < segment_count; ++s) {
        moved = std::max(moved,
                         geometry::length(geometry::operator-(exact(now.position_m[s]), exact(still.position_m[s]))));
      }
    }
    EXPECT_EQ(one.state().steps, stood) << i;
    EXPECT_LT(moved, 0.003) << i;
    const auto feet = *one.simulation.get<Feet>(one.entity);
    const Vec3<double> apart = geometry::operator-(exact(feet.heel_m[0]), exact(feet.heel_m[1]));
    const auto heading = static_cast<double>(one.state().heading_rad);
    EXPECT_LT(std::abs(apart.x * std::sin(heading) + apart.z * std::cos(heading)), 0.005) << i;  // side by side

    const auto speed = static_cast<float>(random.uniform(0.5, 1.7) * one.scale);
    const auto started = one.simulation.change_gait(one.entity, {.speed_m_s = speed});
    ASSERT_TRUE(started) << started.error().message;
    const double asked_at = one.simulation.time_s();
    one.step();
    EXPECT_LT(one.simulation.time_s() - asked_at, 2.5) << i;
    for (int step = 0; step < 5; ++step) one.step();
    EXPECT_EQ(one.plan().settled, 1U) << i;
    EXPECT_EQ(one.plan().to.speed_m_s, speed) << i;
  }
}

/// The shorter way round from one heading to another.
double shorter(double from, double to) {
  return std::remainder(to - from, 2 * std::numbers::pi);
}

TEST(Steering, AHeadingIsReachedByTheShorterWayAndThenKept) {
  Source random{std::mt19937_64(600)};
  for (int i = 0; i < 40; ++i) {
    One one(random, i % 2 == 0 ? 1.0 / 240 : 1.0 / 60);
    one.walk(random.uniform(0, 2));
    for (int turn = 0; turn < 2; ++turn) {
      const auto wanted = static_cast<double>(random.between(-7, 7));
      const auto first = static_cast<double>(one.state().heading_rad);
      const double way = shorter(first, wanted);
      if (std::abs(std::abs(way) - std::numbers::pi) < 0.01) continue;  // either way
      ASSERT_TRUE(one.simulation.turn_to(one.entity, static_cast<float>(wanted)));
      double heading = first;
      const auto most = static_cast<int>(std::ceil(std::abs(way) / (10 * degree))) + 6;
      for (int step = 0; step < most; ++step) {
        one.step();
        const auto next = static_cast<double>(one.state().heading_rad);
        EXPECT_GE((next - heading) * (way > 0 ? 1 : -1), -1e-5) << i;  // never back
        EXPECT_LE(std::abs(next - heading), 30 * degree + 1e-5) << i;
        heading = next;
      }
      EXPECT_NEAR(shorter(heading, wanted), 0, 1e-4) << i;
      EXPECT_NEAR(heading - first, way, 1e-4) << i;
    }
    const GaitState<float> from = one.state();
    for (int step = 0; step < 6; ++step) one.step();
    const GaitState<float> to = one.state();
    const double x = static_cast<double>(to.line_x_m) - static_cast<double>(from.line_x_m);
    const double z = static_cast<double>(to.line_z_m) - static_cast<double>(from.line_z_m);
    const double s = std::sin(static_cast<double>(from.heading_rad));
    const double c = std::cos(static_cast<double>(from.heading_rad));
    EXPECT_LT(std::abs(x * c - z * s), 0.001) << i;  // aside
    EXPECT_GT(x * s + z * c, 1) << i;
  }
}

/// Or as much of that as keeps the limits of a walk.
TEST(Steering, ALimpsStepsAreUnevenAsAsked) {
  Source random{std::mt19937_64(700)};
  int limping = 0;
  for (int i = 0; i < 40; ++i) {
    One one(random, i % 2 == 0 ? 1.0 / 240 : 1.0 / 60);
    one.walk(random.uniform(0, 2));
    GaitRequest request{.speed_m_s = static_cast<float>(random.uniform(0.5, 1.5) * one.scale)};
    request.style.step_asymmetry = random.between(-0.4, 0.4);
    request.style.time_asymmetry = random.between(-0.3, 0.3);
    const auto changed = one.simulation.set_gait(one.entity, request);
    ASSERT_TRUE(changed) << changed.error().message;
    const auto gait = *one.simulation.get<Gait>(one.entity);
    for (int step = 0; step < 6; ++step) one.step();
    double at = one.simulation.time_s() - static_cast<double>(one.state().time_s);
    auto place = static_cast<double>(one.state().line_z_m);
    const double started = at, from = place;
    for (int step = 0; step < 4; ++step) {
      const double next = one.step();
      const auto there = static_cast<double>(one.state().line_z_m);
      const double sign = one.state().stance_side == Side::right ? 1 : -1;  // whose foot landed
      EXPECT_NEAR((there - place) / static_cast<double>(gait.step_length_m),
                  1 + sign * static_cast<double>(gait.style.step_asymmetry), 1e-3)
          << i;
      EXPECT_NEAR((next - at) * static_cast<double>(gait.step_frequency_hz),
                  1 + sign * static_cast<double>(gait.style.time_asymmetry), 2e-3)
          << i;
      at = next;
      place = there;
      ++limping;
    }
    EXPECT_NEAR((place - from) / (at - started) / static_cast<double>(*request.speed_m_s), 1, 0.01) << i;
  }
  EXPECT_EQ(limping, 160);
}

}  // namespace mobil::steering::steering_test
