// Choices of leg muscles: every method follows the walk, in the requested steps, with and without inertia.
#include "tests/simulation/leg_muscles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include <mobil/engine/world.h>
#include <mobil/muscle_table.h>
#include <mobil/systems/surfaces/nodal_view.h>
#include "systems/bellies/leg_muscles_io.h"
#include "tests/labels.h"
#include "tests/refused.h"

MOBIL_TEST_LABELS("long");

namespace mobil::leg_muscles_test {
/// Returns the difference of the same person with two sets of muscles, in two simulations.
Difference walk_both(const SamplePerson& p, const LegMuscles& one, const LegMuscles& other, int ticks) {
  Simulation a(sharing()), b(sharing());
  const Entity in_a = join_with(a, p, one), in_b = join_with(b, p, other);
  Difference d;
  for (int i = 0; i < ticks; ++i) {
    a.tick();
    b.tick();
    compare(a, in_a, b, in_b, d);
  }
  return d;
}

/// A step that all methods resolve well.
constexpr double fine_s = 1.0 / 1920;

// -------------------------------------------------------------------------------------------- methods follow the walk

TEST(Methods, AgreeForShortSteps) {
  MOBIL_SLOW();
  for (const int who : {0, 12}) {
    for (const bool inertia : {false, true}) {
      const auto lumped = walk_both(sample_person(who), {.inertia = inertia, .dt_s = fine_s},
                                    {.method = Method::newmark, .inertia = inertia, .dt_s = fine_s}, 50);
      EXPECT_GT(lumped.most, 0.03);
      EXPECT_LT(lumped.apart, 0.01 * lumped.most) << who << inertia;
      const auto consistent =
          walk_both(sample_person(who), {.method = Method::implicit_central, .inertia = inertia, .dt_s = fine_s},
                    {.method = Method::newmark, .mass = Mass::consistent, .inertia = inertia, .dt_s = fine_s}, 50);
      EXPECT_LT(consistent.apart, 0.015 * consistent.most) << who << inertia;
    }
  }
}

TEST(Methods, RestInTheSameShapeInAStandingPerson) {
  MOBIL_SLOW();
  for (const bool inertia : {false, true}) {
    Simulation simulation(sharing());
    std::vector<Entity> people;
    for (const Method method : methods) {
      people.push_back(
          join_with(simulation, sample_person(7), {.method = method, .damping_per_s = 20, .inertia = inertia}));
      ASSERT_TRUE(simulation.change_gait(people.back(), {.speed_m_s = 0.0F}));
    }
    for (int i = 0; i < 360; ++i) simulation.tick();
    for (std::size_t m = 1; m < people.size(); ++m) {
      Difference d;
      compare(simulation, people[0], simulation, people[m], d);
      const bool other_load = inertia && methods[m] == Method::implicit_central;  // from the consistent mass
      EXPECT_LT(d.apart, other_load ? 1e-3 : 1e-4) << name(methods[m]) << (inertia ? " with inertia" : "");
    }
  }
}

TEST(Methods, FollowTheLineExactlyOrArePulled) {
  MOBIL_SLOW();
  for (const Method method : methods) {
    for (const Element element : {Element::full, Element::bbar, Element::one_point}) {
      for (const Drive drive : {Drive::displacement, Drive::force}) {
        Simulation simulation(sharing());
        LegMuscles choice{.drive = drive, .method = method, .element = element, .inertia = true};
        if (element != Element::full) choice.muscles = MuscleSet(0b0101);  // templates are slow to make
        const Entity person = join_with(simulation, sample_person(3), choice);
        double missed = 0;
        for (int i = 0; i < 40; ++i) {
          simulation.tick();
          for (const Entity muscle : muscles_of(simulation, person)) {
            const auto line = *simulation.get<LineOfAction>(muscle);
            const auto report = *simulation.get<BellyReport>(muscle);
            ASSERT_TRUE(std::isfinite(report.elongation_m));
            EXPECT_GT(report.volume_ratio, 0.7F);
            EXPECT_LT(report.volume_ratio, 1.4F);
            missed = std::max(missed,
                              static_cast<double>(std::abs(report.elongation_m - line.length_m + line.rest_length_m)));
          }
        }
        if (drive == Drive::displacement) {
          EXPECT_LT(missed, 1e-5) << name(method);
        } else {
          EXPECT_GT(missed, 1e-4) << name(method);
          EXPECT_LT(missed, 0.15) << name(method);
        }
      }
    }
  }
}

TEST(Methods, OtherCellsDampingAndMassWalk) {
  MOBIL_SLOW();
  Simulation simulation(sharing());
  const LegMuscles choices[] = {
      {.stiffness_damping_s = 0.003, .cells = {1, 2, 5}},
      {.method = Method::implicit_central, .stiffness_damping_s = 0.001, .foundation_hz = 12.0},
      {.method = Method::newmark, .mass = Mass::consistent, .damping_per_s = 0, .cells = {2, 2, 10}},
      {.material = {1060, 5e4, 0.45}, .element = Element::bbar, .inertia = true}};
  for (const LegMuscles& choice : choices) {
    const Entity person = join_with(simulation, sample_person(2), choice);
    for (int i = 0; i < 40; ++i) simulation.tick();
    for (const Entity muscle : muscles_of(simulation, person)) {
      EXPECT_EQ(nodal_displacement(simulation.world(), muscle).nodes, node_count(choice.cells));
      for (const float u : displacement(simulation, muscle)) ASSERT_LT(std::abs(u), 0.2F);  // not true of NaN
    }
  }
}

// ------------------------------------------------------------------------------------------------------------- steps

TEST(Steps, AreTheLongestWithinNineTenthsOfEachLimit) {
  Simulation simulation(sharing());
  for (const LegMuscles& choice :
       {LegMuscles{}, LegMuscles{.method = Method::implicit_central}, LegMuscles{.method = Method::finite},
        LegMuscles{.stiffness_damping_s = 0.002, .inertia = true}}) {
    const Entity person = join_with(simulation, sample_person(4), choice);
    for (const Entity muscle : muscles_of(simulation, person)) {
      const auto& world = simulation.world();
      const auto n = choice.method == Method::explicit_central ? *world.get<Substeps>(muscle)
                     : choice.method == Method::finite         ? *world.get<FiniteSteps>(muscle)
                                                               : *world.get<SolvedSteps>(muscle);
      const double limit = 0.9 * limit_of(simulation, muscle), tick = simulation.tick_s();
      EXPECT_LE(tick / static_cast<double>(n), limit * (1 + 1e-9));
      if (n > 1) {
        EXPECT_GT(tick / static_cast<double>(n - 1), limit);
      }
    }
  }
}

TEST(Steps, AreAsRequested) {
  Simulation simulation(sharing());
  const double tick = simulation.tick_s();
  const Entity explicitly = join_with(simulation, sample_person(0), {.dt_s = tick / 20}),
               hardly_less = join_with(simulation, sample_person(0), {.dt_s = tick / 20 * 0.999}),
               once = join_with(simulation, sample_person(0), {.method = Method::newmark}),
               long_ones = join_with(simulation, sample_person(0), {.method = Method::newmark, .dt_s = 1.0}),
               thrice = join_with(simulation, sample_person(0), {.method = Method::newmark, .dt_s = tick / 2.5});
  const auto& world = simulation.world();
  for (std::size_t g = 0; g < usual_muscle_count; ++g) {
    const auto group = static_cast<Muscle>(g);
    EXPECT_EQ(world.get<Substeps>(simulation.muscle(explicitly, group, Side::left)), 20U);
    EXPECT_EQ(world.get<Substeps>(simulation.muscle(hardly_less, group, Side::left)), 21U);
    EXPECT_EQ(world.get<SolvedSteps>(simulation.muscle(once, group, Side::left)), 1U);
    EXPECT_EQ(world.get<SolvedSteps>(simulation.muscle(long_ones, group, Side::left)), 1U);
    EXPECT_EQ(world.get<SolvedSteps>(simulation.muscle(thrice, group, Side::left)), 3U);
  }
}

TEST(Steps, AboveTheLimitAreRefusedByName) {
  for (const Method method : {Method::explicit_central, Method::implicit_central}) {
    Simulation simulation(sharing());
    const Entity other = join_with(simulation, sample_person(1), {.method = method});
    const Entity probe = join_with(simulation, sample_person(2), {.method = method});
    std::array<double, usual_muscle_count> limit{};
    for (std::size_t g = 0; g < usual_muscle_count; ++g) {
      limit[g] = limit_of(simulation, simulation.muscle(probe, static_cast<Muscle>(g), Side::right));
    }
    EXPECT_EQ(simulation.set_muscles(probe, std::nullopt), Status::ok);
    const std::size_t lowest = static_cast<std::size_t>(std::min_element(limit.begin(), limit.end()) - limit.begin());
    const auto before = hash_world(simulation);
    const auto refused = simulation.set_muscles(probe, {.method = method, .dt_s = limit[lowest] * 1.0001});
    ASSERT_FALSE(refused);
    const std::string& message = refused.error().message;
    EXPECT_NE(message.find(muscle_name(static_cast<Muscle>(lowest))), std::string::npos) << message;
    char number[32];
    std::snprintf(number, sizeof number, "%.6g", limit[lowest]);
    EXPECT_NE(message.find(number), std::string::npos) << message << " " << number;
    EXPECT_EQ(message.find('\n'), std::string::npos);
    EXPECT_TRUE(is_refused(simulation.set_muscles(other, {.method = method, .dt_s = 0.1}), "critical step"));
    EXPECT_EQ(hash_world(simulation), before);
    EXPECT_TRUE(simulation.set_muscles(probe, {.method = method, .dt_s = limit[lowest] * 0.9999}));
  }
}

// ---------------------------------------------------------------------------------------------------------- inertia

double size(const Vec3<float>& v) {
  return std::hypot(static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z));
}

