// Walks of any style in range stay within the limits of ground, joints and pelvis. If a request would exceed one, its
// style is changed, and the changes are reported. The tests check the pose of every tick.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/components/step_plan.h>
#include <mobil/rows.h>
#include <mobil/simulation.h>
#include <mobil/systems/limits/style_limits.h>
#include <mobil/systems/limits/walk_limits.h>
#include "assets/body/body_scales.h"
#include "systems/gait/gait.h"
#include "systems/limits/walk_estimate.h"
#include "tests/labels.h"
#include "tests/simulation/walk_watch.h"

MOBIL_TEST_LABELS("threads;long");

namespace mobil::style_limits_test {

/// 240 people; ten thousand with MOBIL_LONG.
TEST(StyleLimits, WalksOfAnyStyleKeepThem) {
  MOBIL_SLOW();
  const std::size_t count = std::getenv("MOBIL_LONG") != nullptr ? 10000 : 240;
  constexpr std::size_t together = 240;
  Dice dice{std::mt19937(7)};
  Walked worst;
  std::size_t moved = 0;
  for (std::size_t first = 0; first < count; first += together) {
    std::vector<Asked> asked;
    for (std::size_t i = 0; i < std::min(together, count - first); ++i)
      asked.push_back(anyone(dice, static_cast<unsigned>(i % 6), i % 5 == 0));
    const std::vector<Walked> walked = walk(asked, 3.5);
    for (std::size_t i = 0; i < asked.size(); ++i) {
      EXPECT_TRUE(walked[i].keeps_limits()) << told(asked[i], walked[i]);
      for (std::size_t m = 0; m < measures; ++m) worst.note(static_cast<Measure>(m), walked[i].worst[m]);
      if (count <= 1000 && !style_changes(asked[i].body, asked[i].gait)->empty()) ++moved;
    }
  }
  for (std::size_t m = 0; m < measures; ++m)
    std::printf("%zu walks: %.2f %s at most\n", count, worst.worst[m], measure_name[m]);
  if (count <= 1000) {
    EXPECT_GT(moved, count / 5);  // otherwise the test shows little
  }
}

/// Usual walks of all bodies and speeds are far from the limits and unchanged.
RC_GTEST_PROP(StyleLimits, UsualWalksAreUnchanged, (unsigned seed)) {
  Dice dice{std::mt19937(seed)};
  Asked asked = anyone(dice, 0, false);
  asked.gait.style = {};
  RC_ASSERT(style_changes(asked.body, asked.gait)->empty());
  RC_ASSERT(walk({asked}, 2).front().keeps_limits());
}

TEST(StyleLimits, UsualWalksKeepThemInStopsStartsAndTurns) {
  MOBIL_SLOW();
  Dice dice{std::mt19937(5)};
  std::vector<Asked> asked;
  for (int i = 0; i < 160; ++i) {
    asked.push_back(anyone(dice, 0, false));
    asked.back().gait = {.speed_m_s = asked.back().gait.speed_m_s};
  }
  std::vector<Walked> walked(asked.size());
  std::vector<std::unique_ptr<Watch>> watches(asked.size());
  play(asked, [&](const Simulation& simulation, Entity person, std::size_t i, const char* name) {
    if (watches[i] == nullptr) watches[i] = std::make_unique<Watch>(simulation, person);
    watches[i]->look(walked[i]);
    ASSERT_TRUE(walked[i].keeps_limits()) << name << ": " << told(asked[i], walked[i]);
  });
}

/// Nearly all walks of any style do: turning steps and changes of speed are nearer to the usual style, and unusual
/// styles keep a larger distance from limits. No foot in the air is bent far up. 240 people; 4800 with MOBIL_LONG.
TEST(StyleLimits, NearlyAllWalksKeepThemInStopsStartsAndTurns) {
  MOBIL_SLOW();
  Dice dice{std::mt19937(6)};
  std::vector<Asked> asked;
  const bool longer = std::getenv("MOBIL_LONG") != nullptr;
  for (unsigned i = 0; i < (longer ? 4800 : 240); ++i) asked.push_back(anyone(dice, i % 6, false));
  std::map<std::string, std::vector<Walked>> walked;  // by phase
  float furthest = 0;
  std::vector<std::unique_ptr<Watch>> watches(asked.size());
  play(asked, [&](const Simulation& simulation, Entity person, std::size_t i, const char* name) {
    if (watches[i] == nullptr) watches[i] = std::make_unique<Watch>(simulation, person);
    auto& of_phase = walked[name];
    of_phase.resize(asked.size());
    watches[i]->look(of_phase[i]);
    const auto state = *simulation.get<GaitState>(person);
    const auto plan = *simulation.get<StepPlan>(person);
    const float phase = state.time_s / plan.duration_s;
    if (i >= 240 || phase < plan.double_support || phase > plan.landing) return;
    const auto other = state.stance_side == Side::right ? Side::left : Side::right;
    furthest = std::max(furthest, simulation.get<JointAngles>(person)->ankle_dorsiflexion[other]);
    ASSERT_LT(furthest, 44 * degree) << name << ": " << told(asked[i], {});
  });
  EXPECT_GT(furthest, 33 * degree);  // otherwise no foot was near the limit
  ASSERT_EQ(walked.size(), 6U);
  const std::map<std::string, std::size_t> at_most = {{"walks", 0}, {"starts", 0},    {"slows down", 1},
                                                      {"turns", 1}, {"speeds up", 1}, {"stops", 1}};
  for (const auto& [name, of_phase] : walked) {
    const auto broken = static_cast<std::size_t>(
        std::ranges::count_if(of_phase, [](const Walked& one) { return !one.keeps_limits(); }));
    std::printf("%s: %zu of %zu beyond a limit\n", name.c_str(), broken, of_phase.size());
    EXPECT_LE(broken, longer ? at_most.at(name) : 0) << name;
  }
}

/// After far turns and changes of speed, people walk in their own style again.
TEST(StyleLimits, StylesAreResumed) {
  Dice dice{std::mt19937(8)};
  for (unsigned i = 0; i < 40; ++i) {
    Asked asked = anyone(dice, i % 6, false);
    asked.gait.style.step_asymmetry = asked.gait.style.time_asymmetry = 0;
    Simulation simulation;
    const Entity person = *simulation.spawn(asked.body, asked.gait);
    const auto strike = [&] {
      const auto plan = *simulation.get<StepPlan>(person);
      return plan.settled == 1 ? std::optional(plan.to) : std::nullopt;
    };
    simulation.tick(60);
    const auto before = strike();
    ASSERT_TRUE(before) << told(asked, {});
    EXPECT_EQ(before->own_style, 1);
    ASSERT_TRUE(simulation.turn_to(person, 3));
    float least = 1;
    for (int ticks = 0; ticks < 150; ++ticks) {
      simulation.tick();
      least = std::min(least, simulation.get<StepPlan>(person)->to.own_style);
    }
    EXPECT_TRUE(least < 0.1F || same_style(simulation.gait_request(person)->style, {})) << told(asked, {});
    simulation.tick(600);
    ASSERT_TRUE(simulation.change_gait(
        person, {.speed_m_s = std::max(0.6F * *asked.gait.speed_m_s, std::min(0.5F, *asked.gait.speed_m_s))}));
    simulation.tick(240);
    ASSERT_TRUE(simulation.set_gait(person, asked.gait));
    simulation.tick(400);
    const auto after = strike();
    ASSERT_TRUE(after) << told(asked, {});
    EXPECT_EQ(std::memcmp(&*after, &*before, sizeof(*after)), 0) << told(asked, {});
  }
}

/// People who turn in place, or stop after a step or two, stand on even feet and are not solved again.
TEST(StyleLimits, StandingAfterCalmStepsBecomesEven) {
  const BodyRequest body{.height_m = 1.75F, .mass_kg = 75};
  GaitStyle style;
  style.toe_out_deg = 20;
  style.step_width_h = 0.09F;
  for (const float turn : {0.3F, 1.0F, 3.0F}) {
    for (const std::uint32_t ticks : {0U, 20U, 45U, 70U, 110U}) {  // 0: never starts
      Simulation simulation;
      const GaitRequest standing{.speed_m_s = 0, .style = style};
      const Entity person = *simulation.spawn(body, standing);
      if (ticks > 0) {
        ASSERT_TRUE(simulation.change_gait(person, {.speed_m_s = 1.5F}));
        simulation.tick(ticks);
        ASSERT_TRUE(simulation.change_gait(person, {.speed_m_s = 0}));
      }
      ASSERT_TRUE(simulation.turn_to(person, turn));
      simulation.tick(900);
      const auto plan = *simulation.get<StepPlan>(person);
      EXPECT_EQ(plan.settled, 1U) << turn << " rad, " << ticks << " ticks of walking";
      EXPECT_EQ(plan.trailing_toe_out, plan.from.toe_out);
      EXPECT_EQ(plan.trailing_half_width_m, plan.from.half_width_m);
      EXPECT_EQ(plan.to.own_style, 1);
      EXPECT_EQ(simulation.set_state({&person, 1}, PersonState::asleep).value(), 1U);
      ASSERT_TRUE(simulation.turn_to(person, turn + 2));
      simulation.tick(900);
      EXPECT_EQ(simulation.state(person), PersonState::asleep) << turn << " rad, " << ticks << " ticks of walking";
    }
  }
}

TEST(StyleLimits, StandingStyleChangeMovesTheFeet) {
  Simulation simulation;
  const Entity person = *simulation.spawn({.height_m = 1.75F, .mass_kg = 75}, {.speed_m_s = 0});
  simulation.tick(60);
  GaitStyle broad;
  broad.step_width_h = 0.09F;
  broad.toe_out_deg = 15;
  const Entity twin = *simulation.spawn({.height_m = 1.75F, .mass_kg = 75}, {.speed_m_s = 0, .style = broad});
  ASSERT_TRUE(simulation.change_gait(person, {.style = broad}));
  simulation.tick(300);
  const auto plan = *simulation.get<StepPlan>(person), own = *simulation.get<StepPlan>(twin);
  EXPECT_EQ(plan.from.half_width_m, own.from.half_width_m);
  EXPECT_EQ(plan.trailing_half_width_m, own.trailing_half_width_m);
  EXPECT_EQ(plan.from.toe_out, own.from.toe_out);
  EXPECT_EQ(simulation.set_state({&person, 1}, PersonState::asleep).value(), 1U);
}

/// Steps that turn far have equal durations, right and left, with any time asymmetry of the style.
TEST(StyleLimits, CalmStepsAreEven) {
  Simulation simulation;
  const Entity person = *simulation.spawn({.height_m = 1.75F, .mass_kg = 75}, {.style = {.time_asymmetry = 0.2F}});
  simulation.tick(120);
  ASSERT_TRUE(simulation.turn_to(person, 3));
  std::vector<float> lasts;
  for (int t = 0; t < 90; ++t) {
    simulation.tick();
    const auto plan = *simulation.get<StepPlan>(person);
    if (plan.from.own_style <= 0 && plan.to.own_style <= 0) lasts.push_back(plan.duration_s);
  }
  ASSERT_GT(lasts.size(), 30U);
  for (const float one : lasts) EXPECT_NEAR(one, lasts.front(), 1e-5F);
}

/// The reported style is the walked one. It is independent of other people, spawn order and threads.
TEST(StyleLimits, AreIndependentOfOtherPeople) {
  Dice dice{std::mt19937(3)};
  std::vector<Asked> asked;
  for (unsigned i = 0; i < 40; ++i) asked.push_back(anyone(dice, i % 6, i % 4 == 0));
  std::vector<SpawnRequest> requests;
  for (const Asked& one : asked) requests.push_back({.body = one.body, .gait = one.gait});
  std::ranges::reverse(requests);
  Simulation many({.threads = 2});
  std::vector<Entity> people(asked.size());
  ASSERT_TRUE(many.spawn(requests, people));
  std::ranges::reverse(people);
  Simulation alone;
  std::size_t moved = 0;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    GaitStyle expected = asked[i].gait.style;
    std::optional<float> step_m;
    const auto changes = style_changes(asked[i].body, asked[i].gait);
    ASSERT_TRUE(changes);
    for (const StyleChange& change : *changes) {
      EXPECT_NE(described(change).find(" m/s"), std::string::npos);
      if (change.parameter == gait_parameters.size()) {
        step_m = change.walked;
        continue;
      }
      const GaitParameter& p = gait_parameters[change.parameter];
      EXPECT_EQ(change.asked, asked[i].gait.style.*p.value);
      EXPECT_GE(change.walked, p.low);
      EXPECT_LE(change.walked, p.high);
      expected.*p.value = change.walked;
      ++moved;
    }
    const auto walks = many.gait_request(people[i]);
    EXPECT_TRUE(same_style(walks->style, expected));
    if (step_m) {
      EXPECT_EQ(walks->step_length_m, step_m);
    }
    // A person who reaches the same gait another way walks in the same style.
    const Entity one = *alone.spawn(asked[i].body);
    ASSERT_TRUE(alone.set_gait(one, asked[i].gait));
    EXPECT_TRUE(same_style(alone.gait_request(one)->style, expected));
  }
  EXPECT_GT(moved, 20U);
}

