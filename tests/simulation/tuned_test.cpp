// Bellies stiffened and damped by tension, in people.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <mobil/components/activation.h>
#include <mobil/engine/world.h>
#include <mobil/systems/surfaces/nodal_view.h>
#include "systems/deformation/belly_motion.h"
#include "tests/labels.h"
#include "tests/refused.h"
#include "tests/simulation/leg_muscles.h"
#include "tests/simulation/people.h"

MOBIL_TEST_LABELS("long");

namespace mobil::tuned_people_test {
namespace {

LegMuscles pulling(bool tuned, bool inertia = true) {
  LegMuscles choice;
  choice.method = Method::modal;
  choice.modal.cells = {4, 4, 16};
  choice.modal.tuned = tuned;
  choice.activation = ExcitationSource::phase;
  choice.inertia = inertia;
  choice.muscles = MuscleSet(3);
  return choice;
}

void run(Simulation& simulation, int ticks) {
  for (int i = 0; i < ticks; ++i) simulation.tick();
}

double apart(const std::vector<float>& a, const std::vector<float>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(double{a[i]} - double{b[i]}));
  return most;
}

TEST(TunedPeople, WithoutActivationItIsRefused) {
  Simulation simulation(sharing());
  const Entity person = *simulation.spawn({});
  LegMuscles choice = pulling(true);
  choice.activation = ExcitationSource::none;
  EXPECT_TRUE(is_refused(simulation.set_muscles(person, choice), "LegMuscles::activation"));
  choice.modal.tuned = false;
  ASSERT_TRUE(simulation.set_muscles(person, choice));
  const auto before = simulation.state_hash();
  MuscleMethod tuned{Method::modal, choice.modal};
  tuned.modal.tuned = true;
  EXPECT_FALSE(simulation.set_method(person, Muscle::quadriceps, tuned));
  EXPECT_EQ(simulation.state_hash(), before);
  tuned.modal.moving = false;  // no motion to stiffen
  EXPECT_TRUE(simulation.set_method(person, Muscle::quadriceps, tuned));
}

/// With modes on the paper's mesh of 81 nodes, extrapolation once made the tension and stiffness of some motions
/// negative. Control points were then NaN from the first activation.
TEST(TunedPeople, CoarseMeshesStayFinite) {
  for (const std::uint32_t modes : {4U, 8U, 12U}) {
    Simulation simulation(sharing());
    const Entity person = *simulation.spawn_posed({});
    LegMuscles choice = pulling(true, false);
    choice.modal.cells = {2, 2, 8};
    choice.modal.modes = modes;
    choice.activation = ExcitationSource::host;
    choice.muscles = LegMuscles{}.muscles;
    ASSERT_TRUE(simulation.set_muscles(person, choice));
    for (int tick = 0; tick < 60; ++tick) {
      for (const MuscleRef& own : simulation.muscles(person)) {
        ASSERT_TRUE(simulation.set_excitation(person, own.muscle, Side::right, tick % 2 == 0 ? 1.0F : 0.01F));
      }
      simulation.tick();
      for (const MuscleRef& own : simulation.muscles(person)) {
        const NodalView nodes = nodal_displacement(simulation.world(), own.entity[Side::right]);
        for (std::uint32_t i = 0; i < 3 * nodes.nodes; ++i) {
          ASSERT_LT(std::fabs(nodes.first[i * lane_count]), 0.1F) << modes << " modes, tick " << tick;
        }
      }
    }
  }
}

/// Amplitude of a standing person's calf after a jolt, and the remainder a quarter of a second later.
struct Shaken {
  double max_m = 0, left_m = 0;
};

Shaken shaken(bool tuned, float level) {
  Simulation simulation(sharing());
  const Entity person = *simulation.spawn_posed({});
  LegMuscles choice = pulling(tuned);
  choice.activation = ExcitationSource::host;
  choice.muscles = MuscleSet(1U << static_cast<unsigned>(Muscle::triceps_surae));
  EXPECT_TRUE(simulation.set_muscles(person, choice));
  EXPECT_TRUE(simulation.set_excitation(person, Muscle::triceps_surae, Side::right, level));
  run(simulation, 180);
  const Entity muscle = simulation.muscle(person, Muscle::triceps_surae, Side::right);
  const auto rest = displacement(simulation, muscle);
  Pose<float> pose = *simulation.get<Pose>(person);
  for (auto& at : pose.position_m) at.x += 0.01F;  // 1 cm in a tick, and back
  EXPECT_TRUE(simulation.set_pose(person, pose));
  simulation.tick();
  for (auto& at : pose.position_m) at.x -= 0.01F;
  EXPECT_TRUE(simulation.set_pose(person, pose));
  Shaken all;
  for (int tick = 0; tick < 25; ++tick) {
    simulation.tick();
    const double now = apart(displacement(simulation, muscle), rest);
    all.max_m = std::max(all.max_m, now);
    if (tick >= 15) all.left_m = std::max(all.left_m, now);
  }
  return all;
}

TEST(TunedPeople, ActiveMusclesShakeLessAndShorter) {
  const Shaken plain = shaken(false, 1), relaxed = shaken(true, 0), pulls = shaken(true, 1);
  EXPECT_LT(relaxed.left_m / relaxed.max_m, 0.7 * plain.left_m / plain.max_m);
  EXPECT_LT(pulls.max_m, 0.8 * relaxed.max_m);
  EXPECT_LT(pulls.left_m, 0.05 * pulls.max_m);
  EXPECT_NEAR(shaken(false, 0).max_m / plain.max_m, 1, 0.1) << "without, nothing but the shape tells who pulls";
}

/// Tension stiffens a belly against gravity, so a new one starts at rest for its own activation.
TEST(TunedPeople, NewBelliesAreAtRest) {
  for (const bool seen : {true, false}) {
    Simulation simulation(sharing());
    LegMuscles choice = pulling(true);
    choice.activation = ExcitationSource::host;
    choice.finite_shape = false;
    choice.modal.control_points = seen;
    choice.modal.reported = seen;
    const Entity person = *simulation.spawn_posed({});
    ASSERT_TRUE(simulation.set_muscles(person, choice));
    const Entity muscle = simulation.muscle(person, Muscle::quadriceps, Side::left);
    const auto before = field_of<ModalState>(simulation.world(), muscle);
    run(simulation, 20);
    const auto after = field_of<ModalState>(simulation.world(), muscle);
    double most = 0, off = 0;
    for (std::size_t i = 0; i < after.size(); ++i) {
      most = std::max(most, std::abs(double{before[i]}));
      off = std::max(off, std::abs(double{after[i]} - double{before[i]}));
    }
    EXPECT_GT(most, 1e-3) << seen;
    EXPECT_LT(off, 2e-3 * most) << seen;
  }
}

TEST(TunedPeople, NothingJumpsWhenSwitched) {
  for (const bool inertia : {false, true}) {
    Simulation simulation(sharing());
    const Entity person = join_with(simulation, sample_person(6), pulling(false, inertia));
    const Entity muscle = simulation.muscle(person, Muscle::quadriceps, Side::right);
    run(simulation, 30);
    double usual_m = 0, changed_m = 0;  // motion per tick
    const auto tick = [&](double& max_m) {
      const auto before = displacement(simulation, muscle);
      simulation.tick();
      max_m = std::max(max_m, apart(displacement(simulation, muscle), before));
    };
    for (int change = 0; change < 24; ++change) {
      for (int i = 0; i < 7; ++i) tick(usual_m);
      const auto before = displacement(simulation, muscle);
      MuscleMethod to{Method::modal, pulling(change % 2 == 0).modal};
      ASSERT_TRUE(simulation.set_method(person, Muscle::quadriceps, to));
      EXPECT_LT(apart(displacement(simulation, muscle), before), 2e-5) << change;
      tick(changed_m);
    }
    EXPECT_LT(changed_m, 1.1 * usual_m) << "inertia " << inertia;
  }
}

}  // namespace
}  // namespace mobil::tuned_people_test
