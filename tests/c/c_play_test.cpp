// Events, roots, gait queries and batch placement through the C interface, compared with C++ in the host's axes.

#include <array>
#include <cmath>
#include <string>

#include <mobil/engine/world.h>
#include <mobil/step_report.h>
#include <mobil/systems/limits/limit_monitor.h>
#include <mobil/systems/people/step_event.h>
#include <mobil/systems/poses/roots.h>
#include "tests/c/c_fixture.h"

namespace mobil::c_play_test {
namespace {
using namespace c_test;

std::vector<mobil_event> events(const Sim& sim) {
  std::size_t count = 0;
  EXPECT_EQ(mobil_events(sim, nullptr, 0, &count), MOBIL_OK);
  std::vector<mobil_event> all(count);
  if (count > 0) {
    EXPECT_EQ(mobil_events(sim, all.data(), count - 1, nullptr), MOBIL_ROOM);
    EXPECT_EQ(mobil_events(sim, all.data(), count, nullptr), MOBIL_OK);
  }
  return all;
}

TEST(CPlay, EventsMatchCpp) {
  Twins twins;
  ASSERT_EQ(mobil_enable(twins.sim, twins.ids.data(), 5, MOBIL_STEP_EVENTS, 1), MOBIL_OK) << twins.sim.message();
  ASSERT_TRUE(twins.simulation.enable(twins.entities, Feature::step_events));
  EXPECT_NE(bits_of(twins.sim, twins.ids[0]) & MOBIL_WATCHED, 0);
  std::size_t all = 0;
  for (int i = 0; i < 60; ++i) {
    ASSERT_EQ(mobil_advance(twins.sim, 0.05, nullptr), MOBIL_OK);
    twins.simulation.advance(0.05);
    const auto theirs = events(twins.sim);
    const auto ours = twins.simulation.events();
    ASSERT_EQ(theirs.size(), ours.size());
    all += ours.size();
    for (std::size_t e = 0; e < ours.size(); ++e) {
      EXPECT_EQ(theirs[e].id.index, ours[e].person.index);
      EXPECT_EQ(theirs[e].kind, static_cast<int>(ours[e].kind));
      EXPECT_EQ(theirs[e].side, static_cast<int>(ours[e].side));
      EXPECT_EQ(theirs[e].tick, ours[e].tick);
      EXPECT_EQ(theirs[e].part, ours[e].part);
      EXPECT_NEAR(theirs[e].place[0], 100 * ours[e].place_m.z, 1e-3);
      EXPECT_NEAR(theirs[e].place[1], -100 * ours[e].place_m.x, 1e-3);
      EXPECT_EQ(theirs[e].place[2], 0);
      EXPECT_EQ(theirs[e].heading_rad, ours[e].heading_rad);
    }
  }
  EXPECT_GT(all, 40U);
  EXPECT_EQ(twins.sim.hash(), twins.simulation.state_hash());
  ASSERT_EQ(mobil_enable(twins.sim, twins.ids.data(), 5, MOBIL_STEP_EVENTS, 0), MOBIL_OK);
  ASSERT_EQ(mobil_tick(twins.sim, 30), MOBIL_OK);
  EXPECT_TRUE(events(twins.sim).empty());
}

TEST(CPlay, SeveralTicksAtOnceReportTogether) {
  Twins twins;
  ASSERT_EQ(mobil_enable(twins.sim, twins.ids.data(), 5, MOBIL_STEP_EVENTS, 1), MOBIL_OK);
  ASSERT_EQ(mobil_tick(twins.sim, 60), MOBIL_OK);
  EXPECT_GT(events(twins.sim).size(), 10U);
}

TEST(CPlay, RootMotionMatchesCpp) {
  Twins twins;
  std::vector<mobil_root> roots(5);
  std::vector<mobil_motion> ways(5);
  std::vector<Root> before(5), after(5);
  ASSERT_EQ(mobil_roots(twins.sim, twins.ids.data(), 5, 0, roots.data()), MOBIL_OK) << twins.sim.message();
  ASSERT_TRUE(twins.simulation.roots(twins.entities, before));
  for (int t = 0; t < 30; ++t) {
    ASSERT_EQ(mobil_tick(twins.sim, 1), MOBIL_OK);
    twins.simulation.tick();
    ASSERT_EQ(mobil_root_motion(twins.sim, twins.ids.data(), 5, 0.004, roots.data(), ways.data()), MOBIL_OK);
    ASSERT_TRUE(twins.simulation.roots(twins.entities, after, 0.004));
    for (std::size_t i = 0; i < 5; ++i) {
      const RootMotion way = root_motion(before[i], after[i]);
      EXPECT_NEAR(ways[i].way[0], 100 * way.ahead_m, 1e-4);
      EXPECT_NEAR(ways[i].way[1], -100 * way.left_m, 1e-4);
      EXPECT_EQ(ways[i].way[2], 0);
      EXPECT_NEAR(ways[i].turn_rad, way.turn_rad, 1e-7);
      EXPECT_NEAR(roots[i].place[0], 100 * after[i].z_m, 1e-9);
      EXPECT_NEAR(roots[i].place[1], -100 * after[i].x_m, 1e-9);
    }
    before = after;
  }
  EXPECT_EQ(mobil_roots(twins.sim, twins.ids.data(), 5, 0.3, roots.data()), MOBIL_REFUSED);
  EXPECT_NE(twins.sim.message().find("0.2"), std::string::npos);
  EXPECT_EQ(mobil_root_motion(twins.sim, twins.ids.data(), 5, 0, nullptr, ways.data()), MOBIL_REFUSED);
}

TEST(CPlay, GaitIsReadBackAndRequestedAgain) {
  Twins twins;
  auto walk = filled<mobil_walk>(MOBIL_WALK);
  walk.given = MOBIL_SPEED | MOBIL_HEADING;
  walk.speed_m_s = 1.5F;
  walk.heading_rad = 0.9F;
  ASSERT_EQ(mobil_change_walk(twins.sim, twins.ids.data(), 1, &walk), MOBIL_OK);
  std::array<float, 64> style{};
  auto read = filled<mobil_walk>(MOBIL_WALK);
  ASSERT_EQ(mobil_get_walk(twins.sim, twins.ids[0], &read, style.data(), style.size()), MOBIL_OK)
      << twins.sim.message();
  EXPECT_EQ(read.given, MOBIL_SPEED | MOBIL_STEP_LENGTH | MOBIL_HEADING | MOBIL_STYLE);
  EXPECT_EQ(read.speed_m_s, 1.5F);
  EXPECT_EQ(read.heading_rad, 0.9F);
  EXPECT_NEAR(read.step_frequency_hz, read.speed_m_s / read.step_length_m, 1e-5);
  ASSERT_EQ(read.style, style.data());
  // Changes one style parameter only.
  mobil_style_number number;
  int toe_out = 0;
  while (mobil_style(toe_out, &number) == MOBIL_OK && std::string(number.name) != "toe_out_deg") ++toe_out;
  style[static_cast<std::size_t>(toe_out)] += 4;
  read.given = MOBIL_STYLE;
  ASSERT_EQ(mobil_change_walk(twins.sim, twins.ids.data(), 1, &read), MOBIL_OK) << twins.sim.message();
  const float asked = style[static_cast<std::size_t>(toe_out)];
  auto again = filled<mobil_walk>(MOBIL_WALK);
  ASSERT_EQ(mobil_get_walk(twins.sim, twins.ids[0], &again, style.data(), style.size()), MOBIL_OK);
  EXPECT_EQ(style[static_cast<std::size_t>(toe_out)], asked);
  EXPECT_EQ(again.speed_m_s, 1.5F);
  EXPECT_EQ(again.step_length_m, read.step_length_m);
  EXPECT_EQ(again.heading_rad, 0.9F);
  ASSERT_EQ(mobil_get_walk(twins.sim, twins.ids[0], &again, nullptr, 0), MOBIL_OK);
  EXPECT_EQ(again.given & MOBIL_STYLE, 0);
  EXPECT_EQ(mobil_get_walk(twins.sim, twins.ids[0], &again, style.data(), 3), MOBIL_ROOM);
  EXPECT_EQ(mobil_get_walk(twins.sim, {99, 9}, &again, nullptr, 0), MOBIL_STALE);
}

TEST(CPlay, BatchPlacementIsAllOrNone) {
  Twins twins;
  std::vector<std::array<float, 4>> to(5);
  std::vector<PlaceRequest> ours(5);
  for (std::size_t i = 0; i < 5; ++i) {
    const auto n = static_cast<float>(i);
    ours[i] = {twins.entities[i], 2 * n, 7 - n, 0.2F * n};
    to[i] = {100 * ours[i].z_m, -100 * ours[i].x_m, 3, ours[i].heading_rad};
  }
  ASSERT_EQ(mobil_place_many(twins.sim, twins.ids.data(), 5, to[0].data(), 0), MOBIL_OK) << twins.sim.message();
  ASSERT_TRUE(twins.simulation.place(ours));
  EXPECT_EQ(twins.sim.hash(), twins.simulation.state_hash());
  to[4][0] = INFINITY;
  EXPECT_EQ(mobil_place_many(twins.sim, twins.ids.data(), 5, to[0].data(), 0), MOBIL_REFUSED);
  EXPECT_NE(twins.sim.message().find("person 4"), std::string::npos);
  EXPECT_EQ(mobil_place_many(twins.sim, twins.ids.data(), 5, to[0].data(), 8), MOBIL_REFUSED);
  EXPECT_EQ(twins.sim.hash(), twins.simulation.state_hash());
}

TEST(CPlay, PosedPeopleHaveNoStepEvents) {
  const Sim sim;
  auto person = filled<mobil_person>(MOBIL_PERSON);
  person.posed = 1;
  mobil_id id;
  ASSERT_EQ(mobil_spawn(sim, &person, 0, 1, nullptr, &id), MOBIL_OK);
  EXPECT_EQ(mobil_enable(sim, &id, 1, MOBIL_STEP_EVENTS, 1), MOBIL_MISSING);
  EXPECT_NE(sim.message().find("posed"), std::string::npos);
  auto walk = filled<mobil_walk>(MOBIL_WALK);
  EXPECT_EQ(mobil_get_walk(sim, id, &walk, nullptr, 0), MOBIL_MISSING);
}

/// A person known to exceed the hip's limit in a turn.
TEST(CPlay, LimitViolationsMatchCpp) {
  GaitRequest gait{.speed_m_s = 1.223403F};
  gait.style.step_asymmetry = -0.4F;
  std::vector<float> style;
  for (const GaitParameter& p : gait_parameters) style.push_back(gait.style.*p.value);
  auto person = filled<mobil_person>(MOBIL_PERSON);
  person.height_m = 1.278257F;
  person.mass_kg = 35.655258F;
  person.given = MOBIL_SPEED | MOBIL_STYLE;
  person.speed_m_s = *gait.speed_m_s;
  person.style = style.data();
  person.style_count = style.size();
  Sim sim;
  mobil_id id{};
  ASSERT_EQ(mobil_spawn(sim, &person, 0, 1, nullptr, &id), MOBIL_OK) << sim.message();
  Simulation simulation;
  const Entity same = *simulation.spawn(BodyRequest{.height_m = person.height_m, .mass_kg = person.mass_kg}, gait);
  const auto turn = [&](float heading_rad) {
    auto walk = filled<mobil_walk>(MOBIL_WALK);
    walk.given = MOBIL_HEADING;
    walk.heading_rad = heading_rad;
    ASSERT_EQ(mobil_change_walk(sim, &id, 1, &walk), MOBIL_OK) << sim.message();
    ASSERT_TRUE(simulation.turn_to(same, heading_rad));
  };
  std::size_t broken = 0, people = 0, all = 0;
  for (int tick = 0; tick < 360; ++tick) {
    if (tick == 43) turn(2.27692F);
    if (tick == 200) turn(1.99182F);
    if (tick == 251) turn(-1.26278F);
    ASSERT_EQ(mobil_tick(sim, 1), MOBIL_OK);
    simulation.tick();
    std::string ours;
    for (const LimitViolation& limit : limit_violations(simulation.world(), same)) ours += described(limit) + '\n';
    std::size_t length = 0;
    ASSERT_EQ(mobil_limit_violations(sim, id, nullptr, 0, &length), MOBIL_OK);
    ASSERT_EQ(length, ours.size());
    std::vector<char> text(length + 1, 'x');
    ASSERT_EQ(mobil_limit_violations(sim, id, text.data(), length, nullptr), MOBIL_ROOM);
    EXPECT_EQ(text[0], 'x');
    ASSERT_EQ(mobil_limit_violations(sim, id, text.data(), length + 1, nullptr), MOBIL_OK);
    EXPECT_EQ(text.data(), ours);
    ASSERT_EQ(mobil_limit_violation_counts(sim, &people, &all), MOBIL_OK);
    EXPECT_EQ(people, simulation.report().limit_violations);
    EXPECT_EQ(all, simulation.report().total_limit_violations);
    broken += ours.empty() ? 0 : 1;
  }
  EXPECT_GT(broken, 0U);
  EXPECT_GT(all, 0U);
  EXPECT_EQ(mobil_limit_violations(sim, id, nullptr, 0, nullptr), MOBIL_REFUSED);
  EXPECT_EQ(mobil_limit_violation_counts(sim, nullptr, nullptr), MOBIL_OK);
  EXPECT_EQ(mobil_limit_violations(sim, {99, 0}, nullptr, 0, &people), MOBIL_STALE);
}

TEST(CPlay, PhasesMatchTheReport) {
  const Sim sim;
  Simulation simulation;
  ASSERT_EQ(mobil_tick(sim, 1), MOBIL_OK);
  const StepReport report = simulation.report();
  mobil_phase phase{};
  int count = 0;
  while (mobil_phase_cost(sim, count, &phase) == MOBIL_OK) {
    const PhaseReport& ours = report.phases.at(static_cast<std::size_t>(count++));
    EXPECT_EQ(phase.name, ours.name);
    EXPECT_EQ(phase.module, ours.module);
    EXPECT_EQ(phase.after != 0, ours.after);
    EXPECT_GE(phase.seconds, 0);
  }
  EXPECT_EQ(static_cast<std::size_t>(count), report.phases.size());
  EXPECT_EQ(mobil_phase_cost(sim, -1, &phase), MOBIL_MISSING);
  EXPECT_EQ(mobil_phase_cost(sim, 0, nullptr), MOBIL_REFUSED);
}

}  // namespace
}  // namespace mobil::c_play_test
