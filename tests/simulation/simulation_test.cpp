// The facade: bodies and gaits of all kinds, effects that are added and removed without a trace, time, memory.
#include <mobil/components/step_plan.h>
#include <mobil/engine/world.h>
#include <mobil/simulation.h>
#include <mobil/systems/muscles/person.h>
#include <mobil/systems/surfaces/nodal_view.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/engine/engine_counting_memory.h"
#include "tests/labels.h"
#include "tests/refused.h"
#include "tests/simulation/people.h"
#include "tests/simulation/simulation_hash.h"

MOBIL_TEST_LABELS("threads");

namespace mobil::simulation_test {
// ------------------------------------------------------------------------------------------------------- physics

double length(const Vec3<float>& a, const Vec3<float>& b) {
  return std::hypot(static_cast<double>(a.x) - static_cast<double>(b.x),
                    static_cast<double>(a.y) - static_cast<double>(b.y),
                    static_cast<double>(a.z) - static_cast<double>(b.z));
}

/// Returns the angle between two rotations, rad.
double turn(const Quat<float>& a, const Quat<float>& b) {
  const auto d = [](float x, float y) { return static_cast<double>(x) * static_cast<double>(y); };
  const double dot = std::abs(d(a.x, b.x) + d(a.y, b.y) + d(a.z, b.z) + d(a.w, b.w));
  return 2 * std::acos(std::min(1.0, dot));
}

void check_muscles(const Simulation& simulation, const Person& person) {
  for (const auto& own : person.muscles) {
    for (const Entity muscle : own.entity) {
      const auto line = *simulation.get<LineOfAction>(muscle);
      const auto report = *simulation.get<BellyReport>(muscle);
      const double asked = static_cast<double>(line.length_m) - static_cast<double>(line.rest_length_m);
      RC_ASSERT(std::abs(static_cast<double>(report.elongation_m) - asked) < 1e-5);
      RC_ASSERT(report.volume_ratio > 0.5F && report.volume_ratio < 1.7F);
      RC_ASSERT(report.kinetic_energy_j >= 0 && report.kinetic_energy_j < 15);
      // (The strain energy of explicit steps is evaluated between two steps, and is below 0 if displacements change
      // their sign in between. Only the sum of both energies is positive.)
      RC_ASSERT(report.strain_energy_j + report.kinetic_energy_j > -0.01F && report.strain_energy_j < 20);
      RC_ASSERT(std::isfinite(report.reaction_n) && std::abs(report.reaction_n) < 2000);
      const NodalView nodes = nodal_displacement(simulation.world(), muscle);
      for (std::size_t i = 0; i < 3 * std::size_t{nodes.nodes}; ++i) {
        RC_ASSERT(std::abs(nodes.first[i * lane_count]) < 0.5F);  // not true of NaN
      }
    }
  }
}

/// Checks three poses a tick apart. With extreme styles feet turn by 70° in a tick.
void check_step(const Pose<float>& first, const Pose<float>& before, const Pose<float>& now, const Gait<float>& gait) {
  const double furthest = (8 * static_cast<double>(gait.speed_m_s) + 10) / 60;
  for (std::size_t s = 0; s < segment_count; ++s) {
    const auto &a = first.position_m[s], &b = before.position_m[s], &c = now.position_m[s];
    RC_ASSERT(length(b, c) < furthest);
    RC_ASSERT(length({2 * b.x - a.x, 2 * b.y - a.y, 2 * b.z - a.z}, c) < 0.4);
    RC_ASSERT(turn(before.rotation[s], now.rotation[s]) < 2.2);
    const auto& q = now.rotation[s];
    RC_ASSERT(std::abs(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w - 1) < 1e-4F);
  }
}

/// Returns a person within the ranges of body and gait. Some of them cannot walk as requested.
SamplePerson any_person() {
  const auto uniform = [](double low, double high) {
    return static_cast<float>(low +
                              (high - low) * *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, 10001)) / 10000.0);
  };
  SamplePerson p;
  p.body.height_m = uniform(1.2, 2.2);
  p.body.mass_kg = living_mass(p.body.height_m, static_cast<double>(uniform(0, 1)));
  p.body.biotype = {uniform(0.1, 12), uniform(0.1, 12), uniform(0.1, 12)};
  p.body.constitution = static_cast<Constitution>(*rc::gen::inRange(0, 4));
  p.gait.speed_m_s = uniform(0.4, 2.2);
  if (*rc::gen::arbitrary<bool>()) p.gait.step_length_m = uniform(0.3, 1);
  for (const GaitParameter& parameter : gait_parameters) {
    if (*rc::gen::inRange(0, 4) != 0) continue;
    const float usual = p.gait.style.*parameter.value;
    const float part = uniform(-0.4, 0.4);
    p.gait.style.*parameter.value = usual + part * (part > 0 ? parameter.high - usual : usual - parameter.low);
  }
  return p;
}

