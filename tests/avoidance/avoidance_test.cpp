// Collision avoidance: properties of reservations, and behaviour of crowds.

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/components/avoidance.h>
#include <mobil/components/step_plan.h>
#include <mobil/rows.h>
#include <mobil/simulation.h>
#include <mobil/systems/poses/roots.h>
#include "engine/row_hash.h"
#include "systems/avoidance/reservations.h"
#include "systems/avoidance/trials.h"
#include "systems/gait/step_limits.h"
#include "tests/avoidance/room.h"
#include "tests/avoidance/walkers.h"
#include "tests/engine/counting_heap.h"
#include "tests/labels.h"
#include "tests/simulation/reseal.h"
#include "tests/world_of.h"

MOBIL_TEST_LABELS("threads");

namespace mobil {
namespace {

constexpr float tick_s = 1.0F / 60;

void tick_to_strike(Simulation& simulation, Entity one) {
  const std::uint32_t steps = simulation.get<GaitState>(one)->steps;
  while (simulation.get<GaitState>(one)->steps == steps) simulation.tick();
}

const Reservation& reservation_of(ReservationBook& book, Simulation& simulation) {
  book.refresh(world_of(simulation), {}, simulation.ticks(), tick_s, 0.128F);
  return book.reservation(0);
}

/// Returns the reservation of a person who is managed by avoidance only for this call.
Reservation reservation_while_avoiding(Avoiders& all, ReservationBook& book, Entity one) {
  EXPECT_TRUE(all.avoidance.manage(one));
  const Reservation reservation = reservation_of(book, all.simulation);
  EXPECT_TRUE(all.avoidance.release(one));
  return reservation;
}

/// Returns the largest distance of the person's roots from a path's samples, m.
double astray_m(Simulation& simulation, Entity one, std::uint32_t first, const float* x_m, const float* z_m) {
  double most = 0;
  for (int k = 0; k < 150; ++k) {
    simulation.tick();
    const std::uint32_t every = 6, instant = simulation.ticks() / every;
    if (simulation.ticks() % every != 0 || instant < first || instant >= first + way_samples) continue;
    const Root at = root_of(simulation, one);
    most = std::max(most, std::hypot(at.x_m - double{x_m[instant - first]}, at.z_m - double{z_m[instant - first]}));
  }
  return most;
}

/// A reservation is the path of a walker who continues straight to the next strike and then stops.
RC_GTEST_PROP(Reservation, IsThePathOfAStoppingWalker, ()) {
  const float speed = static_cast<float>(*rc::gen::inRange(30, 220)) * 0.01F;
  const float turn = static_cast<float>(*rc::gen::inRange(-180, 180)) * pi / 180;
  Avoiders all;
  Simulation& simulation = all.simulation;
  const Entity one = walker(simulation, speed, 3.0F, -2.0F, 0.4F);
  simulation.tick(60);
  RC_ASSERT(simulation.turn_to(one, turn).has_value());
  simulation.tick(static_cast<std::uint32_t>(*rc::gen::inRange(0, 200)));
  tick_to_strike(simulation, one);
  ReservationBook book;
  const Reservation reservation = reservation_while_avoiding(all, book, one);
  const auto state = *simulation.get<GaitState>(one);
  RC_ASSERT(simulation.change_gait(one, {.speed_m_s = 0.0F}).has_value());
  RC_ASSERT(simulation.turn_to(one, state.heading_rad + state.turn_rad).has_value());
  // A walker who needs several steps to stop gets headings in between, which are not predicted exactly.
  const auto leg_m = static_cast<float>(fraction::thigh + fraction::shank) * simulation.get<BodySize>(one)->leg_scale_m;
  const bool in_one_step = speed <= step_limits::last_speed * std::sqrt(leg_m / step_limits::leg_m);
  const double most = in_one_step ? 0.002 : 0.12;
  RC_ASSERT(astray_m(simulation, one, reservation.first, reservation.x_m.data(), reservation.z_m.data()) < most);
}

/// A restored world makes its reservations again between strikes, so it must get the same ones.
RC_GTEST_PROP(Reservation, IndependentOfTheTickItIsMadeIn, ()) {
  Avoiders all;
  Simulation& simulation = all.simulation;
  const Entity one = all.come(static_cast<float>(*rc::gen::inRange(40, 130)) * 0.01F, 3.0F, -2.0F, 0.4F);
  simulation.tick(static_cast<std::uint32_t>(*rc::gen::inRange(30, 150)));
  tick_to_strike(simulation, one);
  ReservationBook at_strike, later;
  const Reservation first = reservation_of(at_strike, simulation);
  simulation.tick(static_cast<std::uint32_t>(*rc::gen::inRange(1, 24)));
  const Reservation& second = reservation_of(later, simulation);
  const std::size_t since = second.first - first.first;
  for (std::size_t s = 0; s + since < way_samples; ++s) {
    RC_ASSERT(second.x_m[s] == first.x_m[s + since]);
    RC_ASSERT(second.z_m[s] == first.z_m[s + since]);
  }
}

/// Every candidate step leads where it was predicted: the reservation made after it has the same positions.
RC_GTEST_PROP(Trial, LeadsToThePredictedPath, ()) {
  const bool stands = *rc::gen::inRange(0, 3) == 0;
  const float speed = stands ? 0.0F : static_cast<float>(*rc::gen::inRange(40, 150)) * 0.01F;
  Avoiders all;
  Simulation& simulation = all.simulation;
  const Entity one = walker(simulation, stands ? 1.2F : speed, 1.0F, 2.0F, -0.7F);
  simulation.tick(90);
  RC_ASSERT(simulation.turn_to(one, static_cast<float>(*rc::gen::inRange(-150, 150)) * pi / 180).has_value());
  if (stands) RC_ASSERT(simulation.change_gait(one, {.speed_m_s = 0.0F}).has_value());
  simulation.tick(static_cast<std::uint32_t>(*rc::gen::inRange(stands ? 500 : 0, stands ? 560 : 160)));
  ReservationBook book;
  while (reservation_while_avoiding(all, book, one), book.strikers().empty()) simulation.tick();
  HeelStrikePlace<Lanes<float>> footing;
  next_footing(broadcast(*simulation.get<BodySize>(one)), broadcast(*simulation.get<StepPlan>(one)),
               broadcast(*simulation.get<GaitState>(one)), footing);
  RC_PRE(row_of(footing, 0).speed_m_s > 0 || row_of(footing, 0).length_before_m == 0);
  RC_ASSERT(all.avoidance.manage(one).has_value());
  AvoidanceState<float> course = *simulation.get<AvoidanceState>(one);
  RC_ASSERT(all.avoidance.release(one).has_value());
  course.heading_rad += 0.3F;
  course.speed_m_s = 1.3F;
  const Trials trials = make_trials(row_of(footing, 0), course);
  WaySamples<Lanes<float>> ways;
  StepEnd<Lanes<float>> end;
  tried_ways(footing, trials.trial, book.instants(), ways, end);
  const auto l = static_cast<std::size_t>(*rc::gen::inRange(1, 16));
  const bool go = trials.kind[l] == TrialKind::go;
  GaitChange change{.speed_m_s = go ? trials.trial.speed_m_s[l] : 0.0F};
  if (go) change.step_length_m = end.step_length_m[l];
  const auto changed = simulation.change_gait(one, change);
  RC_ASSERT((changed ? std::string() : changed.error().message) == "");
  RC_ASSERT(simulation.turn_to(one, footing.heading_rad[0] + trials.trial.turn_rad[l]).has_value());
  if (trials.kind[l] == TrialKind::aside) {
    RC_ASSERT(simulation
                  .step_aside(one, trials.trial.aside_m[l] * std::sin(trials.trial.slant_rad[l]),
                              trials.trial.aside_m[l] * std::cos(trials.trial.slant_rad[l]))
                  .has_value());
  }
  const std::uint32_t first = book.instant();
  simulation.tick();
  const Reservation reservation = reservation_while_avoiding(all, book, one);
  RC_ASSERT(reservation.first >= first && reservation.first <= first + 1);
  for (std::size_t s = reservation.first - first; s < way_samples; ++s) {
    const double off = std::hypot(double{ways.x_m[s][l]} - double{reservation.x_m[s + first - reservation.first]},
                                  double{ways.z_m[s][l]} - double{reservation.z_m[s + first - reservation.first]});
    // Hip positions at the strike are predicted within 3 cm; the end of the step is predicted within 6 mm.
    RC_ASSERT(off < (s + 1 == way_samples ? 0.006 : 0.03));
  }
}

TEST(Avoidance, OncomingWalkersPassWithoutStopping) {
  Avoiders all;
  const Entity a = all.come(1.3F, 0.0F, -8.0F), b = all.come(1.3F, 0.0F, 8.0F, pi);
  const DesiredVelocity wishes[] = {{a, 1.3F, 0}, {b, 1.3F, pi}};
  ASSERT_TRUE(all.avoidance.set_desired_velocity(wishes));
  double least = 10;
  for (int k = 0; k < 900; ++k) {
    all.run();
    least = std::min(least, all.apart_m(a, b));
    EXPECT_GT(all.simulation.get<StepPlan>(a)->to.speed_m_s, 0.25F);
  }
  EXPECT_GT(least, 0.42);
  EXPECT_LT(least, 2);
  EXPECT_GT(all.root(a).z_m, 8);
  EXPECT_LT(all.root(b).z_m, -8);
}

TEST(Avoidance, NoCollisionsInAFullRoom) {
  Room room(1);
  double walked = 0;
  for (int k = 0; k < 60 * 60; ++k) {
    const auto before = room.roots;
    room.tick();
    ASSERT_TRUE(room.simulation.roots(room.who, room.roots));
    for (std::size_t i = 0; i < room.people; ++i) {
      const auto radius = [&](std::size_t p) {
        return double{room.simulation.get<AvoidanceState>(room.who[p])->radius_m};
      };
      if (k > 0) walked += std::hypot(room.roots[i].x_m - before[i].x_m, room.roots[i].z_m - before[i].z_m);
      const double wall = room.side_m / 2 - std::max(std::abs(room.roots[i].x_m), std::abs(room.roots[i].z_m));
      if (k % 5 != 0) continue;
      ASSERT_GT(wall, radius(i) - 0.05);
      for (std::size_t j = 0; j < i; ++j) {
        const double apart = std::hypot(room.roots[i].x_m - room.roots[j].x_m, room.roots[i].z_m - room.roots[j].z_m);
        ASSERT_GT(apart, radius(i) + radius(j) - 0.065) << i << " and " << j << " after " << k << " ticks";
      }
    }
  }
  EXPECT_GT(walked / static_cast<double>(room.people), 6) << "they do get about";
}

TEST(Avoidance, SameBitsOnAnyThreadsAndFromASnapshot) {
  Room one(1), three(3);
  std::vector<std::byte> saved;
  for (int k = 0; k < 900; ++k) {
    one.tick();
    three.tick();
    if (k != 400) continue;
    ASSERT_EQ(one.simulation.state_hash(), three.simulation.state_hash());
    saved.resize(one.simulation.snapshot_bytes());
    ASSERT_TRUE(one.simulation.save(saved));
  }
  EXPECT_EQ(one.simulation.state_hash(), three.simulation.state_hash());
  ASSERT_TRUE(three.simulation.restore(saved));
  for (int k = 401; k < 900; ++k) three.tick();
  EXPECT_EQ(one.simulation.state_hash(), three.simulation.state_hash());
}

TEST(Avoidance, SteadyCrowdAllocatesNothing) {
  Room room(1);
  for (int k = 0; k < 300; ++k) room.tick();
  std::size_t requests = 0;
  for (int k = 0; k < 120; ++k) {
    const std::size_t before = heap_requests;
    room.simulation.tick();
    requests += heap_requests - before;
  }
  EXPECT_EQ(requests, 0U);
}

TEST(Avoidance, UnmanagedWalkersAndDiscsAreAvoided) {
  Avoiders all;
  const Entity a = all.come(1.2F, 0.0F, -6.0F), b = walker(all.simulation, 1.2F, 0.1F, 6, pi);
  double least = 10, min_disc = 10;
  for (int k = 0; k < 900; ++k) {
    const Disc pillar = {{-0.1F, 4}, 0.3F};
    ASSERT_TRUE(all.avoidance.set_discs({&pillar, 1}));
    all.run();
    least = std::min(least, all.apart_m(a, b));
    min_disc = std::min(min_disc, std::hypot(all.root(a).x_m + 0.1, all.root(a).z_m - 4));
  }
  EXPECT_GT(least, 0.40);
  EXPECT_GT(min_disc, 0.51);
  EXPECT_GT(all.root(a).z_m, 5);
}

TEST(Avoidance, OverlappingPeopleSeparate) {
  Avoiders all;
  std::vector<DesiredVelocity> wishes;
  for (int i = 0; i < 5; ++i) {
    const auto number = static_cast<float>(i);
    wishes.push_back({all.come(0, 0.2F * number, 0.15F * static_cast<float>(i % 2)), 1, 2 * pi * number / 5});
  }
  ASSERT_TRUE(all.avoidance.set_desired_velocity(wishes));
  all.run(1200);
  for (const DesiredVelocity& a : wishes)
    for (const DesiredVelocity& b : wishes) EXPECT_TRUE(a.person == b.person || all.apart_m(a.person, b.person) > 1);
}

TEST(Avoidance, DesiredVelocityIsKeptAsleepAndReleasedPeopleWalk) {
  Avoiders all;
  Simulation& simulation = all.simulation;
  Avoidance& avoidance = all.avoidance;
  const Entity one = all.come(1.2F);
  all.run(300);
  ASSERT_EQ(simulation.set_state({&one, 1}, PersonState::asleep).value(), 1U);
  all.run(120);
  EXPECT_NEAR(simulation.get<AvoidanceState>(one)->speed_m_s, 1.2F, 1e-6F);
  EXPECT_FALSE(avoidance.set_desired_velocity(std::array{DesiredVelocity{one, 30, 0}}))
      << "nobody of that height walks so";
  ASSERT_TRUE(avoidance.set_desired_velocity(std::array{DesiredVelocity{one, 1.3F, 0}}));
  ASSERT_TRUE(simulation.set_state({&one, 1}, PersonState::full));
  EXPECT_NEAR(simulation.get<AvoidanceState>(one)->speed_m_s, 1.3F, 1e-6F);
  ASSERT_TRUE(avoidance.release(one));
  EXPECT_FALSE(simulation.get<AvoidanceState>(one));
  const double before = root_of(simulation, one).z_m;
  simulation.tick(60);
  EXPECT_NEAR(root_of(simulation, one).z_m - before, 1.2, 0.1);
}

/// Two tall walkers accelerate towards each other and strike in the same ticks, at random distances and positions
/// relative to the cells that reservations are sorted into. Their stopping distances exceed a reservation's length.
TEST(Avoidance, FastOncomingWalkersAreSeenInTime) {
  for (std::uint64_t c = 0; c < 1500; ++c) {
    const auto draw = [&](std::uint64_t which) { return drawn(c, which); };
    const float speed = 0.8F + 1.4F * draw(0), faster = speed + (2.3F - speed) * draw(1), off = 3 * draw(4);
    const float heading = pi * (1 + 0.3F * (draw(2) - 0.5F)), half = 1.1F * speed + 0.8F + 1.5F * draw(3);
    Avoiders all;
    const Entity a = all.come(speed, off, off - half, 0.0F, 1.9F),
                 b = all.come(speed, off - half * std::sin(heading), off + half, heading, 1.9F);
    ASSERT_TRUE(all.avoidance.set_desired_velocity(
        std::array{DesiredVelocity{a, faster, 0}, DesiredVelocity{b, faster, heading}}));
    const float radii_m =
        all.simulation.get<AvoidanceState>(a)->radius_m + all.simulation.get<AvoidanceState>(b)->radius_m;
    for (int k = 0; k < 150; ++k) {
      all.run();
      ASSERT_GT(all.apart_m(a, b), radii_m - 0.04F) << c;
    }
  }
}

TEST(Avoidance, LoneWalkersAreUnaffected) {
  Avoiders all;
  Simulation without;
  const Entity a = all.come(1.25F), b = walker(without, 1.25F);
  all.run(600);
  without.tick(600);
  const Root one = all.root(a), other = root_of(without, b);
  EXPECT_EQ(one.x_m, other.x_m);
  EXPECT_NEAR(one.z_m, other.z_m, 3e-3);
}

/// Standing people with a goal behind them or to the side turn and walk, and do not sidestep all the way.
TEST(Avoidance, StandingPeopleTurnTowardTheirGoal) {
  for (int degrees = -180; degrees < 180; degrees += 7) {
    Avoiders all;
    const Entity one = all.come(0);
    const float heading = static_cast<float>(degrees) * pi / 180;
    ASSERT_TRUE(all.avoidance.set_desired_velocity({{DesiredVelocity{one, 1.3F, heading}}}));
    all.run(6 * 60);
    const Root at = all.root(one);
    EXPECT_GT(at.x_m * std::sin(heading) + at.z_m * std::cos(heading), 2) << degrees;
    EXPECT_LT(std::fabs(std::remainder(at.heading_rad - heading, 2 * pi)), 0.05F) << degrees;
  }
}

/// People between walls on all sides turn and walk once the walls are removed.
TEST(Avoidance, BoxedInPeopleTurnAndWalkOnceFree) {
  for (const float heading : {pi, 1.2F, -2.0F}) {
    Avoiders all;
    const Entity one = all.come(0);
    constexpr float a = 0.3F;
    ASSERT_TRUE(all.avoidance.set_walls(
        {{Wall{{-a, -a}, {a, -a}}, Wall{{a, -a}, {a, a}}, Wall{{a, a}, {-a, a}}, Wall{{-a, a}, {-a, -a}}}}));
    ASSERT_TRUE(all.avoidance.set_desired_velocity({{DesiredVelocity{one, 1.3F, heading}}}));
    all.run(7 * 60);
    const Root from = all.root(one);
    ASSERT_TRUE(all.avoidance.set_walls({}));
    all.run(6 * 60);
    const Root at = all.root(one);
    EXPECT_GT((at.x_m - from.x_m) * std::sin(heading) + (at.z_m - from.z_m) * std::cos(heading), 2) << heading;
  }
}

/// The person steps back first, because every step along the wall is blocked:
///
///     z = 3    |  |        walls of a column 0.24 m wide, open at its far end
///              |  |
///     0.40     |  |   *    goal (0.45, 0.4), and then straight on in z
///     0.23     +--+
///     0         o          person at x = -0.07
TEST(Avoidance, PeopleTooNearACornerGetAroundIt) {
  Avoiders all;
  ASSERT_TRUE(all.avoidance.set_walls(
      {{Wall{{-0.12F, 0.23F}, {0.12F, 0.23F}}, Wall{{0.12F, 0.23F}, {0.12F, 3}}, Wall{{-0.12F, 0.23F}, {-0.12F, 3}}}}));
  const Entity one = all.come(0, -0.07F, 0.0F, 0.8F, 1.86F);
  for (int k = 0; k < 15 * 60; ++k) {
    const Root at = all.root(one);
    const auto heading = static_cast<float>(std::atan2(0.45 - at.x_m, 0.4 - at.z_m));
    const bool past = at.x_m > 0.3;
    ASSERT_TRUE(all.avoidance.set_desired_velocity({{DesiredVelocity{one, 1.2F, past ? 0 : heading}}}));
    all.run();
  }
  EXPECT_GT(all.root(one).z_m, 3);
}

TEST(Avoidance, ForgedSnapshotsWithAValidSealAreHarmless) {
  Room room(1);
  for (int k = 0; k < 100; ++k) room.tick();
  std::vector<std::byte> good(room.simulation.snapshot_bytes());
  ASSERT_TRUE(room.simulation.save(good));
  std::size_t taken = 0;
  for (std::uint64_t k = 0; k < 300; ++k) {
    std::vector<std::byte> bytes = good;
    for (std::uint64_t w = 0; w < 1 + k % 9; ++w) {
      const std::uint64_t draw = mix64(mix64(k) ^ w), at = 4 * (draw % (bytes.size() / 4));
      const auto word =
          static_cast<std::uint32_t>(w % 2 == 0 ? mix64(draw) : 0x7F000000U | (mix64(draw) & 0x80FFFFFFU));
      std::memcpy(&bytes[at], &word, 4);
    }
    if (!reseal_snapshot(bytes) || !room.simulation.restore(bytes)) continue;
    ++taken;
    for (int t = 0; t < 4; ++t) room.simulation.tick();
  }
  EXPECT_GT(taken, 20U);
  ASSERT_TRUE(room.simulation.restore(good));
}

/// A snapshot can contain any finite number.
TEST(Avoidance, HugeHeadingsAffectNoOtherPerson) {
  Avoiders all;
  Simulation& simulation = all.simulation;
  const Entity one = all.come(1.2F), other = all.come(1.2F, 0.3F, 3.0F, pi);
  for (const float turn : {1e11F, -3e30F, 2e5F}) {
    GaitState<float> state = *simulation.get<GaitState>(other);
    state.turn_rad = turn;
    ASSERT_EQ(world_of(simulation).set(other, state), Status::ok);
    all.run(120);
  }
  const Root at = all.root(one);
  EXPECT_TRUE(std::isfinite(at.x_m) && std::isfinite(at.z_m) && std::isfinite(at.heading_rad));
  EXPECT_GT(at.z_m, 2);
}

TEST(Avoidance, RefusalsNameTheMistake) {
  Simulation simulation;
  Avoidance avoidance = simulation.avoidance();
  const Entity one = walker(simulation, 1), posed = simulation.spawn_posed({}).value();
  const auto line = [](const Result<void>& result) { return result ? std::string() : result.error().message; };
  EXPECT_NE(line(avoidance.manage(posed)).find("discs"), std::string::npos);
  EXPECT_EQ(avoidance.manage(Entity{}).error().status, Status::stale_entity);
  const DesiredVelocity early = {one, 1, 0};
  EXPECT_EQ(avoidance.set_desired_velocity({&early, 1}).error().status, Status::missing);
  EXPECT_FALSE(avoidance.release(one));
  ASSERT_TRUE(avoidance.manage(one));
  const DesiredVelocity fast[] = {{one, 1.2F, 1}, {one, 9, 0}};
  EXPECT_NE(line(avoidance.set_desired_velocity(fast)).find("speed"), std::string::npos);
  EXPECT_EQ(simulation.get<AvoidanceState>(one)->speed_m_s, 1.0F) << "all or none";
  const DesiredVelocity nowhere = {one, 1, std::nanf("")};
  EXPECT_NE(line(avoidance.set_desired_velocity({&nowhere, 1})).find("heading"), std::string::npos);
  const Wall wall = {{0, 0}, {std::nanf(""), 0}};
  EXPECT_NE(line(avoidance.set_walls({&wall, 1})).find("wall"), std::string::npos);
  const Disc disc = {{0, 0}, -1};
  EXPECT_NE(line(avoidance.set_discs({&disc, 1})).find("radius"), std::string::npos);
  const Disc rocket = {{0, 50}, 1, 0, -1001};
  EXPECT_NE(line(avoidance.set_discs({&rocket, 1})).find("velocity"), std::string::npos);
  const Wall far = {{-1e6F, 0}, {1e6F, 0}};
  EXPECT_TRUE(avoidance.set_walls({&far, 1})) << "at the bound";
}

}  // namespace
}  // namespace mobil
