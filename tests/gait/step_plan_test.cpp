// Solved steps of random walkers: each continues the last one smoothly after any request.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstring>

#include <mobil/components/step_plan.h>
#include "systems/gait/gait.h"
#include "systems/gait/kinematics.h"
#include "tests/gait/walkers.h"

namespace mobil::step_plan_test {
constexpr double degree = 3.14159265358979323846 / 180.0;

void expect_finite(const StepPlan<float>& plan) {
  StepPlan<float> p = plan;
  p.revision = p.settled = p.clamped = 0;  // integers
  const auto* word = reinterpret_cast<const float*>(&p);
  for (std::size_t i = 0; i < sizeof(p) / sizeof(float); ++i) ASSERT_TRUE(std::isfinite(word[i])) << "word " << i;
}

/// Joint angles as numbers, starting with the pelvis.
constexpr std::size_t angle_count = sizeof(JointAngles<float>) / sizeof(float);
using Angles = std::array<double, angle_count>;

Angles angles_of(const Walkers& w, std::size_t lane) {
  const JointAngles<float> r = row(w.angles, lane);
  Angles a;
  for (std::size_t i = 0; i < angle_count; ++i) a[i] = reinterpret_cast<const float*>(&r)[i];
  return a;
}

/// The pose at one end of a step.
struct Instant {
  std::array<std::array<Vec3<float>, segment_count>, lane_count> place;
  std::array<std::array<Quat<float>, segment_count>, lane_count> turned;
  std::array<Angles, lane_count> angle, rate;
  std::array<double, lane_count> hip_rate, height_rate;
};

/// Time of one-sided second-order differences, s, into the step from its start or from its end.
constexpr float moved = 1e-3F;

Instant instant(Walkers& w, bool at_end) {
  Instant at_this;
  std::array<std::array<Angles, 3>, lane_count> angle;
  std::array<std::array<Vec3<float>, 3>, lane_count> pelvis;
  for (std::size_t i = 3; i-- > 0;) {
    for (std::size_t l = 0; l < lane_count; ++l)
      w.state.time_s[l] = at_end ? w.plan.duration_s[l] - static_cast<float>(i) * moved : static_cast<float>(i) * moved;
    w.place();
    for (std::size_t l = 0; l < lane_count; ++l) {
      angle[l][i] = angles_of(w, l);
      pelvis[l][i] = at(w.pose.position_m[0], l);
    }
  }
  const double h = at_end ? -double{moved} : double{moved};
  auto slope = [&](double a, double b, double c) { return (-3.0 * a + 4.0 * b - c) / (2.0 * h); };
  for (std::size_t l = 0; l < lane_count; ++l) {
    for (std::size_t s = 0; s < segment_count; ++s) {
      at_this.place[l][s] = at(w.pose.position_m[s], l);
      at_this.turned[l][s] = at(w.pose.rotation[s], l);
    }
    at_this.angle[l] = angle[l][0];
    for (std::size_t i = 0; i < angle_count; ++i)
      at_this.rate[l][i] = slope(angle[l][0][i], angle[l][1][i], angle[l][2][i]);
    at_this.hip_rate[l] = slope(pelvis[l][0].z, pelvis[l][1].z, pelvis[l][2].z);
    at_this.height_rate[l] = slope(pelvis[l][0].y, pelvis[l][1].y, pelvis[l][2].y);
  }
  return at_this;
}

/// Returns true if an angle is of a leg so nearly straight that a tiny change of hip–ankle distance is degrees of it.
bool of_straight_leg(const Instant& at_this, std::size_t l, std::size_t angle) {
  constexpr std::size_t hip = offsetof(JointAngles<float>, hip_flexion) / sizeof(float), knee = hip + 2;
  return angle >= hip && angle < hip + 6 && at_this.angle[l][knee + (angle - hip) % 2] < 3 * degree;
}

/// Maximum jumps at a strike.
struct Jump {
  double place = 0, turn = 0, angle = 0, rate = 0, hip_rate = 0;

