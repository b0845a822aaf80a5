// People who are put elsewhere at once: they go on as if the world had been moved under them.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "engine/geometry.h"
#include "tests/simulation/leg_muscles.h"

namespace mobil::place_test {
using geometry::operator-, geometry::operator+;

LegMuscles with_inertia(Method method) {
  return {
      .muscles = MuscleSet(3), .method = method, .reduced = {.cells = {2, 2, 8}}, .inertia = true, .line_motion = true};
}

/// Of a walker who was put elsewhere, and of one who was not: the way between them.
struct Way {
  Vec3<float> from, to;
  Quat<float> turn;

  Way(const GaitState<float>& here, float x_m, float z_m, float heading_rad)
      : from{here.line_x_m, 0, here.line_z_m}, to{x_m, 0, z_m} {
    const float half = 0.5F * (heading_rad - here.heading_rad);
    turn = {0, std::sin(half), 0, std::cos(half)};
  }
  Vec3<float> operator()(const Vec3<float>& at) const { return to + geometry::rotated(turn, at - from); }
};

void expect_along(const Way& way, const Simulation& here, Entity stays, const Simulation& there, Entity placed,
                  double within_m) {
  const auto a = *here.get<Pose>(stays), b = *there.get<Pose>(placed);
  for (std::size_t s = 0; s < segment_count; ++s) {
    EXPECT_LT(geometry::length(way(a.position_m[s]) - b.position_m[s]), within_m) << segment_name[s];
    const Quat<float> q = geometry::product(way.turn, a.rotation[s]), r = b.rotation[s];
    EXPECT_NEAR(std::abs(q.x * r.x + q.y * r.y + q.z * r.z + q.w * r.w), 1, 1e-5) << segment_name[s];
  }
  EXPECT_LT(
      geometry::length(way(here.get<Feet>(stays)->toe_m[Side::left]) - there.get<Feet>(placed)->toe_m[Side::left]),
      within_m);
}

TEST(Place, PoseAndMusclesGoAlongAndWalkOn) {
  std::mt19937 random(9);
  auto draw = [&](float low, float high) { return low + (high - low) * static_cast<float>(random() % 1000) / 1000; };
  for (const Method method : {Method::ecd, Method::reduced}) {
    Simulation here, there;
    const Person person = mobil::person(3);
    const Entity stays = join_with(here, person, with_inertia(method)),
                 placed = join_with(there, person, with_inertia(method));
    for (Simulation* simulation : {&here, &there}) {
      ASSERT_TRUE(simulation->change_gait(simulation->people()[0], {.speed_m_s = 1.5F}));
      ASSERT_TRUE(simulation->turn_to(simulation->people()[0], 1));
    }
    Way way(*here.get<GaitState>(stays), 0, 0, 0);
    for (int t = 0; t < 240; ++t) {
      if (t % 37 == 20) {
        const float x = draw(-20, 20), z = draw(-20, 20), heading = draw(-3, 3);
        ASSERT_TRUE(there.place(placed, x, z, heading));
        way = Way(*here.get<GaitState>(stays), x, z, heading);
        expect_along(way, here, stays, there, placed, 1e-4);
      }
      here.tick();
      there.tick();
    }
    // The line of the one who stayed has gone on since, and so has the other's.
    expect_along(way, here, stays, there, placed, 2e-3);
    Difference difference;
    compare(here, stays, there, placed, difference);
    EXPECT_GT(difference.most, 1e-3);
    EXPECT_LT(difference.apart, 0.05 * difference.most);
  }
}

/// A pose far away, without inertia; the same as a jump, and as a way of ten metres in a tick.
TEST(Place, APosedPersonFeelsAWayAndNoJump) {
  for (const auto arrival : {Arrival::jumped, Arrival::moved}) {
    Simulation simulation;
    const Entity human = simulation.spawn_posed(person(2).body).value();
    ASSERT_TRUE(simulation.add_leg_muscles(human, with_inertia(Method::reduced)));
    auto pose = *simulation.get<Pose>(human);
    const auto most = [&] {
      double all = 0;
      for (const Entity muscle : muscles_of(simulation, human))
        for (const float u : displacement(simulation, muscle)) all = std::max(all, static_cast<double>(std::abs(u)));
      return all;
    };
    for (int t = 0; t < 60; ++t) simulation.tick();
    const double before = most();
    for (auto& at : pose.position_m) at.x += 10;
    ASSERT_EQ(simulation.set_pose(human, pose, arrival), Status::ok);
    double after = 0;
    for (int t = 0; t < 30; ++t) {
      simulation.tick();
      after = std::max(after, most());
    }
    if (arrival == Arrival::jumped) {
      EXPECT_LT(after, 1.5 * before + 1e-3);
    } else {
      EXPECT_GT(after, 0.1);
    }
  }
}

TEST(Place, WhatIsNoPlaceIsRefused) {
  Simulation simulation;
  const Entity walker = join(simulation, person(1), false), posed = simulation.spawn_posed(person(2).body).value();
  simulation.tick();
  const std::uint64_t before = simulation.state_hash();
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  auto complaint = [&](Entity human, float x, float z, float heading) {
    const auto done = simulation.place(human, x, z, heading);
    return done ? std::string() : done.error().message;
  };
  EXPECT_NE(complaint(walker, nan, 0, 0).find("not within"), std::string::npos);
  EXPECT_NE(complaint(walker, 0, 2e6F, 0).find("not within"), std::string::npos);
  EXPECT_NE(complaint(walker, 0, 0, nan).find("heading"), std::string::npos);
  EXPECT_NE(complaint(posed, 0, 0, 0).find("animates"), std::string::npos);
  EXPECT_NE(complaint({}, 0, 0, 0).find("stale"), std::string::npos);
  EXPECT_EQ(simulation.state_hash(), before);
}

/// The world's origin moves: nobody notices.
TEST(ShiftOrigin, EverybodyGoesOnAsTheyWere) {
  Simulation here, there;
  std::vector<Entity> walkers;
  for (int i = 0; i < 3; ++i) {
    const Person person = mobil::person(i);
    walkers.push_back(join_with(here, person, with_inertia(i == 0 ? Method::ecd : Method::reduced)));
    join_with(there, person, with_inertia(i == 0 ? Method::ecd : Method::reduced));
  }
  const Entity posed = *here.spawn_posed(person(4).body);
  ASSERT_EQ(posed, *there.spawn_posed(person(4).body));
  Vec3<float> off{0, 0, 0};
  for (int t = 0; t < 150; ++t) {
    if (t % 40 == 20) {
      const Vec3<float> by{static_cast<float>(64 * (t % 3) - 64), 0, static_cast<float>(128 - t)};
      ASSERT_TRUE(there.shift_origin(by.x, by.z));
      off = off + by;
      const auto a = *here.get<Pose>(posed), b = *there.get<Pose>(posed);
      EXPECT_LT(geometry::length(a.position_m[3] - off - b.position_m[3]), 1e-4);
    }
    for (const Entity walker : walkers) {
      const auto a = *here.get<Pose>(walker), b = *there.get<Pose>(walker);
      for (std::size_t s = 0; s < segment_count; ++s)
        EXPECT_LT(geometry::length(a.position_m[s] - off - b.position_m[s]), 2e-4) << segment_name[s] << " at " << t;
      const auto c = here.get<CentreOfMass>(walker)->position_m, d = there.get<CentreOfMass>(walker)->position_m;
      EXPECT_LT(geometry::length(c - off - d), 2e-4);
      const auto foot = here.get<Feet>(walker)->heel_m[Side::right],
                 other = there.get<Feet>(walker)->heel_m[Side::right];
      EXPECT_LT(geometry::length(foot - off - other), 2e-4);
    }
    here.tick();
    there.tick();
  }
  for (const Entity walker : walkers) {
    Difference difference;
    compare(here, walker, there, walker, difference);
    EXPECT_GT(difference.most, 1e-3);
    EXPECT_LT(difference.apart, 0.05 * difference.most);
  }
  const std::uint64_t before = there.state_hash();
  EXPECT_FALSE(there.shift_origin(std::numeric_limits<float>::quiet_NaN(), 0));
  EXPECT_FALSE(there.shift_origin(0, 2e6F));
  EXPECT_EQ(there.state_hash(), before);
}

/// Ten kilometres out bones are as long as floats allow; with the origin near them as long as they are.
TEST(ShiftOrigin, BringsBackTheDigits) {
  Simulation simulation;
  const Entity walker = join(simulation, person(1), false);
  ASSERT_TRUE(simulation.place(walker, 10240 + 1, 20480 + 2, 0.3F));
  const float thigh_m = simulation.human(walker)->body.thigh_length_m;
  const auto worst_m = [&] {
    double worst = 0;
    for (int t = 0; t < 60; ++t) {
      simulation.tick();
      const auto pose = *simulation.get<Pose>(walker);
      const Vec3<float> thigh =
          pose.position_m[index(Segment::shank_right)] - pose.position_m[index(Segment::thigh_right)];
      worst = std::max(worst, std::abs(static_cast<double>(geometry::length(thigh) - thigh_m)));
    }
    return worst;
  };
  EXPECT_GT(worst_m(), 3e-4);
  ASSERT_TRUE(simulation.shift_origin(10240, 20480));
  EXPECT_LT(worst_m(), 3e-6);
}

}  // namespace mobil::place_test