/// If the usual pelvis tilt or the usual double support suffices, no other parameter changes.
TEST(StyleLimits, OneParameterChangesIfThatSuffices) {
  Dice dice{std::mt19937(21)};
  constexpr std::array numbers = {&GaitStyle::pelvis_tilt_deg, &GaitStyle::double_support_scale};
  std::size_t found = 0;
  for (int i = 0; i < 4000; ++i) {
    const BodyRequest body{.height_m = dice.single(1.5, 2)};
    GaitRequest walk{.speed_m_s = dice.single(1.2, 1.75)};
    for (const GaitParameter& p : gait_parameters)
      walk.style.*p.value = std::clamp(walk.style.*p.value * dice.single(0.9, 1.1), p.low, p.high);
    const auto changes = style_changes(body, walk);
    if (!changes || changes->empty()) continue;
    std::optional<float GaitStyle::*> enough;
    for (const auto number : numbers) {
      GaitRequest without = walk;
      without.style.*number = GaitStyle{}.*number;
      if (!enough && style_changes(body, without)->empty()) enough = number;
    }
    if (!enough) continue;
    ++found;
    ASSERT_EQ(changes->size(), 1U) << i;
    EXPECT_TRUE(gait_parameters[changes->front().parameter].value == *enough) << i;
  }
  EXPECT_GT(found, 5U);
}

