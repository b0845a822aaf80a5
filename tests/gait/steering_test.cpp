// A thousand requests to walkers of all builds at random times. Poses have no jumps, planted feet stay in place, and
// requests are fulfilled.
// The tests share the crowds, so they run in one process.
#include "tests/gait/steering.h"

#include <gtest/gtest.h>

#include "tests/labels.h"

MOBIL_TEST_LABELS("slow");

namespace mobil::steering::steering_test {
constexpr double degree = std::numbers::pi / 180;

/// Maximum rates of the mean curves of measured walking, central differences over 2 % of the cycle: hip flexion and
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

/// The usual style up to the measured fast walk: speeds, stops and headings.
const Findings& usual() {
  static const Findings all = crowds(3, 1.0 / 240, 100, {.slowest = 0.5, .fastest = 1.66}, 20);
  return all;
}

/// Requests of speeds and stops, without headings.
const Findings& straight() {
  static const Findings all = crowds(2, 1.0 / 240, 150, {.heading = false, .slowest = 0.5, .fastest = 1.66}, 20);
  return all;
}

/// All kinds of requests, at two tick lengths.
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

TEST(Steering, SegmentsAreNoFasterThanASwingingFoot) {
  // Relative to the walk's speed plus 0.5 m/s.
  EXPECT_WITHIN(usual().origin_speed, 4.3);     // feet of people who turn on the spot
  EXPECT_WITHIN(anything().origin_speed, 7.2);  // unusual styles at the limits of walking
}

TEST(Steering, JointRatesDoNotJump) {
  const Asking asking{.slowest = 0.5, .fastest = 1.66};
  const Findings coarse = Crowd(1.0 / 960, 400, asking).walk(10);
  const Findings fine = Crowd(1.0 / 3840, 400, asking).walk(10);
  ASSERT_EQ(coarse.changes, fine.changes);
  for (std::size_t j = 0; j < joint_names.size(); ++j) {
    // In a smooth motion the change from tick to tick shrinks with the tick; in a jump it does not. The aim is to allow
    // for rounding only, but standing legs still jump by this much.
    EXPECT_WITHIN(fine.kink[j], 0.4 * coarse.kink[j].value + 35 * degree);
    EXPECT_GT(fine.kink[j].value, 0.1 * coarse.kink[j].value);  // the same motion
  }
}

TEST(Steering, PlantedFeetStayInPlace) {
  // Only the heel's pad moves, as it yields after the strike.
  EXPECT_WITHIN(usual().slide, 0.005);
  EXPECT_WITHIN(usual().turning_slide, 0.005);
  EXPECT_WITHIN(anything().slide, 0.0085);
  EXPECT_WITHIN(anything().turning_slide, 0.008);
}

TEST(Steering, NothingSinksIntoTheGround) {
  // The aim is a millimetre. Tips of toes dip as they leave the ground, most in the step to a stand.
  EXPECT_WITHIN(usual().sunk, 0.01);
  EXPECT_WITHIN(anything().sunk, 0.018);
}

TEST(Steering, LegsReachTheirFeet) {
  EXPECT_WITHIN(usual().apart, 2e-5);
  EXPECT_WITHIN(anything().apart, 2e-5);
}

TEST(Steering, NoJointTurnsMuchFasterThanMeasured) {
  // The aim is 1.5 each, turning or not. The ankle is faster at toe-off of fast walks.
  for (const Findings* walks : {&straight(), &usual()}) {
    EXPECT_WITHIN(walks->joint_rate[0], 1.5 * fastest_measured[0]);
    EXPECT_WITHIN(walks->joint_rate[1], 1.5 * fastest_measured[1]);
    EXPECT_WITHIN(walks->joint_rate[2], 2.9 * fastest_measured[2]);
  }
}

TEST(Steering, SteadySpeedIsTheRequestedOne) {
  EXPECT_GT(usual().steady_steps, 100);
  EXPECT_GT(anything().steady_steps, 100);
  EXPECT_WITHIN(usual().speed_off, 0.01);
  EXPECT_WITHIN(anything().speed_off, 0.01);
}

}  // namespace mobil::steering::steering_test