TEST(Simulation, BodiesOfAllKindsWalkAndTheirMusclesFollow) {
  Simulation simulation(sharing());  // templates are made once
  EXPECT_TRUE(rc::check("walks", [&] {
    const SamplePerson p = any_person();
    const auto person = simulation.spawn(p.body, p.gait);
    RC_PRE(person.has_value());
    const auto added = simulation.set_muscles(*person);
    if (!added) RC_FAIL(added.error().message);
    const bool clamped = simulation.get<StepPlan>(*person)->clamped != 0;  // reported as impossible gait
    Pose<float> first = *simulation.get<Pose>(*person), before = first;
    for (int i = 0; i < 90; ++i) {
      simulation.tick();
      const Pose<float> now = *simulation.get<Pose>(*person);
      if (i > 0 && !clamped) check_step(first, before, now, simulation.person(*person)->gait);
      check_muscles(simulation, *simulation.person(*person));
      first = before;
      before = now;
    }
    RC_ASSERT(simulation.despawn(*person) == Status::ok);
  }));
}

TEST(Simulation, PulledBellyStaysFiniteAndLagsItsLine) {
  Simulation simulation(sharing());
  for (const int who : {0, 7, 19}) {
    const auto person = *simulation.spawn(sample_person(who).body, sample_person(who).gait);
    ASSERT_TRUE(simulation.set_muscles(person, {.drive = Drive::force}));
    double asked = 0, missed = 0;
    for (int i = 0; i < 300; ++i) {
      simulation.tick();
      for (const auto& own : simulation.muscles(person)) {
        for (const Entity muscle : own.entity) {
          const auto line = *simulation.get<LineOfAction>(muscle);
          const auto report = *simulation.get<BellyReport>(muscle);
          const double change = static_cast<double>(line.length_m) - static_cast<double>(line.rest_length_m);
          ASSERT_TRUE(std::isfinite(report.elongation_m));
          asked = std::max(asked, std::abs(change));
          missed = std::max(missed, std::abs(static_cast<double>(report.elongation_m) - change));
          EXPECT_GT(report.volume_ratio, 0.5F);
          EXPECT_LT(report.volume_ratio, 1.6F);
        }
      }
    }
    EXPECT_GT(missed, 0.02 * asked);  // the elongation is not simply prescribed
    EXPECT_LT(missed, 2 * asked);
    EXPECT_EQ(simulation.despawn(person), Status::ok);
  }
}

// ------------------------------------------------------------------------------------------------------- effects

TEST(Effects, EveryBodyInRangeGetsMuscles) {
  Simulation simulation(sharing());
  for (const float height : {1.2F, 2.2F}) {
    for (const float mass : {living_mass(height, 0), living_mass(height, 1)}) {
      for (const float meso : {0.1F, 12.0F}) {
        for (const auto build :
             {Constitution::thin, Constitution::average, Constitution::athletic, Constitution::heavy}) {
          const auto person = simulation.spawn({height, mass, {3, meso, 3}, build}, {.speed_m_s = 1.1F});
          ASSERT_TRUE(person) << person.error().message;
          const auto added = simulation.set_muscles(*person);
          EXPECT_TRUE(added) << added.error().message;
        }
      }
    }
  }
}