/// If the estimate reports that a style keeps all limits, a walk of it keeps them at 240 instants a second.
TEST(StyleLimits, AreKeptIfTheEstimateIsSure) {
  Dice dice{std::mt19937(8)};
  std::vector<BodySize<float>> sizes;
  std::vector<Gait<float>> gaits;
  std::size_t sure = 0, asked = 0;
  while (sizes.size() < 640) {
    const float height_m = dice.single(1.4, 2.1);
    const auto size = make_size({.height_m = height_m, .mass_kg = dice.single(18, 34) * height_m * height_m}, 0.2F);
    GaitRequest request;
    request.speed_m_s = dice(0, 4) < 1 ? 0 : dice.single(0.4, 2.2);  // some stand
    for (const GaitParameter& p : gait_parameters) {
      const double off = dice(0, 3) < 1 ? (dice(0, 1) < 0.5 ? -0.1 : 0.1) : dice(-0.1, 0.1);
      request.style.*p.value *= static_cast<float>(1 + off);
    }
    const auto gait = resolve_gait(size.height_m, request);
    if (!gait) continue;
    ++asked;
    if (!surely_keeps_limits(size, *gait)) continue;
    ++sure;
    sizes.push_back(size);
    gaits.push_back(*gait);
  }
  EXPECT_GT(sure, asked / 3) << "an estimate that is rarely sure is of no use";
  BodySize<Lanes<float>> size{};
  Gait<Lanes<float>> gait{};
  WalkExtremes found{};
  for (std::size_t first = 0; first < sizes.size(); first += lane_count) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      put_row(sizes[first + l], size, l);
      put_row(gaits[first + l], gait, l);
    }
    walk_extremes(size, gait, Looking::closely, found);
    for (std::size_t b = 0; b < bound_count; ++b) {
      for (std::size_t l = 0; l < lane_count; ++l) {
        EXPECT_LE(double{found.steady.value[b][l]}, walk_limits()[b].limit) << walk_limits()[b].says;
      }
    }
  }
}

