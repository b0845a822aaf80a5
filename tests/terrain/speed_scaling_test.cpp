// Speed scaling of walkers on slopes and stairs.

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <mobil/avoidance.h>
#include <mobil/components/avoidance.h>
#include <mobil/components/gait.h>
#include <mobil/components/step_plan.h>
#include <mobil/systems/limits/style_limits.h>
#include "assets/gait/slope_pace.h"
#include "systems/gait/gait.h"
#include "tests/interfaces.h"
#include "tests/terrain/hike.h"

namespace mobil {
namespace {

constexpr float first_m = 8, last_m = 24;  // start and end of the slope

HeightOf ramp(float rise) {
  return [=](float, float z) {
    const bool on = z > first_m && z < last_m;
    return TerrainHeight{rise * (std::clamp(z, first_m, last_m) - first_m), 0, on ? rise : 0.0F};
  };
}

Hike hike_on(HeightOf ground, const GaitRequest& gait) {
  return Hike(std::move(ground), gait, {.height_m = 1.75F, .mass_kg = 75}, 1.0 / 60, 0, {.slows_down = true});
}

/// A walker who also avoids others.
struct Avoider {
  Hike hike;
  Avoidance avoidance;

  Avoider(HeightOf ground, const GaitRequest& gait)
      : hike(hike_on(std::move(ground), gait)), avoidance(hike.simulation.avoidance()) {
    EXPECT_TRUE(avoidance.manage(hike.person));
  }
  void tick() { hike.tick(); }
  void walk_to(float z_m) {
    for (int i = 0; i < 6000 && hike.get<GaitState>().line_z_m < z_m; ++i) tick();
    ASSERT_GE(hike.get<GaitState>().line_z_m, z_m);
  }
};

void walk_to(Hike& hike, float z_m) {
  for (int i = 0; i < 6000 && hike.get<GaitState>().line_z_m < z_m; ++i) hike.tick();
  ASSERT_GE(hike.get<GaitState>().line_z_m, z_m);
}

/// A walker on a slope of 15 %, already slowed.
struct Slowed : Hike {
  Slowed()
      : Hike(ramp(0.15F), {.speed_m_s = 1.3F}, {.height_m = 1.75F, .mass_kg = 75}, 1.0 / 60, 0, {.slows_down = true}) {
    walk_to(*this, first_m + 4);
    EXPECT_LT(get<Gait>().speed_m_s, 1.0F);
  }
};

TEST(SlopeSpeed, FallsWithSteepnessAndKeepsLowSpeeds) {
  rc::check([] {
    const float asked = static_cast<float>(*rc::gen::inRange(100, 2500)) / 1000;
    const float steep = static_cast<float>(*rc::gen::inRange(-1000, 1000)) / 1000;
    const float speed = slope_speed(asked, steep);
    RC_ASSERT(speed <= asked && speed >= std::min(asked, 0.6F));
    RC_ASSERT(slope_speed(asked, steep + (steep < -0.05F ? -0.01F : 0.01F)) <= speed);
    if (steep >= -0.1F && steep <= 0) RC_ASSERT(std::fabs(speed - asked) < 1e-6F);
  });
  EXPECT_NEAR(slope_speed(1.4F, 0.1F) / 1.4F, std::exp(-0.35), 1e-6);
  EXPECT_NEAR(slope_speed(1.4F, -0.3F) / 1.4F, std::exp(-0.7), 1e-6);
}

TEST(SpeedScaling, WalkersSlowDownOnASlopeAndThenResume) {
  for (const float rise : {0.15F, -0.25F}) {
    Hike hike = hike_on(ramp(rise), {.speed_m_s = 1.3F});
    walk_to(hike, first_m - 2);
    const Gait<float> level = hike.get<Gait>();
    EXPECT_EQ(level.speed_m_s, 1.3F);
    walk_to(hike, last_m - 4);
    const Gait<float> slow = hike.get<Gait>();
    EXPECT_NEAR(slow.speed_m_s, slope_speed(1.3F, rise), 0.03F);
    EXPECT_LT(slow.step_length_m, level.step_length_m);
    EXPECT_NEAR(hike.get<StepPlan>().to.speed_m_s, slow.speed_m_s, 0.01F);
    walk_to(hike, last_m + 6);
    EXPECT_EQ(hike.get<Gait>().speed_m_s, level.speed_m_s);
    EXPECT_EQ(hike.get<Gait>().step_length_m, level.step_length_m);
    EXPECT_EQ(hike.get<StepPlan>().settled, 1U);
  }
}

TEST(SpeedScaling, IsOffByDefault) {
  Hike hike(ramp(0.15F), {.speed_m_s = 1.3F});
  walk_to(hike, last_m - 4);
  EXPECT_EQ(hike.get<Gait>().speed_m_s, 1.3F);
}

TEST(SpeedScaling, RequestsOnASlopeAreForLevelGround) {
  Slowed hike;
  ASSERT_TRUE(hike.simulation.turn_to(hike.person, 0.05F));  // does not set the speed
  walk_to(hike, first_m + 7);
  EXPECT_NEAR(hike.get<Gait>().speed_m_s, slope_speed(1.3F, 0.15F), 0.03F);
  ASSERT_TRUE(hike.simulation.change_gait(hike.person, {.speed_m_s = 1.0F}));
  walk_to(hike, first_m + 10);
  EXPECT_NEAR(hike.get<Gait>().speed_m_s, slope_speed(1.0F, 0.15F), 0.03F);
  walk_to(hike, last_m + 6);
  EXPECT_EQ(hike.get<Gait>().speed_m_s, 1.0F);
}

/// The requested speed can equal the scaled one.
TEST(SpeedScaling, HostCanRequestTheScaledSpeed) {
  Hike hike = hike_on(stairs(0.16F, 0.3F, 20), {.speed_m_s = 1.3F});
  walk_to(hike, 4);
  ASSERT_EQ(hike.get<Gait>().speed_m_s, 0.6F);
  ASSERT_TRUE(hike.simulation.change_gait(hike.person, {.speed_m_s = 0.6F}));
  walk_to(hike, 12);
  EXPECT_EQ(hike.get<Gait>().speed_m_s, 0.6F);
}

TEST(SpeedScaling, StylesRequestedOnASlopeAreForLevelGround) {
  std::size_t drawn = 0;
  for (const float asymmetry : {0.05F, 0.15F, 0.25F}) {
    const GaitChange change{.style = GaitStyle{.time_asymmetry = asymmetry}};
    Hike hike = hike_on(ramp(0.15F), {.speed_m_s = 2.1F}), level = hike_on(plane(0, 0), {.speed_m_s = 2.1F});
    walk_to(hike, first_m + 4);
    ASSERT_LT(hike.get<Gait>().speed_m_s, 1.5F);
    ASSERT_TRUE(hike.simulation.change_gait(hike.person, change));
    ASSERT_TRUE(level.simulation.change_gait(level.person, change));
    const GaitStyle style = level.get<Gait>().style;
    walk_to(hike, last_m - 4);
    EXPECT_LT(hike.get<Gait>().speed_m_s, 1.5F);
    EXPECT_TRUE(same_style(hike.get<Gait>().style, style));
    walk_to(hike, last_m + 6);
    EXPECT_EQ(hike.get<Gait>().speed_m_s, 2.1F);
    EXPECT_TRUE(same_style(hike.get<Gait>().style, style));
    drawn += style.time_asymmetry != asymmetry;
  }
  EXPECT_GT(drawn, 0U) << "some are drawn toward the usual style";
}

/// A style is requested for level ground. A walker whose style is impossible at the lower speed is not slowed.
TEST(SpeedScaling, StyleThatIsImpossibleOnTheSlopeIsKept) {
  Hike hike = hike_on(ramp(0.2F), {.speed_m_s = 1.3F});
  walk_to(hike, first_m + 4);
  ASSERT_LT(hike.get<Gait>().speed_m_s, 0.8F);
  ASSERT_TRUE(hike.simulation.change_gait(hike.person, {.style = GaitStyle{.mid_stance_height = 0.9F}}));
  for (const float z_m : {first_m + 8, last_m + 6}) {
    walk_to(hike, z_m);
    EXPECT_EQ(hike.get<Gait>().style.mid_stance_height, 0.9F);
    EXPECT_EQ(hike.get<Gait>().speed_m_s, 1.3F);
  }
}

TEST(SpeedScaling, RefusalsKeepTheRequestedSpeed) {
  Slowed hike;
  ASSERT_TRUE(hike.simulation.change_gait(hike.person, {.speed_m_s = 1.0F}));
  const WalkChange refused[] = {{hike.person, GaitChange{}, 1e9F}};
  EXPECT_EQ(hike.simulation.change_gait(refused).value(), 1U);
  walk_to(hike, last_m + 6);
  EXPECT_EQ(hike.get<Gait>().speed_m_s, 1.0F);
}

TEST(SpeedScaling, LongStepsShortenAsUsualSteps) {
  const auto usual_m = [](float speed_m_s) { return resolve_gait(1.75F, {.speed_m_s = speed_m_s})->step_length_m; };
  for (const float part : {1.02F, 1.06F}) {
    Hike hike = hike_on(ramp(0.2F), {.speed_m_s = 1.3F, .step_length_m = part * usual_m(1.3F)});
    walk_to(hike, last_m - 4);
    const Gait<float> gait = hike.get<Gait>();
    EXPECT_LT(gait.speed_m_s, 0.7F);
    EXPECT_NEAR(gait.step_length_m / usual_m(gait.speed_m_s), part, 0.005F);
  }
}

TEST(SpeedScaling, StepsMatchingTreadsKeepTheirLength) {
  Hike hike = hike_on(stairs(0.16F, 0.3F, 40), {.speed_m_s = 0.9F, .step_length_m = 0.30F});
  walk_to(hike, 8);
  EXPECT_NEAR(hike.get<Gait>().speed_m_s, 0.6F, 0.03F);
  EXPECT_FLOAT_EQ(hike.get<Gait>().step_length_m, 0.30F);
}

TEST(SpeedScaling, ReleasedWalkersHaveTheirRequestedGait) {
  Hike hike = hike_on(ramp(0.15F), {.speed_m_s = 1.3F});
  const Gait<float> level = hike.get<Gait>();
  walk_to(hike, first_m + 6);
  EXPECT_LT(hike.get<Gait>().speed_m_s, 1.0F);
  ASSERT_TRUE(hike.terrain.release({&hike.person, 1}));
  EXPECT_EQ(hike.get<Gait>().speed_m_s, level.speed_m_s);
  EXPECT_EQ(hike.get<Gait>().step_length_m, level.step_length_m);
}

TEST(SpeedScaling, AvoidingWalkersSlowDown) {
  Avoider one(ramp(0.15F), {.speed_m_s = 1.3F});
  const auto speed_at = [&](float z_m) {
    one.walk_to(z_m);
    return one.hike.get<StepPlan>().to.speed_m_s;
  };
  EXPECT_NEAR(speed_at(first_m - 2), 1.3F, 0.01F);
  EXPECT_NEAR(speed_at(last_m - 4), slope_speed(1.3F, 0.15F), 0.03F);
  EXPECT_NEAR(one.hike.get<AvoidanceState>().speed_m_s, 1.3F, 1e-6F) << "what it wants is what was asked for";
  EXPECT_NEAR(speed_at(last_m + 6), 1.3F, 0.01F);
}

TEST(SpeedScaling, DesiredSpeedIsKeptWhenAvoidanceChangesOnASlope) {
  Slowed hike;
  Avoidance avoidance = hike.simulation.avoidance();
  ASSERT_TRUE(avoidance.manage(hike.person));
  EXPECT_EQ(hike.get<AvoidanceState>().speed_m_s, 1.3F);
  EXPECT_NEAR(hike.get<AvoidanceState>().usual, 1, 1e-3F);
  for (int i = 0; i < 180; ++i) hike.tick();
  EXPECT_NEAR(hike.get<Gait>().speed_m_s, slope_speed(1.3F, 0.15F), 0.03F);
  ASSERT_TRUE(avoidance.release(hike.person));
  walk_to(hike, last_m - 4);
  EXPECT_NEAR(hike.get<Gait>().speed_m_s, slope_speed(1.3F, 0.15F), 0.03F);
  walk_to(hike, last_m + 6);
  EXPECT_NEAR(hike.get<Gait>().speed_m_s, 1.3F, 1e-6F);
}

/// Avoidance chooses a step before the terrain of the next one is known.
TEST(SpeedScaling, DesiredSpeedIsKeptWhereverAvoidanceEnds) {
  for (int ticks = 0; ticks < 90; ticks += 3) {
    Avoider one(ramp(0.15F), {.speed_m_s = 1.3F});
    one.walk_to(last_m - 0.4F);
    for (int k = 0; k < ticks; ++k) one.tick();
    ASSERT_TRUE(one.avoidance.release(one.hike.person));
    walk_to(one.hike, last_m + 8);
    ASSERT_NEAR(one.hike.get<Gait>().speed_m_s, 1.3F, 0.01F) << ticks;
  }
}

/// In any order: terrain or avoidance ends, speed scaling is turned off, or the desired velocity changes.
TEST(SpeedScaling, LeavingASlopeRestoresTheDesiredSpeed) {
  for (int way = 0; way < 4; ++way) {
    Avoider one(ramp(0.15F), {.speed_m_s = 1.3F});
    Hike& hike = one.hike;
    one.walk_to(first_m + 4);
    ASSERT_LT(hike.get<Gait>().speed_m_s, 1.0F);
    float wish_m_s = 1.3F;
    bool done = true;
    if (way == 0) done = hike.terrain.release({&hike.person, 1}).has_value();
    if (way == 1) hike.terrain.set_options({}), hike.tick();
    if (way == 2) done = one.avoidance.set_desired_velocity({{{hike.person, wish_m_s = 1.1F, 0}}}).has_value();
    ASSERT_TRUE(done && one.avoidance.release(hike.person));
    if (way == 3) done = hike.terrain.release({&hike.person, 1}).has_value();
    ASSERT_TRUE(done);
    walk_to(hike, last_m + 6);
    EXPECT_NEAR(hike.get<Gait>().speed_m_s, wish_m_s, 0.01F) << way;
  }
}

/// On level ground, or downhill so gently that no walker slows down, behind a slow obstacle.
TEST(SpeedScaling, WalkersSlowedByOthersKeepTheirSpeed) {
  for (const float rise : {0.0F, -0.05F}) {
    Avoider one(plane(0, rise), {.speed_m_s = 1.3F});
    auto& [hike, avoidance] = one;
    ASSERT_TRUE(avoidance.set_walls({{{{-0.4F, -5}, {-0.4F, 90}}, {{0.4F, -5}, {0.4F, 90}}}}));
    for (int k = 0; k < 600; ++k) {
      const float ahead_m = 1.5F + 0.4F * static_cast<float>(k) / 60;
      ASSERT_TRUE(avoidance.set_discs({{{{0, ahead_m}, 0.25F, 0, 0.4F}}}));
      one.tick();
    }
    const float speed_m_s = hike.get<Gait>().speed_m_s;
    ASSERT_LT(speed_m_s, 1.0F);
    ASSERT_TRUE(avoidance.manage(hike.person));
    EXPECT_EQ(hike.get<AvoidanceState>().speed_m_s, 1.3F) << "who is managed keeps their wish";
    ASSERT_TRUE(avoidance.release(hike.person));
    for (int k = 0; k < 120; ++k) hike.tick();
    EXPECT_EQ(hike.get<Gait>().speed_m_s, speed_m_s) << rise;
  }
}

/// A walker who avoids others on a slope and wants to stand continues at the current speed after release.
TEST(SpeedScaling, ReleasedWalkersKeepWalkingDespiteAStandRequest) {
  Avoider one(ramp(0.15F), {.speed_m_s = 1.3F});
  one.walk_to(first_m + 4);
  Hike& hike = one.hike;
  const float speed_m_s = hike.get<Gait>().speed_m_s;
  ASSERT_LT(speed_m_s, 1.0F);
  ASSERT_TRUE(one.avoidance.set_desired_velocity({{{hike.person, 0, 0}}}) && one.avoidance.release(hike.person));
  walk_to(hike, last_m + 6);
  EXPECT_EQ(hike.get<Gait>().speed_m_s, speed_m_s);
}

TEST(SpeedScaling, EmptyRequestKeepsTheDesiredSpeed) {
  Slowed hike;
  ASSERT_TRUE(hike.simulation.change_gait(hike.person, {}));
  walk_to(hike, last_m - 2);
  EXPECT_LT(hike.get<Gait>().speed_m_s, 1.0F);
  walk_to(hike, last_m + 6);
  EXPECT_NEAR(hike.get<Gait>().speed_m_s, 1.3F, 0.01F);
}

TEST(SpeedScaling, HostCanRepeatItsRequest) {
  Hike hike = hike_on(ramp(0.15F), {.speed_m_s = 1.3F});
  for (int i = 0; i < 6000 && hike.get<GaitState>().line_z_m < last_m - 4; ++i) {
    ASSERT_TRUE(hike.simulation.change_gait(hike.person, {.speed_m_s = 1.3F}));
    hike.tick();
  }
  EXPECT_NEAR(hike.get<StepPlan>().to.speed_m_s, slope_speed(1.3F, 0.15F), 0.03F);
}

TEST(SpeedScaling, SleepersAreReleasedToTheirLevelGait) {
  Hike hike = hike_on(plane(0, 0.15F), {.speed_m_s = 1.3F});
  walk_to(hike, 12);
  ASSERT_LT(hike.get<Gait>().speed_m_s, 1.0F);
  ASSERT_EQ(hike.simulation.set_state({&hike.person, 1}, PersonState::asleep).value(), 1U);
  ASSERT_TRUE(hike.terrain.release({&hike.person, 1}));
  ASSERT_TRUE(hike.simulation.set_state({&hike.person, 1}, PersonState::full));
  EXPECT_FLOAT_EQ(hike.get<Gait>().speed_m_s, 1.3F);
}

/// With level of detail, a person who wakes on a hill is displayed there, not below it.
TEST(SpeedScaling, SleepersKeepTheHeightOfTheirGround) {
  Hike hike = hike_on([](float, float) { return TerrainHeight{50, 0, 0}; }, {.speed_m_s = 1.3F});
  walk_to(hike, 4);
  const auto high = [&](const char* when) {
    EXPECT_NEAR(hike.get<Pose>().position_m[0].y, 50.95F, 0.1F) << when;
    EXPECT_NEAR(hike.get<CentreOfMass>().position_m.y, 51, 0.2F) << when;
    EXPECT_NEAR(hike.get<Feet>().toe_m[Side::left].y, 50.1F, 0.15F) << when;
  };
  high("awake");
  ASSERT_EQ(hike.simulation.set_state({&hike.person, 1}, PersonState::asleep).value(), 1U);
  high("asleep");
  ASSERT_TRUE(hike.simulation.set_state({&hike.person, 1}, PersonState::full));
  high("woken");
  for (int i = 0; i < 60; ++i) {
    hike.tick();
    high("on");
  }
}

TEST(SpeedScaling, EndsWhenTheOptionIsTurnedOff) {
  Slowed hike;
  hike.terrain.set_options({.slows_down = false});
  for (int i = 0; i < 120; ++i) hike.simulation.tick();
  EXPECT_EQ(hike.get<Gait>().speed_m_s, 1.3F);
  EXPECT_EQ(hike.get<Footing>().slows_for, 0);
}

/// A style that would be clamped toward the usual one at the lower speed is kept: such a walker is not slowed.
TEST(SpeedScaling, StylesStay) {
  std::size_t slowed = 0, refused = 0;
  for (int draw = 0; draw < 16; ++draw) {
    GaitStyle style;
    style.time_asymmetry = 0.02F * static_cast<float>(draw % 8);
    style.toe_out_deg = 4.0F * static_cast<float>(draw % 7);
    if (draw % 4 == 0) style.mid_stance_height = 0.9F;  // too low for slow walks
    style.swing_knee_deg = style.swing_knee_deg + 2.0F * static_cast<float>(draw % 5);
    Hike hike = hike_on(ramp(0.2F), {.speed_m_s = 1.3F, .style = style});
    const GaitStyle before = hike.get<Gait>().style;
    walk_to(hike, last_m - 4);
    (hike.get<Gait>().speed_m_s < 1.3F ? slowed : refused) += 1;
    walk_to(hike, last_m + 6);
    EXPECT_TRUE(same_style(hike.get<Gait>().style, before)) << draw;
    EXPECT_EQ(hike.get<Gait>().speed_m_s, 1.3F) << draw;
  }
  EXPECT_GT(slowed, 0U);
  EXPECT_GT(refused, 0U);
}

TEST(SpeedScaling, ContinuesFromASnapshot) {
  Slowed hike;
  std::vector<std::byte> bytes(hike.simulation.snapshot_bytes());
  ASSERT_TRUE(hike.simulation.save(bytes));
  walk_to(hike, last_m + 3);
  const std::uint64_t once = hike.simulation.state_hash();
  ASSERT_TRUE(hike.simulation.restore(bytes));
  walk_to(hike, last_m + 3);
  EXPECT_EQ(hike.simulation.state_hash(), once);
}

}  // namespace
}  // namespace mobil