TEST(Inertia, StartsAsInAWalkInProgress) {
  for (const float speed : {0.7F, 1.5F}) {
    Simulation simulation(sharing());
    const Entity person = join_with(simulation, {{}, {.speed_m_s = speed}}, {.inertia = true});
    double first = 0, most = 0;
    for (int i = 0; i < 150; ++i) {
      simulation.tick();
      for (const Entity muscle : muscles_of(simulation, person)) {
        const auto load = *simulation.get<FrameLoad>(muscle);
        most = std::max(most, size(load.constant_to));
        if (i < 3) first = std::max(first, size(load.constant_to));
      }
    }
    EXPECT_LE(first, most);
    EXPECT_LT(most, 9.81 + 40);
    EXPECT_GT(most, 9.81 + 1);
  }
}

TEST(Inertia, LoadsMatchTheShanksRotation) {
  Simulation simulation(sharing());
  const Entity person = join_with(simulation, {{}, {.speed_m_s = 1.4F}}, {.method = Method::statics, .inertia = true});
  for (const Side side : {Side::right, Side::left}) {
    double turning = 0, swinging = 0;  // ω² and α times 0.4 m
    for (int i = 0; i < 90; ++i) {
      simulation.tick();
      const Entity muscle = simulation.muscle(person, Muscle::triceps_surae, side);
      const auto g = simulation.get<FrameLoad>(muscle)->gradient_to;
      turning = std::max(turning, 0.4 * static_cast<double>(g.x.x + g.y.y + g.z.z) / 2);
      swinging = std::max(swinging, 0.2 * size({g.z.y - g.y.z, g.x.z - g.z.x, g.y.x - g.x.y}));
    }
    EXPECT_GT(turning, 6);
    EXPECT_LT(turning, 25);
    EXPECT_GT(swinging, 12);
    EXPECT_LT(swinging, 60);
  }
}