  void add(const Instant& before, const Instant& after, std::size_t l) {
    for (std::size_t s = 0; s < segment_count; ++s) {
      place = std::fmax(place, distance(before.place[l][s], after.place[l][s]));
      turn = std::fmax(turn, angle_between(before.turned[l][s], after.turned[l][s]));
    }
    for (std::size_t i = 0; i < angle_count; ++i) {
      angle = std::fmax(angle, std::fabs(before.angle[l][i] - after.angle[l][i]));
      if (of_straight_leg(before, l, i) || of_straight_leg(after, l, i)) continue;
      rate = std::fmax(rate, std::fabs(before.rate[l][i] - after.rate[l][i]));
    }
    hip_rate = std::fmax(hip_rate, std::fabs(before.hip_rate[l] - after.hip_rate[l]));
    hip_rate = std::fmax(hip_rate, std::fabs(before.height_rate[l] - after.height_rate[l]));
  }
};

/// Expects the end of one step to equal the start of the next.
void expect_joined(const StepPlan<float>& a, const StepPlan<float>& b) {
  EXPECT_EQ(a.step_length_m, b.length_before_m);
  EXPECT_EQ(std::memcmp(&a.to, &b.from, sizeof(a.to)), 0);
  EXPECT_NEAR(double{a.phase_rate_to} / double{a.duration_s}, double{b.phase_rate_from} / double{b.duration_s}, 1e-4);
  const bool changes_sides = a.landing > 0;  // not for people who remain standing
  EXPECT_EQ(changes_sides ? a.from.half_width_m : a.trailing_half_width_m, b.trailing_half_width_m);
  EXPECT_EQ(changes_sides ? a.from.toe_out : a.trailing_toe_out, b.trailing_toe_out);
  if (changes_sides) return;
  EXPECT_EQ(a.from.half_width_m, b.from.half_width_m);
  EXPECT_EQ(a.from.toe_out, b.from.toe_out);
}

/// Runs blocks of different walkers before their first step.
template <class Check>
void over_first_steps(unsigned seed, int blocks, double style_part, Check check) {
  Dice dice{std::mt19937(seed)};
  auto w = std::make_unique<Walkers>();
  for (int block = 0; block < blocks; ++block) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      w->set_body(l, random_body(dice));
      ask_anything(*w, l, dice, style_part);
      if (block == 0 && l == 7) w->ask(l, {.speed_m_s = 0.0F, .style = random_style(dice, style_part)});
    }
    w->begin();
    check(*w, block);
  }
}

TEST(FirstStep, IsSettledAndJoinsItsMirrorImage) {
  over_first_steps(1, 40, 0.5, [](const Walkers& w, int block) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      SCOPED_TRACE(testing::Message() << "block " << block << ", lane " << l);
      const StepPlan<float> p = row(w.plan, l);
      expect_finite(p);
      EXPECT_EQ(p.settled, 1U);
      EXPECT_EQ(p.revision, w.gait.revision[l]);
      expect_joined(p, p);
    }
  });
}

TEST(FirstStep, HasTheRequestedLengthAndTime) {
  over_first_steps(2, 20, 1.0, [](const Walkers& w, int) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      EXPECT_EQ(w.plan.step_length_m[l], w.gait.step_length_m[l]);
      EXPECT_EQ(w.plan.length_before_m[l], w.gait.step_length_m[l]);
      if (w.gait.speed_m_s[l] > 0) {
        EXPECT_NEAR(w.plan.duration_s[l] * w.gait.step_frequency_hz[l], 1.0F, 1e-5);
      }
      EXPECT_EQ(w.plan.double_support_s[l] > 0.0F, w.gait.speed_m_s[l] > 0);
      EXPECT_LE(w.plan.double_support_s[l], w.plan.duration_s[l]);
    }
  });
}

TEST(FirstStep, SettledStepIsUnchangedWhenPlannedAgain) {
  over_first_steps(3, 10, 0.5, [](Walkers& w, int block) {
    const auto before = std::make_unique<StepPlan<Lanes<float>>>(w.plan);
    w.strike();
    for (std::size_t l = 0; l < lane_count; ++l) {
      const StepPlan<float> a = row(*before, l), b = row(w.plan, l);
      EXPECT_EQ(std::memcmp(&a, &b, sizeof(a)), 0) << "block " << block << ", lane " << l;
    }
  });
}

