// Placement: people continue as if the world had been moved under them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <vector>

#include <mobil/components/sleep.h>
#include <mobil/engine/geometry.h>
#include <mobil/forces.h>
#include "tests/simulation/leg_muscles.h"

namespace mobil::place_test {
using geometry::operator-, geometry::operator+;

LegMuscles with_inertia(Method method) {
  return {
      .muscles = MuscleSet(3), .method = method, .modal = {.cells = {2, 2, 8}}, .inertia = true, .line_motion = true};
}

/// The transform between a walker who was placed elsewhere and one who was not.
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

TEST(Place, PoseAndMusclesMoveAlongAndWalkOn) {
  std::mt19937 random(9);
  auto draw = [&](float low, float high) { return low + (high - low) * static_cast<float>(random() % 1000) / 1000; };
  for (const Method method : {Method::explicit_central, Method::modal}) {
    Simulation here(sharing()), there(sharing());
    const SamplePerson person = mobil::sample_person(3);
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
    // Both lines have continued since.
    expect_along(way, here, stays, there, placed, 2e-3);
    Difference difference;
    compare(here, stays, there, placed, difference);
    EXPECT_GT(difference.most, 1e-3);
    EXPECT_LT(difference.apart, 0.05 * difference.most);
  }
}

/// A distant pose, without inertia; then as a jump, and as a motion of ten metres in a tick.
TEST(Place, PosedPersonFeelsMotionButNoJump) {
  for (const auto arrival : {Arrival::jumped, Arrival::moved}) {
    Simulation simulation(sharing());
    const Entity person = simulation.spawn_posed(sample_person(2).body).value();
    ASSERT_TRUE(simulation.set_muscles(person, with_inertia(Method::modal)));
    auto pose = *simulation.get<Pose>(person);
    const auto most = [&] {
      double all = 0;
      for (const Entity muscle : muscles_of(simulation, person))
        for (const float u : displacement(simulation, muscle)) all = std::max(all, static_cast<double>(std::abs(u)));
      return all;
    };
    for (int t = 0; t < 60; ++t) simulation.tick();
    const double before = most();
    for (auto& at : pose.position_m) at.x += 10;
    ASSERT_EQ(simulation.set_pose(person, pose, arrival), Status::ok);
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

TEST(Place, InvalidPlacesAreRefused) {
  Simulation simulation(sharing());
  const Entity walker = join(simulation, sample_person(1), false),
               posed = simulation.spawn_posed(sample_person(2).body).value();
  simulation.tick();
  const std::uint64_t before = simulation.state_hash();
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  auto complaint = [&](Entity person, float x, float z, float heading) {
    const auto done = simulation.place(person, x, z, heading);
    return done ? std::string() : done.error().message;
  };
  EXPECT_NE(complaint(walker, nan, 0, 0).find("not within"), std::string::npos);
  EXPECT_NE(complaint(walker, 0, 2e6F, 0).find("not within"), std::string::npos);
  EXPECT_NE(complaint(walker, 0, 0, nan).find("heading"), std::string::npos);
  EXPECT_NE(complaint(posed, 0, 0, 0).find("animates"), std::string::npos);
  EXPECT_NE(complaint({}, 0, 0, 0).find("stale"), std::string::npos);
  EXPECT_EQ(simulation.state_hash(), before);
}

/// A placed person equals one spawned there, to the bit and permanently: full, compact and asleep.
TEST(Place, EqualsASpawnThere) {
  Simulation there(sharing()), placed(sharing());
  std::vector<SpawnRequest> requests(12), at_origin(12);
  std::vector<PlaceRequest> to(12);
  std::vector<Entity> spawned(12), people(12);
  for (std::size_t i = 0; i < 12; ++i) {
    SamplePerson who = sample_person(static_cast<int>(i));
    who.gait.style = snapped(who.gait.style);
    if (i % 4 == 3) who.gait = {.speed_m_s = 0.0F};
    const auto n = static_cast<float>(i);
    requests[i] = {.body = who.body, .gait = who.gait, .x_m = 3 * n, .z_m = 40 - n, .heading_rad = 0.5F * n - 3};
    at_origin[i] = {.body = who.body, .gait = who.gait};
  }
  ASSERT_TRUE(there.spawn(requests, spawned));
  ASSERT_TRUE(placed.spawn(at_origin, people));
  ASSERT_EQ(*placed.set_state(std::span(people).first(4), PersonState::compact), 4U);
  ASSERT_EQ(*placed.set_state(std::span(people).subspan(4, 4), PersonState::asleep), 4U);
  for (std::size_t i = 0; i < 12; ++i) to[i] = {people[i], requests[i].x_m, requests[i].z_m, requests[i].heading_rad};
  ASSERT_TRUE(placed.place(to));
  EXPECT_EQ(placed.state(people[0]), PersonState::compact);
  EXPECT_EQ(placed.state(people[4]), PersonState::asleep);
  for (int t = 0; t < 90; ++t) {
    for (std::size_t i = 0; i < 12; ++i) EXPECT_TRUE(walk_alike(there, spawned[i], placed, people[i])) << i;
    if (::testing::Test::HasFailure()) break;
    there.tick();
    placed.tick();
  }
  ASSERT_TRUE(placed.set_state(people, PersonState::full));
  ASSERT_TRUE(placed.set_state(people, PersonState::full));
  EXPECT_EQ(there.state_hash(), placed.state_hash());
}

/// Asleep and awake, in mid-walk: to the bit for steady walkers, else within the precision of positions.
TEST(Place, SleepersMoveAlong) {
  Simulation awake(sharing()), asleep(sharing());
  std::vector<Entity> people;
  for (int i = 0; i < 8; ++i) {
    SamplePerson who = sample_person(i);
    who.gait.style = snapped(who.gait.style);
    people.push_back(*awake.spawn(who.body, who.gait));
    ASSERT_EQ(*asleep.spawn(who.body, who.gait), people.back());
  }
  for (int t = 0; t < 100; ++t) awake.tick(), asleep.tick();
  ASSERT_EQ(*asleep.set_state(people, PersonState::asleep), 8U);
  const auto put = [&](float x_m) {
    std::vector<PlaceRequest> to;
    for (const Entity person : people)
      to.push_back({person, x_m + static_cast<float>(person.index), -x_m, 0.01F * x_m});
    ASSERT_TRUE(awake.place(to));
    ASSERT_TRUE(asleep.place(to));
  };
  put(25);
  for (int t = 0; t < 50; ++t) awake.tick(), asleep.tick();
  for (const Entity person : people) EXPECT_TRUE(walk_alike(awake, person, asleep, person));
  // Some turn and some stop, and are placed at once, on the way and after.
  for (const Entity person : people) {
    for (Simulation* const simulation : {&awake, &asleep}) {
      if (person.index % 2 == 0) {
        ASSERT_TRUE(simulation->turn_to(person, 1.5F));
      } else {
        ASSERT_TRUE(simulation->change_gait(person, {.speed_m_s = 0.0F}));
      }
    }
  }
  for (Simulation* const simulation : {&awake, &asleep}) ASSERT_TRUE(simulation->shift_origin(128, -64));
  for (const float x_m : {60.0F, 80.0F, -30.0F}) {
    put(x_m);
    for (int t = 0; t < 40; ++t) awake.tick(), asleep.tick();
    for (const Entity person : people) {
      EXPECT_EQ(asleep.state(person), PersonState::asleep);
      const auto a = *awake.get<GaitState>(person), b = *asleep.get<GaitState>(person);
      EXPECT_EQ(a.time_s, b.time_s);
      EXPECT_EQ(a.steps, b.steps);
      EXPECT_NEAR(a.line_x_m, b.line_x_m, 1e-4);
      EXPECT_NEAR(a.line_z_m, b.line_z_m, 1e-4);
      EXPECT_NEAR(a.heading_rad, b.heading_rad, 1e-5);
    }
  }
  ASSERT_TRUE(asleep.set_state(people, PersonState::full));
  for (const Entity person : people) {
    const auto a = *awake.get<Pose>(person), b = *asleep.get<Pose>(person);
    for (std::size_t s = 0; s < segment_count; ++s)
      EXPECT_LT(geometry::length(a.position_m[s] - b.position_m[s]), 2e-4) << segment_name[s];
  }
}

TEST(Place, BatchIsAllOrNone) {
  Simulation simulation(sharing());
  std::vector<PlaceRequest> to;
  for (int i = 0; i < 6; ++i) {
    const auto n = static_cast<float>(i);
    to.push_back({join(simulation, sample_person(i), false), n, 2 * n, n});
  }
  ASSERT_EQ(*simulation.set_state({&to[2].person, 1}, PersonState::asleep), 1U);
  const Entity posed = *simulation.spawn_posed(sample_person(2).body), last = join(simulation, sample_person(9), false);
  for (int t = 0; t < 20; ++t) simulation.tick();
  const std::uint64_t before = simulation.state_hash();
  const auto refused = [&](const PlaceRequest& one) {
    auto all = to;
    all.push_back(one);
    const auto done = simulation.place(all);
    EXPECT_EQ(simulation.state_hash(), before);
    return done ? std::string() : done.error().message;
  };
  EXPECT_NE(refused({posed, 0, 0, 0}).find("person 6"), std::string::npos);
  EXPECT_NE(refused({to[1].person, 0, 0, 0}), "");
  EXPECT_NE(refused({{}, 0, 0, 0}), "");
  to[3].x_m = std::numeric_limits<float>::infinity();
  EXPECT_NE(refused({last, 0, 0, 0}).find("person 3"), std::string::npos);
}

/// Shifting the world's origin changes no motion.
TEST(ShiftOrigin, MotionIsUnchanged) {
  Simulation here(sharing()), there(sharing());
  std::vector<Entity> walkers;
  for (int i = 0; i < 3; ++i) {
    const SamplePerson person = mobil::sample_person(i);
    walkers.push_back(join_with(here, person, with_inertia(i == 0 ? Method::explicit_central : Method::modal)));
    join_with(there, person, with_inertia(i == 0 ? Method::explicit_central : Method::modal));
  }
  const Entity posed = *here.spawn_posed(sample_person(4).body);
  ASSERT_EQ(posed, *there.spawn_posed(sample_person(4).body));
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

/// A hundred kilometres with an origin that moves along: feet stand still and bones keep their length.
TEST(ShiftOrigin, PrecisionIsKeptAfterAHundredKilometres) {
  Simulation home(sharing()), far(sharing());
  const SamplePerson who = sample_person(1);
  const Entity stays = join_with(home, who, with_inertia(Method::modal)),
               goes = join_with(far, who, with_inertia(Method::modal));
  const Entity posed = *far.spawn_posed(sample_person(4).body);
  ASSERT_TRUE(far.enable(posed, Feature::forces));
  SamplePerson other = sample_person(2);
  other.gait.style = snapped(other.gait.style);
  const Entity sleeper = *far.spawn(other.body, other.gait), small = *far.spawn(other.body, other.gait),
               twin = *home.spawn(other.body, other.gait);
  ASSERT_EQ(*far.set_state({&sleeper, 1}, PersonState::asleep), 1U);
  ASSERT_EQ(*far.set_state({&small, 1}, PersonState::compact), 1U);
  double gone_m = 0, worst_m = 0, slipped_m = 0, behind_m = 0;
  Vec3<float> stood{};  // relative to the same heel at home
  std::uint32_t stance = 0;
  for (int leg = 0; leg < 100; ++leg) {
    // All people are moved by a kilometre, and the origin with them.
    std::vector<PlaceRequest> to;
    for (const Entity one : {goes, sleeper, small}) {
      const auto at = *far.get<GaitState>(one);
      to.push_back({one, at.line_x_m + 1024, at.line_z_m, at.heading_rad});
    }
    ASSERT_TRUE(far.place(to));
    auto pose = *far.get<Pose>(posed);
    for (auto& at : pose.position_m) at.x += 1024;
    ASSERT_TRUE(far.set_pose(posed, pose, Arrival::jumped));
    ASSERT_TRUE(far.shift_origin(1024, 0));
    gone_m += 1024;
    for (int t = 0; t < 12; ++t) {
      const auto side = far.get<GaitState>(goes)->stance_side;
      const auto heel = far.get<Feet>(goes)->heel_m[side] - home.get<Feet>(stays)->heel_m[side];
      // Before the first tick feet are those computed a kilometre from the origin.
      if (t > 1 && side == stance) slipped_m = std::max(slipped_m, static_cast<double>(geometry::length(heel - stood)));
      stood = heel;
      stance = side;
      home.tick();
      far.tick();
    }
    for (const auto& [a, b] : {std::pair{stays, goes}, {twin, sleeper}, {twin, small}}) {
      const auto p = *home.get<Pose>(a), q = *far.get<Pose>(b);
      for (std::size_t s = 0; s < segment_count; ++s)
        worst_m = std::max(worst_m, static_cast<double>(geometry::length(p.position_m[s] - q.position_m[s])));
    }
    behind_m = std::max(behind_m, std::abs(static_cast<double>(far.get<Pose>(posed)->position_m[0].x)));
  }
  std::printf("%.0f km on: poses within %.4f mm, a planted heel slips %.4f mm\n", 1e-3 * gone_m, 1e3 * worst_m,
              1e3 * slipped_m);
  EXPECT_GE(gone_m, 1e5);
  EXPECT_LT(worst_m, 1e-4);
  EXPECT_LT(slipped_m, 1e-5);
  EXPECT_LT(behind_m, 1.0);
  const auto ground = far.get<GroundReaction>(posed);
  ASSERT_TRUE(ground);
  EXPECT_NEAR(ground->force_n[0].y + ground->force_n[1].y, 9.81F * sample_person(4).body.mass_kg, 5);
  Difference difference;
  compare(home, stays, far, goes, difference);
  EXPECT_GT(difference.most, 1e-3);
  EXPECT_LT(difference.apart, 0.1 * difference.most);
}

}  // namespace mobil::place_test