TEST(Inertia, TenSecondsStayWithinAFewCentimetres) {
  MOBIL_SLOW();
  for (const Method method : methods) {
    Simulation simulation(sharing());
    const SamplePerson p = {{}, {.speed_m_s = 1.5F}};
    const Entity with = join_with(simulation, p, {.method = method, .inertia = true}),
                 without = join_with(simulation, p, {.method = method});
    Difference d;
    for (int i = 0; i < 600; ++i) {
      simulation.tick();
      if (i % 3 == 0) compare(simulation, with, simulation, without, d);
    }
    EXPECT_GT(d.apart, 0.004) << name(method);
    EXPECT_LT(d.apart, 0.045) << name(method);
  }
}

// ------------------------------------------------------------------------------------------------- a choice as words

TEST(LegMusclesWords, EachBelongsToAFieldAndRoundTrips) {
  const LegMuscles usual;
  const LegMusclesWords words = leg_muscles_words(usual);
  EXPECT_EQ(choice_of(words), usual);
  std::size_t changed = 0;
  for (std::size_t i = 0; i < words.size(); ++i) {
    LegMusclesWords other = words;
    other[i] ^= 1;
    const auto choice = choice_of(other);
    ASSERT_TRUE(choice) << i;
    if (leg_muscles_words(*choice) != other) continue;  // an unset number has no effect
    ++changed;
    EXPECT_NE(*choice, usual) << i;
    EXPECT_NE(hash_of(*choice), hash_of(usual)) << i;
  }
  EXPECT_EQ(changed, words.size() - 2);  // foundation and step are unset
}

TEST(LegMusclesWords, InvalidWordsAreRefused) {
  const LegMusclesWords words = leg_muscles_words({});
  std::size_t refused = 0;
  for (std::size_t i = 0; i < words.size(); ++i) {
    LegMusclesWords other = words;
    other[i] = ~std::uint64_t{0};
    refused += choice_of(other) ? 0 : 1;
  }
  EXPECT_EQ(refused, words.size() - 7);  // seven doubles
}

}  // namespace mobil::leg_muscles_test