/// Heavier people's feet are farther apart, with equal step length at one speed. Light people have usual steps.
TEST(FirstStep, HeavyPeopleWalkWithWiderSteps) {
  Walkers w;
  for (std::size_t l = 0; l < lane_count; ++l) {
    w.set_body(l, {.height_m = 1.70F, .mass_kg = 45.0F + 6.0F * static_cast<float>(l)});
    ASSERT_TRUE(w.ask(l, {.speed_m_s = 1.2F}));
  }
  w.begin();
  for (std::size_t l = 0; l < lane_count; ++l) {
    const double index = w.size.mass_kg[l] / (1.70 * 1.70);
    EXPECT_NEAR(w.plan.to.half_width_m[l] / (0.5 * 0.055 * w.size.leg_scale_m[l]),
                1 + 0.3 / 13.4 * std::fmax(index - 24.5, 0), 1e-3);
    EXPECT_EQ(w.plan.step_length_m[l], w.plan.step_length_m[0]);
    EXPECT_EQ(w.plan.double_support_s[l], w.plan.double_support_s[0]);
  }
}

TEST(NextStep, UnevenStepsAlternateAndJoin) {
  Dice dice{std::mt19937(4)};
  auto w = std::make_unique<Walkers>();
  for (std::size_t l = 0; l < lane_count; ++l) {
    w->set_body(l, random_body(dice));
    GaitRequest request;
    request.style.step_asymmetry = dice.single(-0.4, 0.4);
    request.style.time_asymmetry = dice.single(-0.3, 0.3);
    ASSERT_TRUE(w->ask(l, request));
  }
  w->begin();
  for (int step = 0; step < 6; ++step) {
    const auto before = std::make_unique<StepPlan<Lanes<float>>>(w->plan);
    w->strike();
    for (std::size_t l = 0; l < lane_count; ++l) {
      const StepPlan<float> a = row(*before, l), b = row(w->plan, l);
      expect_joined(a, b);
      EXPECT_EQ(b.settled, 0U);
      // After the first step, pairs add up to two mean steps; the right one is longer and slower by the requested
      // asymmetry.
      if (step == 0) continue;
      const Gait<float> g = row(w->gait, l);
      const float right_step = w->state.stance_side[l] == Side::left ? b.step_length_m : a.step_length_m;
      const float right_time = w->state.stance_side[l] == Side::left ? b.duration_s : a.duration_s;
      EXPECT_NEAR(right_step, g.step_length_m * (1 + g.style.step_asymmetry), 1e-5);
      EXPECT_NEAR(a.step_length_m + b.step_length_m, 2 * g.step_length_m, 1e-5);
      EXPECT_NEAR(right_time, (1 + g.style.time_asymmetry) / g.step_frequency_hz, 1e-5);
      EXPECT_NEAR(a.duration_s + b.duration_s, 2 / g.step_frequency_hz, 1e-5);
    }
  }
}

/// Changes the gait or heading of some walkers, or stops them; others continue.
void change_some(Walkers& w, Dice& dice, double style_part) {
  for (std::size_t l = 0; l < lane_count; ++l) {
    const double what = dice(0, 10);
    if (what < 4) ask_anything(w, l, dice, style_part);
    if (what >= 4 && what < 5.5) w.ask(l, {.speed_m_s = 0.0F, .style = random_style(dice, style_part)});
    if (what >= 5.5 && what < 7) ask_natural(w, l, dice, style_part);
    if (what >= 9) w.gait.heading_rad[l] = dice.single(-3, 3);
  }
}

/// Runs sixteen walkers through `steps` strikes with changes on the way. Calls check(before, after, lane, plan at the
/// end of the first step, walkers at the start of the second).
template <class Check>
void over_changes(unsigned seed, int steps, double style_part, Check check) {
  Dice dice{std::mt19937(seed)};
  auto w = random_walkers(seed, style_part);
  auto last = std::make_unique<StepPlan<Lanes<float>>>();
  const auto before = std::make_unique<Instant>(), after = std::make_unique<Instant>();
  for (int step = 0; step < steps; ++step) {
    change_some(*w, dice, style_part);
    *before = instant(*w, true);
    *last = w->plan;
    w->strike();
    *after = instant(*w, false);
    for (std::size_t l = 0; l < lane_count; ++l) {
      SCOPED_TRACE(testing::Message() << "step " << step << ", lane " << l);
      check(*before, *after, l, row(*last, l), *w);
    }
    if (testing::Test::HasFatalFailure()) return;
  }
}

/// Returns the jumps of fifty changes. Each step is finite and joins the one before.
Jump jump_through_changes(unsigned seed, double style_part) {
  Jump jump;
  over_changes(seed, 50, style_part, [&](const auto& before, const auto& after, std::size_t l, const auto& a, auto& w) {
    const StepPlan<float> b = row(w.plan, l);
    ASSERT_NO_FATAL_FAILURE(expect_finite(b));
    expect_joined(a, b);
    jump.add(before, after, l);
  });
  return jump;
}

