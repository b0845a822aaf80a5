// Muscles at finite strain in walking people: volume, position, fibres, limits, snapshots.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <mobil/components/activation.h>
#include <mobil/engine/world.h>
#include <mobil/step_report.h>
#include "assets/fem/finite_element.h"
#include "tests/labels.h"
#include "tests/refused.h"
#include "tests/simulation/leg_muscles.h"

MOBIL_TEST_LABELS("long");

namespace mobil::finite_method_test {
namespace {

LegMuscles close_up(ExcitationSource source = ExcitationSource::phase) {
  LegMuscles choice;
  choice.method = Method::finite;
  choice.cells = close_up_cells;
  choice.activation = source;
  choice.inertia = true;
  choice.muscles = MuscleSet(0b0110);  // quadriceps and triceps surae: shared data takes a second a muscle
  return choice;
}

/// Three people walk for two seconds; the heaviest makes the longest steps.
TEST(FiniteMethod, KeepsItsVolumeAndLineInAWalk) {
  Simulation simulation(sharing());
  std::vector<Entity> people;
  for (int i = 0; i < 3; ++i) people.push_back(join_with(simulation, sample_person(i), close_up()));
  float least = 1, most = 1, farthest = 0;
  for (int tick = 0; tick < 120; ++tick) {
    simulation.tick();
    for (const Entity person : people) {
      for (const Entity muscle : muscles_of(simulation, person)) {
        const BellyReport<float> report = *simulation.get<BellyReport>(muscle);
        least = std::min(least, report.volume_ratio), most = std::max(most, report.volume_ratio);
        const auto u = displacement(simulation, muscle);
        for (std::size_t i = 0; i < u.size(); ++i) {
          if (i % 3 != 2) farthest = std::max(farthest, std::abs(u[i]));
        }
      }
    }
  }
  EXPECT_EQ(simulation.report().total_restarted_bellies, 0U);
  EXPECT_GT(least, 0.96F);
  EXPECT_LT(most, 1.04F);
  EXPECT_LT(farthest, 0.025F) << "sideways";
}

/// Compares with the static tables of finite shapes: standing, relaxed and active, once at rest.
TEST(FiniteMethod, StandingShapeMatchesTheTables) {
  for (const float pull : {0.02F, 0.5F}) {
    Simulation simulation(sharing());
    std::vector<Entity> people;
    for (const Method method : {Method::finite, Method::modal}) {
      people.push_back(*simulation.spawn_posed({}));
      LegMuscles choice = close_up(ExcitationSource::host);
      choice.inertia = false;
      choice.method = method;
      ASSERT_TRUE(simulation.set_muscles(people.back(), choice));
      for (const MuscleRef& own : simulation.muscles(people.back())) {
        for (const Side side : {Side::right, Side::left})
          ASSERT_TRUE(simulation.set_excitation(people.back(), own.muscle, side, pull));
      }
    }
    simulation.tick(150);
    const auto finite = muscles_of(simulation, people[0]), tabled = muscles_of(simulation, people[1]);
    for (std::size_t m = 0; m < finite.size(); ++m) {
      const auto one = displacement(simulation, finite[m]), other = displacement(simulation, tabled[m]);
      ASSERT_EQ(one.size(), other.size());
      double off = 0, all = 0;
      for (std::size_t i = 0; i < one.size(); ++i) {
        off += std::pow(double{one[i]} - double{other[i]}, 2) / static_cast<double>(one.size());
        all += std::pow(double{other[i]}, 2) / static_cast<double>(one.size());
      }
      EXPECT_LT(std::sqrt(off), 5e-4 + 0.1 * std::sqrt(all)) << "muscle " << m << " pulling " << pull;
      if (pull > 0.1F) {
        EXPECT_GT(std::sqrt(all), 5e-4) << "muscle " << m;
      }
    }
  }
}

/// Returns the area of the middle section, seen along the muscle, m².
double middle_area(const Simulation& simulation, Entity muscle) {
  const auto& shape = *simulation.world().shared<MuscleTemplate>(muscle);
  const auto u = displacement(simulation, muscle);
  const HexahedralMesh own = scaled(shape.mesh, *simulation.get<BellyScale>(muscle));
  return section_areas(own, {u.begin(), u.end()})[own.cells[2] / 2];
}

TEST(FiniteMethod, ActiveFibresPullAtTheEndAndThicken) {
  Simulation simulation(sharing());
  const Entity person = *simulation.spawn_posed({});
  ASSERT_TRUE(simulation.set_muscles(person, close_up(ExcitationSource::host)));
  const Entity muscle = simulation.muscle(person, Muscle::triceps_surae, Side::right);
  const auto pull = [&](float how_hard) {
    ASSERT_TRUE(simulation.set_excitation(person, Muscle::triceps_surae, Side::right, how_hard));
    simulation.tick(120);
  };
  pull(0.01F);
  const float slack_n = simulation.get<BellyReport>(muscle)->reaction_n;
  const double slack_m2 = middle_area(simulation, muscle);
  pull(0.8F);
  EXPECT_GT(simulation.get<BellyReport>(muscle)->reaction_n, slack_n + 10);
  EXPECT_GT(middle_area(simulation, muscle), 1.01 * slack_m2);
}

TEST(FiniteMethod, RefusesUnsupportedOptions) {
  Simulation simulation(sharing());
  const Entity person = *simulation.spawn_posed({});
  LegMuscles choice = close_up();
  choice.stiffness_damping_s = 1e-3;
  EXPECT_TRUE(is_refused(simulation.set_muscles(person, choice), "stiffness_damping_s"));
  choice = close_up();
  choice.dt_s = 0.004;
  EXPECT_TRUE(is_refused(simulation.set_muscles(person, choice), "critical step"));
  EXPECT_TRUE(simulation.muscles(person).empty());
}

}  // namespace
}  // namespace mobil::finite_method_test
