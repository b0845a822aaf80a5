// Displayed bellies at finite strain: they keep their volume with every method, and are continuous through changes.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include <mobil/components/activation.h>
#include <mobil/engine/world.h>
#include <mobil/systems/snapshot/restore_limits.h>
#include "tests/labels.h"
#include "tests/refused.h"
#include "tests/simulation/leg_muscles.h"
#include "tests/simulation/people.h"

namespace mobil::finite_shape_test {
namespace {

LegMuscles finite(Method method, ExcitationSource source = ExcitationSource::phase) {
  LegMuscles choice;
  choice.method = method;
  choice.modal.cells = {4, 4, 16};
  choice.modal.moving = false;
  choice.activation = source;
  choice.finite_shape = true;
  return choice;
}

void run(Simulation& simulation, int ticks) {
  for (int i = 0; i < ticks; ++i) simulation.tick();
}

/// Returns the largest |volume − 1| of a person's displayed muscles.
double volume_off(const Simulation& simulation, Entity person) {
  double worst = 0;
  for (const Entity muscle : muscles_of(simulation, person))
    worst = std::max(worst, std::abs(static_cast<double>(simulation.get<BellyReport>(muscle)->volume_ratio) - 1));
  return worst;
}

TEST(FiniteShape, OffLeavesPeopleUnchanged) {
  Simulation with(sharing()), without(sharing());
  const Entity asks = join_with(with, sample_person(1), finite(Method::explicit_central));
  const Entity does_not = join_with(with, sample_person(2), {});
  const Entity alone = join_with(without, sample_person(2), {});
  run(with, 60), run(without, 60);
  EXPECT_EQ(hash_person(with, does_not), hash_person(without, alone));
  // The method's own state is unaffected as well.
  LegMuscles linear = finite(Method::explicit_central);
  linear.finite_shape = false;
  Simulation plain(sharing());
  const Entity same = join_with(plain, sample_person(1), linear);
  run(plain, 60);
  const Entity one = with.muscle(asks, Muscle::hamstrings, Side::left);
  const Entity other = plain.muscle(same, Muscle::hamstrings, Side::left);
  EXPECT_EQ(with.get<BellyReport>(one)->kinetic_energy_j, plain.get<BellyReport>(other)->kinetic_energy_j);
  EXPECT_NE(displacement(with, one), displacement(plain, other));
}

/// Without vibration within 1 %, single muscles and groups, in a walk; linear statics lose up to ten times as much.
TEST(FiniteShape, KeepsItsVolumeInAWalk) {
  MOBIL_SLOW();
  for (const Method method : {Method::modal, Method::statics}) {
    Simulation simulation(sharing());
    LegMuscles choice = finite(method);
    choice.muscles |= muscle_members();
    const Entity person = join_with(simulation, sample_person(5), choice);
    LegMuscles linear = choice;
    linear.finite_shape = false;
    const Entity other = join_with(simulation, sample_person(5), linear);
    double ours = 0, theirs = 0;
    for (int tick = 0; tick < 70; ++tick) {
      simulation.tick();
      ours = std::max(ours, volume_off(simulation, person));
      theirs = std::max(theirs, volume_off(simulation, other));
    }
    EXPECT_LT(ours, 0.012) << name(method);
    EXPECT_GT(theirs, 3 * ours) << name(method);
  }
}

/// All methods agree, except for vibration, which decays when the leg is still.
TEST(FiniteShape, IsTheSameByEveryMethod) {
  std::vector<std::vector<float>> shown;
  for (const Method method :
       {Method::statics, Method::modal, Method::explicit_central, Method::newmark, Method::implicit_central}) {
    Simulation simulation(sharing());
    const Entity person = *simulation.spawn_posed({});
    LegMuscles choice = finite(method, ExcitationSource::host);
    choice.muscles = MuscleSet(1U << static_cast<unsigned>(Muscle::triceps_surae));
    choice.damping_per_s = 40;
    ASSERT_TRUE(simulation.set_muscles(person, choice));
    ASSERT_TRUE(simulation.set_excitation(person, Muscle::triceps_surae, Side::right, 0.5F));
    run(simulation, 240);
    shown.push_back(displacement(simulation, simulation.muscle(person, Muscle::triceps_surae, Side::right)));
  }
  for (const auto& other : shown) {
    double apart = 0, most = 0;
    for (std::size_t i = 0; i < other.size(); ++i) {
      apart = std::max(apart, std::abs(static_cast<double>(other[i] - shown.front()[i])));
      most = std::max(most, std::abs(static_cast<double>(shown.front()[i])));
    }
    EXPECT_GT(most, 0.004);
    EXPECT_LT(apart, 0.05 * most);
  }
}

/// The belly is thicker when active, and thicker with more activation.
TEST(FiniteShape, BulgesWithActivation) {
  Simulation simulation(sharing());
  const Entity person = *simulation.spawn_posed({});
  LegMuscles choice = finite(Method::modal, ExcitationSource::host);
  choice.muscles = MuscleSet{};
  const Muscle soleus = *find_muscle("soleus");
  choice.muscles.set(static_cast<std::size_t>(soleus));
  ASSERT_TRUE(simulation.set_muscles(person, choice));
  const Entity muscle = simulation.muscle(person, soleus, Side::right);
  const auto& mesh = simulation.world().shared<MuscleTemplate>(muscle)->mesh;
  const BellyScale<float> scale = *simulation.get<BellyScale>(muscle);
  const auto area = [&](bool moved) {  // of the middle section
    const auto u = displacement(simulation, muscle);
    const auto at = [&](std::uint32_t i, std::uint32_t j) {
      const std::uint32_t n = node_index(mesh.cells, i, j, 4);
      const auto of = [&](double rest, std::size_t c) {
        return static_cast<double>(scale.across) * rest + (moved ? static_cast<double>(u[3 * n + c]) : 0);
      };
      return std::array{of(mesh.node[n].x, 0), of(mesh.node[n].y, 1)};
    };
    double sum = 0;
    for (std::uint32_t j = 0; j < 2; ++j) {
      for (std::uint32_t i = 0; i < 2; ++i) {
        const auto p = at(i, j), q = at(i + 1, j), r = at(i + 1, j + 1), s = at(i, j + 1);
        sum += 0.5 * ((r[0] - p[0]) * (s[1] - q[1]) - (s[0] - q[0]) * (r[1] - p[1]));
      }
    }
    return sum;
  };
  double before = 0.99;
  for (const float level : {0.05F, 0.3F, 1.0F}) {
    ASSERT_TRUE(simulation.set_excitation(person, soleus, Side::right, level));
    run(simulation, 60);
    const double grown = area(true) / area(false);
    EXPECT_GT(grown, before + 0.005) << level;
    before = grown;
  }
}

/// The displayed shape is continuous through a change of method or of the effect itself.
TEST(FiniteShape, NothingJumpsWhenMethodsChange) {
  const auto method = [](Method to, bool moving) {
    return MuscleMethod{to, {.modes = 12, .moving = moving, .cells = {4, 4, 16}}};
  };
  Simulation simulation(sharing());
  LegMuscles choice = finite(Method::explicit_central);
  choice.muscles = MuscleSet(3);
  const Entity person = join_with(simulation, sample_person(6), choice);
  run(simulation, 40);
  const std::array changes = {
      method(Method::modal, true),   method(Method::statics, true),          method(Method::modal, false),
      method(Method::newmark, true), method(Method::finite, true),           method(Method::modal, true),
      method(Method::finite, true),  method(Method::explicit_central, true), method(Method::modal, true)};
  const Entity muscle = simulation.muscle(person, Muscle::quadriceps, Side::right);
  for (const MuscleMethod& to : changes) {
    run(simulation, 7);
    const auto before = displacement(simulation, muscle);
    ASSERT_TRUE(simulation.set_method(person, Muscle::quadriceps, to));
    const auto at_once = displacement(simulation, muscle);
    double apart = 0;
    for (std::size_t i = 0; i < before.size(); ++i)
      apart = std::max(apart, std::abs(static_cast<double>(at_once[i] - before[i])));
    EXPECT_LT(apart, 2e-5) << name(to.method);
    simulation.tick();
    const auto after = displacement(simulation, muscle);
    double step = 0;
    for (std::size_t i = 0; i < before.size(); ++i)
      step = std::max(step, std::abs(static_cast<double>(after[i] - before[i])));
    EXPECT_LT(step, 0.007) << name(to.method) << ": a tick's way";
  }
}

/// A finished fade leaves the shape, and rows that snapshots support.
TEST(FiniteShape, ContinuesAfterAFade) {
  Simulation simulation(sharing());
  LegMuscles choice = finite(Method::explicit_central);
  choice.muscles = MuscleSet(1);
  const Entity changed = join_with(simulation, sample_person(6), choice);
  choice.method = Method::statics;
  const Entity always = join_with(simulation, sample_person(6), choice);
  run(simulation, 20);
  ASSERT_TRUE(simulation.set_method(changed, Muscle::hamstrings, {Method::statics}));
  run(simulation, 30);
  const auto shown = [&](Entity person) {
    return displacement(simulation, simulation.muscle(person, Muscle::hamstrings, Side::right));
  };
  const auto one = shown(changed), other = shown(always);
  for (std::size_t i = 0; i < one.size(); ++i) ASSERT_NEAR(one[i], other[i], 2e-5F);
  std::vector<std::byte> bytes(simulation.snapshot_bytes());
  ASSERT_TRUE(simulation.save(bytes));
  const auto restored = simulation.restore(bytes, RestoreLimits::none());
  EXPECT_TRUE(restored) << restored.error().message;
  EXPECT_TRUE(simulation.set_method(changed, Muscle::hamstrings, {Method::explicit_central}));
}

/// A muscle that is displayed again starts with the belly's own motion, without a jump of the shape's offset.
TEST(FiniteShape, DoesNotRingWhenSwitched) {
  const MuscleMethod seen{Method::modal, {.modes = 12, .cells = {4, 4, 16}}};
  MuscleMethod unseen = seen;
  unseen.modal.modes = 4;
  unseen.modal.control_points = unseen.modal.reported = false;
  for (const MuscleMethod& to :
       {seen, MuscleMethod{Method::explicit_central}, MuscleMethod{Method::newmark}, MuscleMethod{Method::finite}}) {
    Simulation simulation(sharing());
    const Entity person = *simulation.spawn_posed({});
    LegMuscles choice = finite(Method::modal, ExcitationSource::host);
    choice.modal = unseen.modal;
    choice.muscles = MuscleSet(1U << static_cast<unsigned>(Muscle::triceps_surae));
    const bool stepped = to.method == Method::finite;  // whose error is that of its mesh, compared with the table
    if (stepped) choice.cells = close_up_cells;
    ASSERT_TRUE(simulation.set_muscles(person, choice));
    ASSERT_TRUE(simulation.set_excitation(person, Muscle::triceps_surae, Side::right, 0.8F));
    run(simulation, 240);
    ASSERT_TRUE(simulation.set_method(person, Muscle::triceps_surae, to));
    const Entity muscle = simulation.muscle(person, Muscle::triceps_surae, Side::right);
    const auto at_once = displacement(simulation, muscle);
    double most = 0;
    for (int tick = 0; tick < 30; ++tick) {
      simulation.tick();
      const auto now = displacement(simulation, muscle);
      for (std::size_t i = 0; i < now.size(); ++i)
        most = std::max(most, std::abs(static_cast<double>(now[i] - at_once[i])));
    }
    EXPECT_LT(most, stepped ? 2.2e-3 : 6e-4) << name(to.method);
  }
}

/// Switched on and off while walking, for all methods.
TEST(FiniteShape, NothingJumpsWhenActivationIsSwitched) {
  for (const Method method :
       {Method::explicit_central, Method::newmark, Method::statics, Method::modal, Method::finite}) {
    Simulation simulation(sharing());
    LegMuscles pulls = finite(method);
    pulls.muscles = MuscleSet(4);
    LegMuscles linear = pulls;
    linear.activation = ExcitationSource::none;
    linear.finite_shape = false;
    const Entity person = join_with(simulation, sample_person(6), linear);
    run(simulation, 40);
    const Entity muscle = simulation.muscle(person, Muscle::triceps_surae, Side::right);
    for (const LegMuscles& next : {pulls, linear, pulls}) {
      const auto before = displacement(simulation, muscle);
      ASSERT_TRUE(simulation.set_muscles(person, next));
      simulation.tick();
      const auto after = displacement(simulation, muscle);
      double step = 0;
      for (std::size_t i = 0; i + 27 < before.size(); ++i)  // except the end, which follows the tendon
        step = std::max(step, std::abs(static_cast<double>(after[i] - before[i])));
      EXPECT_LT(step, 0.006) << name(method) << ": a tick's way";
      run(simulation, 25);
      for (const float u : displacement(simulation, muscle)) ASSERT_LT(std::abs(u), 0.08F);
    }
  }
}

TEST(FiniteShape, TheForceDrivenEndIsRefused) {
  Simulation simulation(sharing());
  const Entity person = *simulation.spawn({});
  LegMuscles choice;
  choice.drive = Drive::force;
  choice.finite_shape = true;
  EXPECT_TRUE(is_refused(simulation.set_muscles(person, choice), "Drive::displacement"));
}

}  // namespace
}  // namespace mobil::finite_shape_test
