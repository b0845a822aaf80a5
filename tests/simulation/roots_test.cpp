// Root motion of any person: smooth along the line, at any instant, and consistent with the distance walked.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include <mobil/simulation.h>
#include <mobil/systems/poses/roots.h>
#include "tests/simulation/people.h"

namespace mobil::roots_test {

constexpr double tick_s = 1.0 / 60;

Root root(const Simulation& simulation, Entity person, double ahead_s = 0) {
  Root out;
  EXPECT_TRUE(simulation.roots({&person, 1}, {&out, 1}, ahead_s));
  return out;
}

/// Frames that end with a tick leave rounding errors, which must not count as units of the clock.
TEST(Roots, InstantAfterATickIsTheTick) {
  Simulation simulation;
  const Entity person = *simulation.spawn({});
  for (int frame = 0; frame < 50; ++frame) {
    simulation.advance(1.0 / 24);
    const Root now = root(simulation, person);
    for (const double ahead_s : {1e-18, 9e-16, 1e-9, 1e-7}) {
      const Root then = root(simulation, person, ahead_s);
      ASSERT_NEAR(then.x_m, now.x_m, 1e-5);
      ASSERT_NEAR(then.z_m, now.z_m, 1e-5);
    }
  }
}

TEST(Roots, SteadyWalkersGoStraightAtTheirSpeed) {
  Simulation simulation;
  for (int i = 0; i < 5; ++i) {
    const SamplePerson who = sample_person(i);
    const SpawnRequest request{.body = who.body, .gait = who.gait, .x_m = 2, .z_m = -3, .heading_rad = 0.7F};
    Entity person;
    ASSERT_TRUE(simulation.spawn({&request, 1}, {&person, 1}));
    Root before = root(simulation, person);
    double most = 0, max_aside = 0;
    for (int t = 0; t < 120; ++t) {
      simulation.tick();
      const Root now = root(simulation, person);
      const RootMotion way = root_motion(before, now);
      most = std::max(most,
                      std::abs(static_cast<double>(way.ahead_m) - static_cast<double>(*who.gait.speed_m_s) * tick_s));
      max_aside = std::max(max_aside, static_cast<double>(std::abs(way.left_m)));
      EXPECT_NEAR(static_cast<double>(way.turn_rad), 0, 1e-6);
      before = now;
    }
    std::printf("%.6f m off the speed's way in a tick, %.6f m aside\n", most, max_aside);
    EXPECT_LT(most, 2e-5);
    EXPECT_LT(max_aside, 3e-6);
  }
}

/// Through turns, a stop, steps in place and a start: near the hips, without a jerk, and motions add up.
TEST(Roots, AreSmoothThroughTurnsAndStops) {
  for (int i = 0; i < 4; ++i) {
    Simulation simulation;
    const SamplePerson who = sample_person(i);
    const Entity person = *simulation.spawn(who.body, who.gait);
    const Root first = root(simulation, person);
    Root before = first, put_together = first;
    RootMotion last{0, *who.gait.speed_m_s * static_cast<float>(tick_s), 0};
    double jerk = 0, spin = 0, off_hips = 0, off_facing = 0;
    for (int t = 0; t < 960; ++t) {
      Result<void> done;
      if (t == 90) done = simulation.turn_to(person, 1.4F);
      if (t == 240) done = simulation.change_gait(person, {.speed_m_s = 0.0F});
      if (t == 480) done = simulation.turn_to(person, -0.5F);
      if (t == 660) done = simulation.step_aside(person, -0.15F, 0.1F);
      if (t == 800) done = simulation.change_gait(person, {.speed_m_s = 1.4F});
      ASSERT_TRUE(done);
      simulation.tick();
      const Root now = root(simulation, person);
      const RootMotion way = root_motion(before, now);
      jerk = std::max({jerk, std::abs(static_cast<double>(way.ahead_m - last.ahead_m)),
                       std::abs(static_cast<double>(way.left_m - last.left_m))});
      spin = std::max(spin, std::abs(static_cast<double>(way.turn_rad - last.turn_rad)));
      put_together = moved(put_together, way);
      const auto pose = *simulation.get<Pose>(person);
      const Vec3<float> hips = pose.position_m[index(Segment::pelvis)];
      off_hips =
          std::max(off_hips, std::hypot(static_cast<double>(hips.x) - now.x_m, static_cast<double>(hips.z) - now.z_m));
      const Quat<float> q = pose.rotation[index(Segment::pelvis)];
      const double faces = std::atan2(2 * (q.x * q.z + q.w * q.y), 1 - 2 * (q.x * q.x + q.y * q.y));
      off_facing =
          std::max(off_facing, std::abs(std::remainder(faces - static_cast<double>(now.heading_rad), 2 * M_PI)));
      before = now;
      last = way;
    }
    std::printf("way changes by %.2f mm a tick, turn by %.4f rad; %.0f mm and %.2f rad from the hips\n", 1e3 * jerk,
                spin, 1e3 * off_hips, off_facing);
    EXPECT_LT(jerk, 1.7e-3);  // 6 m/s²
    EXPECT_LT(spin, 0.008);
    EXPECT_LT(off_hips, 0.065);
    EXPECT_LT(off_facing, 0.11);
    EXPECT_NEAR(put_together.x_m, before.x_m, 1e-4);
    EXPECT_NEAR(put_together.z_m, before.z_m, 1e-4);
    EXPECT_NEAR(static_cast<double>(put_together.heading_rad), static_cast<double>(before.heading_rad), 1e-4);
    EXPECT_GT(std::hypot(before.x_m - first.x_m, before.z_m - first.z_m), 2.0);
  }
}

TEST(Roots, BetweenTicksMatchFinerTicks) {
  Simulation coarse, fine({.tick_s = tick_s / 8});
  const Entity a = *coarse.spawn({}, {.speed_m_s = 1.5F}), b = *fine.spawn({}, {.speed_m_s = 1.5F});
  double most = 0;
  for (int t = 0; t < 240; ++t) {
    if (t == 61) {
      ASSERT_TRUE(coarse.turn_to(a, 1));
      ASSERT_TRUE(fine.turn_to(b, 1));
    }
    for (int part = 0; part < 8; ++part) {
      const Root c = root(coarse, a, part * tick_s / 8), f = root(fine, b);
      most = std::max(most, std::hypot(c.x_m - f.x_m, c.z_m - f.z_m));
      fine.tick();
    }
    coarse.tick();
  }
  EXPECT_LT(most, 1e-4);
}

TEST(Roots, CompactPeopleAndSleepersMatchFullOnes) {
  Simulation whole, mixed;
  std::vector<Entity> people;
  for (int i = 0; i < 30; ++i) {
    SamplePerson who = sample_person(i);
    who.gait.style = snapped(who.gait.style);
    people.push_back(*whole.spawn(who.body, who.gait));
    ASSERT_EQ(*mixed.spawn(who.body, who.gait), people.back());
  }
  ASSERT_EQ(*mixed.set_state(std::span(people).first(10), PersonState::compact), 10U);
  ASSERT_EQ(*mixed.set_state(std::span(people).subspan(10, 10), PersonState::asleep), 10U);
  std::vector<Root> a(people.size()), b(people.size());
  for (int t = 0; t < 90; ++t) {
    if (t == 40) {
      for (const Entity person : people) {
        ASSERT_TRUE(whole.turn_to(person, 0.8F));
        ASSERT_TRUE(mixed.turn_to(person, 0.8F));
      }
    }
    whole.tick();
    mixed.tick();
    ASSERT_TRUE(whole.roots(people, a, 0.3 * tick_s));
    ASSERT_TRUE(mixed.roots(people, b, 0.3 * tick_s));
    for (std::size_t i = 0; i < people.size(); ++i) {
      EXPECT_EQ(a[i].x_m, b[i].x_m) << i << " at " << t;
      EXPECT_EQ(a[i].z_m, b[i].z_m) << i << " at " << t;
      EXPECT_EQ(a[i].heading_rad, b[i].heading_rad) << i << " at " << t;
    }
  }
}

TEST(Roots, PosedPeopleHaveTheirPelvis) {
  Simulation simulation;
  const Entity posed = *simulation.spawn_posed({});
  auto pose = *simulation.get<Pose>(posed);
  for (auto& at : pose.position_m) at.x += 5;
  const float half = 0.4F;
  pose.rotation[index(Segment::pelvis)] = {0, std::sin(half), 0, std::cos(half)};
  ASSERT_TRUE(simulation.set_pose(posed, pose));
  const Root at = root(simulation, posed);
  EXPECT_NEAR(at.x_m, static_cast<double>(pose.position_m[index(Segment::pelvis)].x), 1e-9);
  EXPECT_NEAR(static_cast<double>(at.heading_rad), 0.8, 1e-6);
}

TEST(Roots, InvalidRequestsAreRefused) {
  Simulation simulation;
  const Entity person = *simulation.spawn({});
  std::array<Root, 2> out{};
  EXPECT_FALSE(simulation.roots({&person, 1}, out));
  EXPECT_FALSE(simulation.roots({&person, 1}, {out.data(), 1}, 0.21));
  EXPECT_FALSE(simulation.roots({&person, 1}, {out.data(), 1}, std::numeric_limits<double>::quiet_NaN()));
  EXPECT_EQ(simulation.roots(std::array{person, Entity{}}, out), Status::stale_entity);
  EXPECT_EQ(out[0].x_m, 0);
}

}  // namespace mobil::roots_test