TEST(Effects, MusclesAreAddedAndRemovedWithTheirRows) {
  Simulation simulation(sharing());
  const Entity person = join(simulation, sample_person(0), false);
  const Entity other = join(simulation, sample_person(1), false);
  EXPECT_EQ(rows(simulation.world()), 2U);
  EXPECT_EQ(rows_with<BellyReport>(simulation.world()), 0U);
  simulation.tick();
  for (int round = 0; round < 3; ++round) {
    ASSERT_TRUE(simulation.set_muscles(person));
    EXPECT_EQ(rows_with<BellyReport>(simulation.world()), 2 * usual_muscle_count);
    EXPECT_EQ(rows_with<Pose>(simulation.world()), 2U);
    std::vector<Entity> muscles;
    for (const auto& own : simulation.muscles(person))
      muscles.insert(muscles.end(), own.entity.begin(), own.entity.end());
    for (const Entity muscle : muscles) {
      EXPECT_TRUE(simulation.world().alive(muscle));
      EXPECT_EQ(simulation.get<MuscleOwner>(muscle)->index, person.index);
      EXPECT_EQ(nodal_displacement(simulation.world(), muscle).nodes, 81U);
    }
    EXPECT_FALSE(simulation.world().alive(simulation.muscle(other, Muscle::quadriceps, Side::left)));
    simulation.tick();
    EXPECT_EQ(simulation.set_muscles(person, std::nullopt), Status::ok);
    EXPECT_EQ(rows(simulation.world()), 2U);
    EXPECT_EQ(rows_with<BellyReport>(simulation.world()) + rows_with<LineOfAction>(simulation.world()), 0U);
    for (const Entity muscle : muscles) {
      EXPECT_EQ(simulation.get<LineOfAction>(muscle).error(), Status::stale_entity);
      EXPECT_EQ(nodal_displacement(simulation.world(), muscle).first, nullptr);
    }
    EXPECT_TRUE(simulation.person(person)->muscles.empty());
    simulation.tick();
  }
}

TEST(Effects, MusclesDoNotChangeTheGait) {
  Simulation simulation(sharing());
  const Entity with = join(simulation, sample_person(5)), without = join(simulation, sample_person(5), false);
  for (int i = 0; i < 40; ++i) simulation.tick();
  EXPECT_EQ(hash_row(simulation.world(), with, 1), hash_row(simulation.world(), without, 1));
  ASSERT_TRUE(simulation.set_muscles(without));  // in mid-stride
  for (int i = 0; i < 40; ++i) simulation.tick();
  EXPECT_EQ(hash_row(simulation.world(), with, 1), hash_row(simulation.world(), without, 1));
}

TEST(Effects, RepeatedRequestChangesNothing) {
  Simulation simulation(sharing());
  const Entity person = join(simulation, sample_person(2));
  for (int i = 0; i < 10; ++i) simulation.tick();
  const auto before = hash_world(simulation);
  ASSERT_TRUE(simulation.set_muscles(person, simulation.person(person)->leg_muscles));
  EXPECT_EQ(hash_world(simulation), before);
}

TEST(Effects, BadMaterialIsAnErrorAndChangesNothing) {
  Simulation simulation(sharing());
  const Entity person = join(simulation, sample_person(2), false);
  const auto before = hash_world(simulation);
  for (const Material& bad : {Material{1000, 1e4, 0.5}, Material{0, 1e4, 0.3}, Material{1000, NAN, 0.3},
                              Material{1000, 1e4, -1}, Material{INFINITY, 1e4, 0.3}}) {
    EXPECT_FALSE(simulation.set_muscles(person, {.material = bad}));
    EXPECT_EQ(hash_world(simulation), before);
  }
  EXPECT_TRUE(simulation.set_muscles(person));
}

