// People who change their gait: every violation of a limit of ground, joints or pelvis is counted and reported. The
// poses of all ticks show the violations (tests/simulation/walk_watch.h).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <mobil/engine/world.h>
#include <mobil/simulation.h>
#include <mobil/step_report.h>
#include <mobil/systems/limits/limit_monitor.h>
#include <mobil/systems/limits/walk_limits.h>
#include "systems/limits/walk_estimate.h"
#include "tests/simulation/walk_watch.h"

namespace mobil::limit_monitor_test {
using namespace style_limits_test;

struct Found {
  std::size_t people = 0, beyond = 0;     // people in total, people with a violation
  std::uint64_t seen = 0;                 // ticks with a violation
  std::uint64_t missed = 0, surplus = 0;  // ticks missed by the count, and ticks counted without a violation
  Walked worst;                           // of missed ticks
};

/// A request at a time: a heading, or a speed with a new style or the current one.
struct Change {
  double time_s;
  std::optional<float> heading_rad{}, speed_m_s{};
  std::optional<GaitStyle> style{};
};
using Changes = std::vector<Change>;

/// Returns turns of any size, stops, speeds and optionally styles, a third of a second to four seconds apart.
Changes random_changes(Dice& dice, float speed_m_s, double seconds, bool styles) {
  Changes changes;
  float heading = 0;
  for (double t = dice(0.5, 2); t < seconds; t += dice(0.3, 4)) {
    const double kind = dice(0, 1);
    if (kind < 0.4) {
      heading += dice.single(-1, 1) * (dice(0, 1) < 0.3 ? 3.1F : 1.0F);
      changes.push_back({t, std::remainder(heading, 6.2831853F)});
      continue;
    }
    const float slower = std::max(dice.single(0.3, 1) * speed_m_s, std::min(speed_m_s, 0.5F));
    changes.push_back({t, {}, kind < 0.5 ? 0 : kind < 0.8 ? slower : speed_m_s});
    if (styles && kind > 0.9) changes.back().style = any_style(dice, static_cast<unsigned>(dice.engine() % 6));
  }
  return changes;
}

Result<void> make(Simulation& simulation, Entity person, const Change& change) {
  if (change.heading_rad) return simulation.turn_to(person, *change.heading_rad);
  return simulation.change_gait(person, {.speed_m_s = change.speed_m_s, .style = change.style});
}

bool is_all_but_at_a_limit(const Walked& walked) {
  return walked.worst[under_mm] > most[under_mm] - 0.01 || walked.worst[shaken_m_s2] > most[shaken_m_s2] - 0.02 ||
         walked.worst[joint_deg] > 0;
}

void walk(const std::vector<Asked>& asked, const std::vector<Changes>& changes, double seconds, Found& found) {
  Simulation simulation({.tick_s = tick});
  const std::vector<Entity> people = spawn(simulation, asked);
  std::vector<Watch> watches;
  for (const Entity person : people) watches.emplace_back(simulation, person);
  std::vector<std::size_t> next(people.size()), beyond(people.size());
  for (double t = 0; t < seconds; t += tick) {
    std::uint64_t seen = 0, told_now = 0;
    Walked of_tick;
    for (std::size_t i = 0; i < people.size(); ++i) {
      Walked now;
      watches[i].look(now);
      const auto broken = limit_violations(simulation.world(), people[i]);
      EXPECT_TRUE(now.keeps_limits() || !broken.empty()) << told(asked[i], now);
      EXPECT_TRUE(broken.empty() || is_all_but_at_a_limit(now)) << told(asked[i], now);
      for (const LimitViolation& limit : broken)
        EXPECT_NE(described(limit).find("; the limit is "), std::string::npos) << described(limit);
      seen += now.keeps_limits() ? 0 : 1;
      told_now += broken.empty() ? 0 : 1;
      for (std::size_t m = 0; m < measures; ++m) of_tick.note(static_cast<Measure>(m), now.worst[m]);
      beyond[i] |= now.keeps_limits() ? 0 : 1;
      for (; next[i] < changes[i].size() && changes[i][next[i]].time_s <= t + 1e-9; ++next[i]) {
        const Change& change = changes[i][next[i]];
        const auto done = make(simulation, people[i], change);
        ASSERT_TRUE(done) << done.error().message;
      }
    }
    const std::uint64_t counted = simulation.report().limit_violations;
    if (seen > counted) {
      found.missed += seen - counted;
      for (std::size_t m = 0; m < measures; ++m) found.worst.note(static_cast<Measure>(m), of_tick.worst[m]);
    }
    found.surplus += counted > told_now ? counted - told_now : 0;
    found.seen += seen;
    simulation.tick();
  }
  found.people += people.size();
  found.beyond += static_cast<std::size_t>(std::ranges::count(beyond, std::size_t{1}));
}

/// Expects the count to miss only small violations and to contain no false ones.
void expect_little_missed(const Found& found) {
  std::printf("%llu of %llu ticks beyond a limit missed: by %.2f deg, %.2f m/s2 at most\n",
              static_cast<unsigned long long>(found.missed), static_cast<unsigned long long>(found.seen),
              found.worst.worst[joint_deg], found.worst.worst[shaken_m_s2]);
  EXPECT_EQ(found.surplus, 0U);
  constexpr std::array<double, measures> a_little = {0.6, 0, 1.5, 2.1};
  for (std::size_t m = 0; m < measures; ++m) EXPECT_LE(found.worst.worst[m], most[m] + a_little[m]) << measure_name[m];
}

/// A person known to exceed a limit, by 7° of a hip, and 240 random people of any style (4800 with MOBIL_LONG).
TEST(LimitMonitor, ReportsAllViolations) {
  Found found;
  std::vector<Asked> asked(1);
  asked[0] = {{.height_m = 1.278257F, .mass_kg = 35.655258F}, {.speed_m_s = 1.223403F}};
  asked[0].gait.style.step_asymmetry = -0.4F;
  walk(asked, {{{0.7166, 2.27692F}, {3.3333, 1.99182F}, {4.1833, -1.26278F}}}, 6, found);
  EXPECT_EQ(found.beyond, 1U);
  Dice dice{std::mt19937(11)};
  const std::size_t count = std::getenv("MOBIL_LONG") != nullptr ? 4800 : 240;
  for (std::size_t first = 0; first < count; first += 240) {
    std::vector<Asked> some;
    std::vector<Changes> changes;
    for (unsigned i = 0; i < 240; ++i) {
      some.push_back(anyone(dice, i % 6, i % 5 == 0));
      changes.push_back(random_changes(dice, *some.back().gait.speed_m_s, 10, i % 3 == 0));
    }
    walk(some, changes, 10, found);
  }
  std::printf("%zu of %zu people, %llu ticks beyond a limit\n", found.beyond, found.people,
              static_cast<unsigned long long>(found.seen));
  EXPECT_LE(found.missed, 5 + found.seen / 50);
  expect_little_missed(found);
  EXPECT_LE(found.beyond, 3 + count / 60);
}

/// People with nearly usual styles are monitored only when they turn one way and directly back. They keep all limits,
/// or exceed them slightly. 240 people; 24 000 with MOBIL_LONG.
TEST(LimitMonitor, NearlyUsualStylesNearlyKeepLimits) {
  Dice dice{std::mt19937(12)};
  const std::size_t count = std::getenv("MOBIL_LONG") != nullptr ? 24000 : 240;
  Found found;
  for (std::size_t first = 0; first < count; first += 240) {
    std::vector<Asked> some;
    std::vector<Changes> changes;
    while (some.size() < 240) {
      Asked one = anyone(dice, 0, false);
      one.gait.style = {};
      const bool usual = some.size() % 3 == 0;
      for (const GaitParameter& p : gait_parameters) {
        float& number = one.gait.style.*p.value;
        if (!usual) number = std::clamp(number + dice.single(-0.1, 0.1) * std::fabs(number), p.low, p.high);
      }
      if (!is_near_usual(one.gait.style)) continue;
      some.push_back(one);
      changes.push_back(random_changes(dice, *one.gait.speed_m_s, 10, false));
    }
    walk(some, changes, 10, found);
  }
  expect_little_missed(found);
}

/// Unusual styles in a steady walk; sleepers, posed people and despawned people have no limits.
TEST(LimitMonitor, SteadyWalksAndSleepersHaveNoViolations) {
  Simulation simulation;
  GaitRequest far{.speed_m_s = 2.06351F};
  far.style.double_support_scale = 0.6F;
  const Entity person = *simulation.spawn(BodyRequest{.height_m = 1.627254F, .mass_kg = 63.42218F}, far);
  for (int ticks = 0; ticks < 240; ++ticks) {
    EXPECT_TRUE(limit_violations(simulation.world(), person).empty()) << ticks;
    simulation.tick();
  }
  EXPECT_EQ(simulation.report().total_limit_violations, 0U);
  ASSERT_TRUE(simulation.change_gait(person, {.speed_m_s = 0}));
  simulation.tick(23);
  ASSERT_TRUE(simulation.change_gait(person, {.speed_m_s = 1.630582F}));
  simulation.tick(240);
  ASSERT_EQ(*simulation.set_state({&person, 1}, PersonState::asleep), 1U);
  EXPECT_TRUE(limit_violations(simulation.world(), person).empty());
  simulation.despawn(person);
  EXPECT_TRUE(limit_violations(simulation.world(), person).empty());
  EXPECT_TRUE(limit_violations(simulation.world(), Entity{}).empty());
}

TEST(LimitMonitor, DescribesViolations) {
  EXPECT_EQ(described({WalkBound::under_ground, 0.0062F}), "a foot is 6.2 mm under the ground; the limit is 5");
  EXPECT_EQ(described({WalkBound::toes_up, 1.4F}), "toes are bent up by 80.21 deg; the limit is 70");
}

}  // namespace mobil::limit_monitor_test
