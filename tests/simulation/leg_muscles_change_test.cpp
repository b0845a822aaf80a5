// Changes of leg muscles while walking.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <mobil/engine/world.h>
#include <mobil/muscle_table.h>
#include <mobil/systems/muscles/person.h>
#include <mobil/systems/surfaces/nodal_view.h>
#include "assets/fem/belly_solver.h"
#include "assets/fem/muscle_template.h"
#include "tests/labels.h"
#include "tests/refused.h"
#include "tests/simulation/leg_muscles.h"

MOBIL_TEST_LABELS("threads;long");

namespace mobil::leg_muscles_change_test {
TEST(Change, MaterialRecomputesStepsAndKeepsTheState) {
  for (const Method method : methods) {
    Simulation simulation(sharing());
    const Entity person = join_with(simulation, sample_person(6), {.method = method});
    for (int i = 0; i < 30; ++i) simulation.tick();
    const auto muscles = muscles_of(simulation, person);
    std::uint64_t steps_before = 0;
    for (const double young : {4e4, 2e5, 5e3}) {
      std::vector<std::vector<float>> before;
      for (const Entity muscle : muscles) before.push_back(displacement(simulation, muscle));
      const auto changed = simulation.set_muscles(person, {.method = method, .material = {1000, young, 0.4}});
      ASSERT_TRUE(changed) << changed.error().message;
      EXPECT_EQ(muscles_of(simulation, person), muscles);
      for (std::size_t m = 0; m < muscles.size(); ++m) EXPECT_EQ(displacement(simulation, muscles[m]), before[m]);
      for (const Entity muscle : muscles) {
        EXPECT_EQ(simulation.world().shared<MuscleTemplate>(muscle)->material.young_pa, young);
        const auto n = method == Method::explicit_central ? simulation.world().get<Substeps>(muscle)
                                                          : simulation.world().get<SolvedSteps>(muscle);
        if (method == Method::explicit_central || method == Method::implicit_central) {
          EXPECT_LE(simulation.tick_s() / static_cast<double>(*n), 0.9 * limit_of(simulation, muscle) * (1 + 1e-9));
        }
      }
      if (method == Method::explicit_central) {
        const auto n = *simulation.world().get<Substeps>(muscles[0]);
        EXPECT_NE(n, steps_before);
        steps_before = n;
      }
      for (int i = 0; i < 20; ++i) {
        simulation.tick();
        Difference d;
        compare(simulation, person, simulation, person, d);
        EXPECT_LT(d.most, 0.12) << name(method) << " " << young;
      }
    }
  }
}

bool operator==(const std::vector<ComponentId>& a, const Archetype& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

std::vector<ComponentId> key_of(const Simulation& simulation, Entity entity) {
  const auto& key = simulation.world().find(entity).table->key();
  return {key.begin(), key.end()};
}

TEST(Change, MethodKeepsHandlesAndShapesWithoutLeftovers) {
  Simulation simulation(sharing());
  const Entity person = join_with(simulation, sample_person(9), {});
  for (int i = 0; i < 20; ++i) simulation.tick();
  const auto muscles = muscles_of(simulation, person);
  const auto key = key_of(simulation, muscles[0]);
  const auto& world = simulation.world();
  for (const bool inertia : {true, false}) {
    for (const Method method : {Method::newmark, Method::statics, Method::implicit_central, Method::explicit_central}) {
      const auto before = displacement(simulation, muscles[3]);
      ASSERT_TRUE(simulation.set_muscles(person, {.method = method, .inertia = inertia}));
      EXPECT_EQ(simulation.person(person)->leg_muscles.method, method);
      EXPECT_EQ(muscles_of(simulation, person), muscles);
      EXPECT_EQ(displacement(simulation, muscles[3]), before);
      EXPECT_EQ(rows(world), 1 + 2 * usual_muscle_count);
      for (const Entity muscle : muscles) {
        EXPECT_EQ(world.has<Substeps>(muscle), method == Method::explicit_central);
        EXPECT_EQ(world.has<SolvedSteps>(muscle), method == Method::implicit_central || method == Method::newmark);
        EXPECT_EQ(world.has<StaticSteps>(muscle), method == Method::statics);
        EXPECT_EQ(world.has<NodalVelocity>(muscle), method != Method::statics);
        EXPECT_EQ(world.has<BellySolver>(muscle), method != Method::explicit_central);
        EXPECT_EQ(world.has<FrameLoad>(muscle), inertia);
        EXPECT_EQ(world.has<FrameHistory>(muscle), inertia);
      }
      for (int i = 0; i < 15; ++i) simulation.tick();
      Difference d;
      compare(simulation, person, simulation, person, d);
      EXPECT_LT(d.most, 0.12);
    }
  }
  EXPECT_TRUE(key == world.find(muscles[0]).table->key());
  EXPECT_EQ(rows_with<FrameLoad>(world) + rows_with<FrameHistory>(world), 0U);
  ASSERT_TRUE(simulation.set_muscles(person, {.drive = Drive::force, .cells = {1, 1, 4}}));
  EXPECT_EQ(world.get<FarEnd>(muscles[0]), static_cast<std::uint64_t>(FarEnd::sliding));
  EXPECT_EQ(nodal_displacement(simulation.world(), muscles[0]).nodes, 20U);
  for (int i = 0; i < 15; ++i) simulation.tick();
  EXPECT_EQ(simulation.set_muscles(person, std::nullopt), Status::ok);
  EXPECT_EQ(rows(world), 1U);
}

/// The drive's quantity changes from newtons to metres, or the other way round.
TEST(Change, DriveKeepsTheBellyInPlace) {
  const LegMuscles pulled{.drive = Drive::force}, drawn{}, pulls{.activation = ExcitationSource::phase},
      close{.method = Method::finite}, pulled_close{.drive = Drive::force, .method = Method::finite};
  const std::array<std::array<LegMuscles, 2>, 6> ways = {{{pulled, pulls},
                                                          {pulled, close},
                                                          {pulled_close, drawn},
                                                          {pulls, pulled},
                                                          {close, pulled},
                                                          {drawn, pulled_close}}};
  for (std::size_t way = 0; way < ways.size(); ++way) {
    Simulation simulation(sharing());
    const Entity person = join_with(simulation, sample_person(9), ways[way][0]);
    for (int i = 0; i < 40; ++i) simulation.tick();
    ASSERT_TRUE(simulation.set_muscles(person, ways[way][1]));
    for (int i = 0; i < 30; ++i) {
      simulation.tick();
      float most = 0, fastest = 0;
      for (const Entity muscle : muscles_of(simulation, person)) {
        for (const float at_m : displacement(simulation, muscle)) most = std::max(most, std::abs(at_m));
        std::vector<float> velocity(simulation.world().get<NodalVelocity>(muscle).value_or(0));
        simulation.world().get_field<NodalVelocity>(muscle, velocity);
        for (const float m_s : velocity) fastest = std::max(fastest, std::abs(m_s));
      }
      EXPECT_LT(most, 0.15F) << way << " " << i;
      EXPECT_LT(fastest, 6.5F) << way << " " << i;
    }
  }
}

TEST(Change, RefusedChangeChangesNothing) {
  Simulation simulation(sharing());
  const Entity person = join_with(simulation, sample_person(9), {.inertia = true}),
               bare = join(simulation, sample_person(1), false);
  for (int i = 0; i < 20; ++i) simulation.tick();
  const auto before = hash_world(simulation);
  const std::size_t tables = simulation.world().tables().size();
  const LegMuscles bad[] = {{.drive = static_cast<Drive>(7)},
                            {.method = static_cast<Method>(9)},
                            {.element = static_cast<Element>(4)},
                            {.mass = static_cast<Mass>(2)},
                            {.material = {1000, -1, 0.3}},
                            {.damping_per_s = -1},
                            {.damping_per_s = NAN},
                            {.stiffness_damping_s = 2},
                            {.foundation_hz = -3.0},
                            {.foundation_hz = 1e9},
                            {.cells = {0, 2, 2}},
                            {.cells = {300, 2, 2}},
                            {.dt_s = 0.0},
                            {.dt_s = -1.0},
                            {.dt_s = NAN},
                            {.dt_s = INFINITY},
                            {.method = Method::newmark, .dt_s = 1e-12}};
  for (const LegMuscles& choice : bad) {
    const auto changed = simulation.set_muscles(person, choice);
    ASSERT_FALSE(changed);
    EXPECT_TRUE(changed.error().message.starts_with("set_muscles: ")) << changed.error().message;
    EXPECT_EQ(changed.error().message.find('\n'), std::string::npos) << changed.error().message;
    EXPECT_FALSE(simulation.set_muscles(bare, choice));
    EXPECT_EQ(hash_world(simulation), before) << changed.error().message;
  }
  EXPECT_FALSE(simulation.set_muscles(Entity{}, {}));
  EXPECT_EQ(simulation.world().tables().size(), tables);
  EXPECT_TRUE(simulation.person(person)->leg_muscles.inertia);
}

TEST(ChangingMuscles, AddsNewOnesAndKeepsExistingOnesMoving) {
  Simulation simulation(sharing());
  const Entity person = join_with(simulation, sample_person(3), {});
  for (int i = 0; i < 30; ++i) simulation.tick();
  const Entity stays = simulation.muscle(person, Muscle::hamstrings, Side::left),
               goes = simulation.muscle(person, Muscle::quadriceps, Side::right);
  const auto before = displacement(simulation, stays);

  const Muscle soleus = find_muscle("soleus").value();
  LegMuscles choice;
  choice.muscles = 0;
  choice.muscles.set(static_cast<std::size_t>(Muscle::hamstrings)).set(static_cast<std::size_t>(soleus));
  ASSERT_TRUE(simulation.set_muscles(person, choice));
  EXPECT_EQ(simulation.muscle(person, Muscle::hamstrings, Side::left), stays);
  EXPECT_EQ(displacement(simulation, stays), before);
  EXPECT_FALSE(simulation.world().alive(goes));
  EXPECT_EQ(simulation.person(person)->muscles.size(), 2U);
  EXPECT_EQ(rows(simulation.world()), 5U);
  simulation.tick();
  const auto line = *simulation.get<LineOfAction>(simulation.muscle(person, soleus, Side::right));
  const auto belly = *simulation.get<BellyReport>(simulation.muscle(person, soleus, Side::right));
  EXPECT_NEAR(belly.elongation_m, line.length_m - line.rest_length_m, 1e-6F);

  const auto hash = hash_world(simulation);
  for (const unsigned long long none_or_beyond : {0ULL, 1ULL << muscle_count}) {
    choice.muscles = none_or_beyond;
    EXPECT_TRUE(is_refused(simulation.set_muscles(person, choice), "usual_muscles()"));
    EXPECT_EQ(hash_world(simulation), hash);
  }
}

}  // namespace mobil::leg_muscles_change_test