TEST(NextStep, PoseAndRatesAreContinuousThroughEveryChange) {
  const Jump jump = jump_through_changes(5, 0.3);
  EXPECT_LT(jump.place, 1e-4);  // m
  EXPECT_LT(jump.turn, 3e-3);   // the resolution of rotations in single precision
  EXPECT_LT(jump.angle, 0.05 * degree);
  EXPECT_LT(jump.rate, 1.5);       // rad/s, of rates up to 20: near a straight knee rates are steep
  EXPECT_LT(jump.hip_rate, 0.04);  // m/s
}

TEST(NextStep, StylesAtTheEndsOfTheirRangesStillJoin) {
  const Jump jump = jump_through_changes(6, 1.0);
  EXPECT_LT(jump.place, 1e-4);
  EXPECT_LT(jump.turn, 3e-3);
  EXPECT_LT(jump.angle, 0.05 * degree);
  EXPECT_LT(jump.hip_rate, 0.8);  // if a leg is too short at a strike the pelvis sinks with it
}

TEST(NextStep, ImpossibleGaitsAreClampedAndStaySmooth) {
  Dice dice{std::mt19937(8)};
  auto w = random_walkers(8);
  auto last = std::make_unique<StepPlan<Lanes<float>>>();
  const auto before = std::make_unique<Instant>(), after = std::make_unique<Instant>();
  Jump jump;
  int clamped = 0;
  for (int step = 0; step < 30; ++step) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      // Far beyond the limits of resolve_gait: up to 12 m/s, steps of two leg lengths, six steps a second.
      w->gait.speed_m_s[l] = step % 10 < 7 ? dice.single(4, 12) : 0.0F;
      w->gait.step_length_m[l] = step % 10 < 7 ? dice.single(0.3, 2.0) * w->size.height_m[l] * 0.49F : 0.0F;
      w->gait.step_frequency_hz[l] = step % 10 < 7 ? w->gait.speed_m_s[l] / w->gait.step_length_m[l] : 0.0F;
      ++w->gait.revision[l];
    }
    *before = instant(*w, true);
    *last = w->plan;
    w->strike();
    *after = instant(*w, false);
    for (std::size_t l = 0; l < lane_count; ++l) {
      SCOPED_TRACE(testing::Message() << "step " << step << ", lane " << l);
      const StepPlan<float> a = row(*last, l), b = row(w->plan, l);
      ASSERT_NO_FATAL_FAILURE(expect_finite(b));
      expect_joined(a, b);
      clamped += b.clamped != 0;
      jump.add(*before, *after, l);
    }
  }
  EXPECT_GT(clamped, 100);
  EXPECT_LT(jump.place, 1e-4);
  EXPECT_LT(jump.angle, 0.05 * degree);
}

TEST(NextStep, SpeedChangesAreLimitedAndArrive) {
  constexpr double faster = 0.30, slower = 0.60, first = 0.60, last_speed = 1.35;  // m/s at a leg of 0.90 m
  for (unsigned seed = 11; seed <= 20; ++seed) {
    Dice dice{std::mt19937(seed)};
    auto w = random_walkers(seed);
    for (int change = 0; change < 8; ++change) {
      change_some(*w, dice, 0.3);
      for (int step = 0; step < 12; ++step) {
        w->strike();
        for (std::size_t l = 0; l < lane_count; ++l) {
          const double leg = w->body[l].thigh_length_m + w->body[l].shank_length_m, scale = std::sqrt(leg / 0.90);
          const double from = w->plan.from.speed_m_s[l], to = w->plan.to.speed_m_s[l], aim = w->gait.speed_m_s[l];
          const double most = from == 0 ? first : faster, least = to == 0 ? last_speed : slower;
          EXPECT_LE(to - from, most * scale + 1e-6);
          EXPECT_LE(from - to, std::fmax(least, slower) * scale + 1e-6);
          // Speeds approach the requested one and never overshoot.
          EXPECT_LE(std::fabs(aim - to), std::fabs(aim - from) + 1e-6);
          EXPECT_GE((aim - from) * (to - from), 0.0);
        }
      }
      // From the fastest walk to standing: seven steps of slowing down, one to stop.
      for (std::size_t l = 0; l < lane_count; ++l) EXPECT_EQ(w->plan.to.speed_m_s[l], w->gait.speed_m_s[l]);
    }
  }
}