/// A gait change during sleep gives the same style as awake.
TEST(StyleLimits, HoldForSleepers) {
  const BodyRequest body{.height_m = 1.8F, .mass_kg = 75};
  const GaitRequest slow{.speed_m_s = 0.6F, .style = {.foot_flat_cycle = 0.06F}};
  const WalkChange faster{{}, GaitChange{.speed_m_s = 2.2F}, {}};
  Simulation simulation, awake;
  std::vector<GaitStyle> after;
  for (Simulation* const world : {&simulation, &awake}) {
    const Entity person = *world->spawn(body, slow);
    for (int i = 0; i < 300; ++i) world->tick();
    EXPECT_TRUE(same_style(world->gait_request(person)->style, slow.style));
    WalkChange change = faster;
    change.person = person;
    if (world == &simulation) {
      ASSERT_EQ(world->set_state({&person, 1}, PersonState::asleep).value(), 1U);
      ASSERT_TRUE(world->change_gait(person, *change.gait));
    } else {
      ASSERT_EQ(world->change_gait({&change, 1}).value(), 0U);
    }
    after.push_back(world->gait_request(person)->style);
    EXPECT_GT(after.back().foot_flat_cycle, slow.style.foot_flat_cycle);
  }
  EXPECT_TRUE(same_style(after[0], after[1]));
}

}  // namespace mobil::style_limits_test