TEST(Handles, OfDespawnedPeopleAreStaleEverywhere) {
  Simulation simulation(sharing());
  const Entity person = join(simulation, sample_person(0)), other = join(simulation, sample_person(1));
  const Entity muscle = simulation.muscle(person, Muscle::hamstrings, Side::right);
  const auto before = hash_person(simulation, other);
  ASSERT_EQ(simulation.despawn(person), Status::ok);
  EXPECT_EQ(rows(simulation.world()), 1 + 2 * usual_muscle_count);
  EXPECT_EQ(hash_person(simulation, other), before);
  const Entity next = join(simulation, sample_person(2));  // reuses the first one's index
  for (const Entity gone : {person, Entity{}, Entity{~0U, 1}}) {
    EXPECT_EQ(simulation.despawn(gone), Status::stale_entity);
    EXPECT_EQ(simulation.set_muscles(gone, std::nullopt), Status::stale_entity);
    EXPECT_FALSE(simulation.set_muscles(gone));
    EXPECT_FALSE(simulation.person(gone));
    EXPECT_EQ(simulation.get<Pose>(gone).error(), Status::stale_entity);
    EXPECT_FALSE(simulation.world().alive(simulation.muscle(gone, Muscle::hamstrings, Side::right)));
  }
  EXPECT_EQ(simulation.get<BellyReport>(muscle).error(), Status::stale_entity);
  EXPECT_EQ(nodal_displacement(simulation.world(), muscle).first, nullptr);
  EXPECT_FALSE(simulation.person(muscle));
  // A live muscle is not a person.
  const Entity alive = simulation.muscle(next, Muscle::hamstrings, Side::left);
  ASSERT_TRUE(simulation.world().alive(alive));
  EXPECT_FALSE(simulation.person(alive));
  EXPECT_EQ(simulation.despawn(alive), Status::stale_entity);
  EXPECT_TRUE(simulation.world().alive(alive));
}

TEST(Handles, BadSpawnsChangeNothing) {
  Simulation simulation(sharing());
  join(simulation, sample_person(0));
  const auto before = hash_world(simulation);
  const std::size_t tables = simulation.world().tables().size();
  const SamplePerson bad[] = {{{.height_m = 0}, {}},
                              {{.height_m = NAN}, {}},
                              {{.mass_kg = 5}, {}},
                              {{.biotype = {-1, 3, 3}}, {}},
                              {{.constitution = static_cast<Constitution>(9)}, {}},
                              {{}, {.speed_m_s = 9.0F}},
                              {{}, {.speed_m_s = NAN}},
                              {{}, {.speed_m_s = 1.4F, .step_length_m = 0.7F, .step_frequency_hz = 3.0F}},
                              {{}, {.style = {.swing_knee_deg = 500}}}};
  for (const SamplePerson& p : bad) {
    EXPECT_TRUE(is_refused(simulation.spawn(p.body, p.gait)));
    EXPECT_EQ(hash_world(simulation), before);
    EXPECT_EQ(simulation.world().tables().size(), tables);
  }
}

// ------------------------------------------------------------------------------------------------ time and memory

TEST(Time, AdvanceRunsWholeTicksAndReportsTheRest) {
  Simulation simulation(sharing());
  const Entity person = join(simulation, sample_person(0), false);
  EXPECT_EQ(simulation.advance(0.5 / 60).count, 0U);
  Ticks ticks = simulation.advance(1.0 / 60);
  EXPECT_EQ(ticks.count, 1U);
  EXPECT_NEAR(ticks.alpha, 0.5, 1e-9);
  EXPECT_EQ(simulation.ticks(), 1U);
  ticks = simulation.advance(3);  // a hitch
  EXPECT_NEAR(ticks.dropped_s, 2.75, 1e-9);
  EXPECT_EQ(ticks.count, 15U);
  EXPECT_EQ(simulation.ticks(), 16U);
  EXPECT_NEAR(simulation.time_s(), 16.0 / 60, 1e-9);
  const auto before = hash_world(simulation);
  for (const double bad : {-1.0, static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
    EXPECT_FALSE(simulation.advance(bad).valid);
    EXPECT_EQ(hash_world(simulation), before);
  }
  Simulation ticked(sharing());
  const Entity same = join(ticked, sample_person(0), false);
  for (int i = 0; i < 16; ++i) ticked.tick();
  EXPECT_EQ(hash_person(simulation, person), hash_person(ticked, same));
  EXPECT_THROW(Simulation({.tick_s = 0}), std::invalid_argument);
  EXPECT_THROW(Simulation({.max_frame_s = NAN}), std::invalid_argument);
}

}  // namespace mobil::simulation_test