TEST(NextStep, StoppedWalkersStandWithBothFeetFlatSideBySide) {
  auto w = random_walkers(9, 0.3);
  for (int step = 0; step < 5; ++step) w->strike();
  for (std::size_t l = 0; l < lane_count; ++l) w->ask(l, {.speed_m_s = 0.0F, .style = row(w->gait.style, l)});
  const auto steps_before = w->state.steps;
  for (int step = 0; step < 12; ++step) w->strike();
  std::array<Vec3<float>, lane_count> stood;
  for (float part : {0.0F, 0.5F, 1.0F}) {
    w->place_at(part);
    for (std::size_t l = 0; l < lane_count; ++l) {
      SCOPED_TRACE(testing::Message() << "lane " << l << ", part " << part);
      const StepPlan<float> p = row(w->plan, l);
      EXPECT_EQ(p.settled, 1U);
      EXPECT_EQ(p.clamped, 0U);
      EXPECT_LE(w->state.steps[l] - steps_before[l], 9U);
      const Vec3<float> pelvis = at(w->pose.position_m[0], l);
      std::array<Vec3<float>, 2> ankle;
      for (std::size_t side = 0; side < 2; ++side) {
        const Vec3<float> heel = at(w->feet.heel_m[side], l), toe = at(w->feet.toe_m[side], l);
        EXPECT_NEAR(heel.y, 0.0F, 1e-5);
        EXPECT_NEAR(toe.y, 0.0F, 1e-5);
        ankle[side] = at(w->pose.position_m[index(on_side(Segment::foot_right, side))], l);
      }
      EXPECT_NEAR(ankle[0].z, ankle[1].z, 1e-5);
      EXPECT_NEAR(ankle[1].x - ankle[0].x, 2 * p.from.half_width_m, 1e-5);
      EXPECT_NEAR(pelvis.x, 0.5F * (ankle[0].x + ankle[1].x), 1e-5);
      if (part == 0) stood[l] = pelvis;
      EXPECT_LT(distance(pelvis, stood[l]), 1e-5);  // the hips do not move
    }
  }
}

/// A standing walker with a new style steps in place until both feet match it; no foot slides.
TEST(NextStep, StandingStyleChangesWithoutSlidingFeet) {
  Dice dice{std::mt19937(10)};
  auto w = random_walkers(10, 0.3);
  for (std::size_t l = 0; l < lane_count; ++l) w->ask(l, {.speed_m_s = 0.0F, .style = random_style(dice, 0.5)});
  for (int step = 0; step < 12; ++step) w->strike();
  using Foot = std::array<Vec3<float>, 2>;
  const auto foot = [&](std::size_t l, std::size_t side) {
    return Foot{at(w->feet.heel_m[side], l), at(w->feet.toe_m[side], l)};
  };
  const auto apart = [](const Foot& a, const Foot& b) { return std::max(distance(a[0], b[0]), distance(a[1], b[1])); };
  for (int step = 0; step < 6; ++step) {
    for (std::size_t l = 0; l < lane_count; ++l) w->ask(l, {.speed_m_s = 0.0F, .style = random_style(dice, 0.5)});
    w->strike();
    w->place_at(0.1F);
    std::array<Foot, lane_count> stood;
    for (std::size_t l = 0; l < lane_count; ++l) stood[l] = foot(l, w->state.stance_side[l]);
    w->place_at(0.9F);
    for (std::size_t l = 0; l < lane_count; ++l)
      ASSERT_LT(apart(foot(l, w->state.stance_side[l]), stood[l]), 1e-4) << "step " << step;
  }
  for (int step = 0; step < 4; ++step) w->strike();
  w->place_at(0.5F);
  std::array<std::array<Foot, 2>, lane_count> there;
  for (std::size_t l = 0; l < lane_count; ++l) there[l] = {foot(l, Side::right), foot(l, Side::left)};
  for (int step = 0; step < 4; ++step) {
    w->strike();
    w->place_at(0.5F);
    for (std::size_t l = 0; l < lane_count; ++l) {
      for (const Side side : {Side::right, Side::left}) ASSERT_LT(apart(foot(l, side), there[l][side]), 1e-4);
    }
  }
}

}  // namespace mobil::step_plan_test
