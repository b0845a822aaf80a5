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

}  // namespace mobil::steering::steering_test
