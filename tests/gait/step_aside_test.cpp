// Standing people step aside, ahead and back.
#include <gtest/gtest.h>

#include <cmath>

#include <mobil/simulation.h>
#include <mobil/systems/muscles/person.h>
#include "tests/gait/walkers.h"

namespace mobil::step_aside_test {

/// Compares in the frame of a person at the origin who faces +Z.
void expect_moved(const Pose<float>& from, const Pose<float>& to, double left_m, double ahead_m) {
  for (const Segment s : {Segment::pelvis, Segment::head, Segment::foot_right, Segment::foot_left}) {
    EXPECT_NEAR(to.position_m[index(s)].x - from.position_m[index(s)].x, left_m, 1e-4) << segment_name[index(s)];
    EXPECT_NEAR(to.position_m[index(s)].z - from.position_m[index(s)].z, ahead_m, 1e-4) << segment_name[index(s)];
    EXPECT_NEAR(to.position_m[index(s)].y, from.position_m[index(s)].y, 1e-4) << segment_name[index(s)];
  }
}

struct Standing {
  Simulation simulation;
  Entity entity;

  explicit Standing(const BodyRequest& body = {.height_m = 1.75F, .mass_kg = 75}) {
    GaitRequest stand;
    stand.speed_m_s = 0.0F;
    entity = simulation.spawn(body, stand).value();
    go_on(0.1);
  }
  void go_on(double seconds) {
    for (const double end = simulation.time_s() + seconds; simulation.time_s() < end;) simulation.tick();
  }
  Pose<float> pose() const { return *simulation.get<Pose>(entity); }
};

TEST(StepAside, TakesFeetAndBodyThereInTwoSteps) {
  Dice dice{std::mt19937(71)};
  for (int trial = 0; trial < 40; ++trial) {
    Standing one(random_body(dice));
    const Body body = one.simulation.person(one.entity)->body;
    const float scale = (body.thigh_length_m + body.shank_length_m) / 0.85F;
    for (int step = 0; step < 3; ++step) {
      const float left = scale * dice.single(-0.25, 0.25), ahead = scale * dice.single(-0.2, 0.2);
      const Pose<float> before = one.pose();
      const auto steps = one.simulation.get<GaitState>(one.entity)->steps;
      ASSERT_TRUE(one.simulation.step_aside(one.entity, left, ahead));
      one.go_on(2);
      expect_moved(before, one.pose(), double{left}, double{ahead});
      EXPECT_EQ(one.simulation.get<GaitState>(one.entity)->steps, steps + 2);
    }
  }
}

/// The foot on that side moves first, and each foot moves only while it is in the air.
TEST(StepAside, PlantedFeetDoNotSlide) {
  for (const float left_m : {0.24F, -0.24F, 0.1F, 0.0F}) {
    Standing one;
    ASSERT_TRUE(one.simulation.step_aside(one.entity, left_m, left_m == 0.0F ? -0.19F : 0.0F));
    std::size_t first = 2;
    double lifted = 0;
    Feet<float> before = *one.simulation.get<Feet>(one.entity);
    for (int i = 0; i < 120; ++i) {
      one.simulation.tick();
      const Feet<float> now = *one.simulation.get<Feet>(one.entity);
      std::size_t moving = 0;
      for (std::size_t side = 0; side < 2; ++side) {
        const double moved = distance(now.heel_m[side], before.heel_m[side]);
        if (moved > 1e-5) {
          ++moving;
          if (first == 2) first = side;
        }
        lifted = std::fmax(lifted, double{now.heel_m[side].y});
      }
      EXPECT_LE(moving, 1U);
      before = now;
    }
    EXPECT_GT(lifted, 0.02);
    if (left_m != 0) {
      EXPECT_EQ(first, left_m > 0 ? Side::left : Side::right);
    }
  }
}

TEST(StepAside, IsRefusedInOneLine) {
  Standing one;
  const auto said = [&](float left_m, float ahead_m) {
    const auto done = one.simulation.step_aside(one.entity, left_m, ahead_m);
    return done ? std::string() : done.error().message;
  };
  EXPECT_EQ(said(0.2F, 0.1F), "");
  EXPECT_NE(said(0.5F, 0).find("0.5 m to the left is outside"), std::string::npos);
  EXPECT_NE(said(0, -0.4F).find("-0.4 m ahead is outside"), std::string::npos);
  EXPECT_NE(said(std::nanf(""), 0).find("outside"), std::string::npos);
  ASSERT_TRUE(one.simulation.set_gait(one.entity, {}));
  EXPECT_NE(said(0.1F, 0).find("is to walk"), std::string::npos);
  one.simulation.despawn(one.entity);
  EXPECT_NE(said(0.1F, 0).find("stale"), std::string::npos);
}

/// A step requested during the last steps of a walk follows them.
TEST(StepAside, FollowsAWalkOrAnotherStepInProgress) {
  Simulation simulation;
  const Entity entity = simulation.spawn(BodyRequest{}, GaitRequest{}).value();
  const auto go_on = [&](double seconds) {
    for (const double end = simulation.time_s() + seconds; simulation.time_s() < end;) simulation.tick();
  };
  go_on(1.3);
  GaitRequest stand;
  stand.speed_m_s = 0.0F;
  ASSERT_TRUE(simulation.set_gait(entity, stand));
  ASSERT_TRUE(simulation.step_aside(entity, 0.2F, 0));
  go_on(4);
  const Pose<float> moved = *simulation.get<Pose>(entity);
  ASSERT_TRUE(simulation.step_aside(entity, -0.1F, 0));
  go_on(0.5);
  ASSERT_TRUE(simulation.step_aside(entity, -0.1F, 0));
  go_on(3);
  expect_moved(moved, *simulation.get<Pose>(entity), -0.2, 0);
  ASSERT_TRUE(simulation.set_gait(entity, {}));
  go_on(3);
  const auto pelvis = simulation.get<Pose>(entity)->position_m[0];
  EXPECT_GT(pelvis.z, moved.position_m[0].z + 1);
  EXPECT_NEAR(pelvis.x, moved.position_m[0].x - 0.2F, 0.05);
}

/// A walk, a turn or another step, requested at any moment of a step aside.
TEST(StepAside, NothingJumpsAfterAnyRequest) {
  Dice dice{std::mt19937(72)};
  for (int trial = 0; trial < 60; ++trial) {
    Standing one;
    const double what = dice(0, 3);
    ASSERT_TRUE(one.simulation.step_aside(one.entity, dice.single(-0.23, 0.23), dice.single(-0.19, 0.19)));
    one.go_on(dice(0, 1.2));
    if (what < 1) {
      GaitRequest walk;
      walk.speed_m_s = dice.single(0.5, 1.8);
      ASSERT_TRUE(one.simulation.set_gait(one.entity, walk));
    } else if (what < 2) {
      ASSERT_TRUE(one.simulation.turn_to(one.entity, dice.single(-3, 3)));
    } else {
      ASSERT_TRUE(one.simulation.step_aside(one.entity, dice.single(-0.23, 0.23), dice.single(-0.19, 0.19)));
    }
    Pose<float> before = one.pose();
    for (int i = 0; i < 150; ++i) {
      one.simulation.tick();
      const Pose<float> now = one.pose();
      for (std::size_t s = 0; s < segment_count; ++s)
        ASSERT_LT(distance(now.position_m[s], before.position_m[s]), 0.12) << trial << ' ' << segment_name[s];
      ASSERT_LT(distance(now.position_m[0], before.position_m[0]), 0.04) << trial;
      ASSERT_LT(angle_between(now.rotation[0], before.rotation[0]), 0.06) << trial;
      before = now;
    }
  }
}

}  // namespace mobil::step_aside_test
