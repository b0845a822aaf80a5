// Active muscles in a simulation: enabling, excitation sources, and state through changes.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <mobil/components/activation.h>
#include <mobil/muscle_table.h>
#include <mobil/systems/snapshot/restore_limits.h>
#include "tests/labels.h"
#include "tests/simulation/leg_muscles.h"
#include "tests/simulation/people.h"

namespace mobil::activation_test {
namespace {

LegMuscles pulling(ExcitationSource source, Method method = Method::none) {
  LegMuscles choice;
  choice.method = method;
  choice.modal.cells = {2, 2, 8};
  choice.activation = source;
  return choice;
}

Activation<float> activation(const Simulation& simulation, Entity person, std::string_view muscle, Side side) {
  return *simulation.get<Activation>(simulation.muscle(person, *find_muscle(muscle), side));
}
Musculotendon<float> pull(const Simulation& simulation, Entity person, std::string_view muscle, Side side) {
  return *simulation.get<Musculotendon>(simulation.muscle(person, *find_muscle(muscle), side));
}

void run(Simulation& simulation, int ticks) {
  for (int i = 0; i < ticks; ++i) simulation.tick();
}

/// Neither the gait nor the lines change, and other people's rows keep their bits.
TEST(Activation, PeopleWithoutActivationAreUnchanged) {
  Simulation with(sharing()), without(sharing());
  const Entity asks = join_with(with, sample_person(1), pulling(ExcitationSource::phase, Method::explicit_central));
  const Entity does_not = join_with(with, sample_person(2), pulling(ExcitationSource::none, Method::explicit_central));
  const Entity same = join_with(without, sample_person(1), pulling(ExcitationSource::none, Method::explicit_central));
  const Entity alone = join_with(without, sample_person(2), pulling(ExcitationSource::none, Method::explicit_central));
  run(with, 100), run(without, 100);
  EXPECT_EQ(hash_person(with, does_not), hash_person(without, alone));
  const Entity one = with.muscle(asks, Muscle::triceps_surae, Side::right);
  const Entity other = without.muscle(same, Muscle::triceps_surae, Side::right);
  EXPECT_EQ(with.get<LineOfAction>(one)->length_m, without.get<LineOfAction>(other)->length_m);
  EXPECT_FALSE(without.get<Musculotendon>(other));
}

/// The mesh's end is at the tendon's end for every method.
TEST(Activation, BellyFollowsTheTendonsEnd) {
  MOBIL_SLOW();
  for (const Method method : {Method::explicit_central, Method::implicit_central, Method::newmark, Method::statics,
                              Method::modal, Method::finite}) {
    Simulation simulation(sharing());
    const Entity person = join_with(simulation, sample_person(3), pulling(ExcitationSource::phase, method));
    float apart = 0, by_tendon = 0;
    for (int tick = 0; tick < 90; ++tick) {
      simulation.tick();
      for (const MuscleRef& own : simulation.muscles(person)) {
        for (const Entity muscle : own.entity) {
          const auto line = *simulation.get<LineOfAction>(muscle);
          const float belly = simulation.get<Musculotendon>(muscle)->belly_m;
          apart = std::max(apart, std::abs(simulation.get<BellyReport>(muscle)->elongation_m - belly));
          by_tendon = std::max(by_tendon, std::abs(line.length_m - line.rest_length_m - belly));
        }
      }
    }
    EXPECT_LT(apart, 1e-6F) << name(method);
    EXPECT_GT(by_tendon, 0.005F) << name(method);
  }
}

TEST(Activation, FollowsTheHost) {
  Simulation simulation(sharing());
  const Entity person = *simulation.spawn_posed({});
  LegMuscles choice = pulling(ExcitationSource::host);
  choice.muscles |= muscle_members();
  ASSERT_TRUE(simulation.set_muscles(person, choice));
  run(simulation, 10);
  const Muscle soleus = *find_muscle("soleus");
  EXPECT_NEAR(activation(simulation, person, "soleus", Side::left).activation, 0.01F, 1e-6F);
  const auto relaxed = pull(simulation, person, "soleus", Side::left);
  EXPECT_NEAR(relaxed.belly_m, 0, 1e-5F) << "as in who stands";
  ASSERT_TRUE(simulation.set_excitation(person, soleus, Side::left, 1));
  run(simulation, 60);
  EXPECT_NEAR(activation(simulation, person, "soleus", Side::left).activation, 1, 1e-4F);
  EXPECT_NEAR(activation(simulation, person, "soleus", Side::right).activation, 0.01F, 1e-6F);
  const auto pulls = pull(simulation, person, "soleus", Side::left);
  EXPECT_LT(pulls.belly_m, relaxed.belly_m - 0.005F);
  EXPECT_GT(pulls.tendon_m, relaxed.tendon_m + 0.005F);
  EXPECT_GT(pulls.force_n, 1500);
  EXPECT_GT(pulls.pennation_rad, relaxed.pennation_rad + 0.05F);
  // All members of a group are excited.
  ASSERT_TRUE(simulation.set_excitation(person, Muscle::quadriceps, Side::right, 7));
  run(simulation, 60);
  EXPECT_EQ(activation(simulation, person, "quadriceps", Side::right).excitation, 1);
  EXPECT_GT(pull(simulation, person, "quadriceps", Side::right).force_n, 500) << "short, on a straight knee";
}

TEST(Activation, BadRequestsAreNamed) {
  Simulation simulation(sharing());
  const Entity walks = *simulation.spawn({}), hosted = *simulation.spawn({});
  ASSERT_TRUE(simulation.set_muscles(walks, pulling(ExcitationSource::phase)));
  ASSERT_TRUE(simulation.set_muscles(hosted, pulling(ExcitationSource::host)));
  run(simulation, 3);
  const std::uint64_t before = simulation.state_hash();
  const auto says = [](const Result<void>& result, Status status, std::string_view what) {
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().status, status);
    EXPECT_NE(result.error().message.find(what), std::string::npos) << result.error().message;
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  says(simulation.set_excitation(hosted, Muscle::hamstrings, Side::right, nan), Status::not_valid, "hamstrings");
  says(simulation.set_excitation(walks, Muscle::hamstrings, Side::right, 1), Status::missing, "ExcitationSource::host");
  says(simulation.set_excitation(hosted, *find_muscle("soleus"), Side::right, 1), Status::missing, "no such muscle");
  says(simulation.set_excitation({}, Muscle::hamstrings, Side::right, 1), Status::stale_entity, "stale");
  LegMuscles forced = pulling(ExcitationSource::phase);
  forced.drive = Drive::force;
  says(simulation.set_muscles(walks, forced), Status::not_valid, "Drive::displacement");
  EXPECT_EQ(simulation.state_hash(), before);
}

/// State through method changes, snapshots, batches and other sources.
TEST(Activation, StateSurvivesChanges) {
  Simulation simulation(sharing());
  const Entity person = join_with(simulation, sample_person(4), pulling(ExcitationSource::phase, Method::modal));
  run(simulation, 33);
  const auto before = pull(simulation, person, "triceps_surae", Side::right);
  const auto excited = activation(simulation, person, "triceps_surae", Side::right);
  ASSERT_TRUE(simulation.set_method(person, Muscle::triceps_surae, {Method::explicit_central}));
  EXPECT_EQ(pull(simulation, person, "triceps_surae", Side::right).fibre_m, before.fibre_m);

  std::vector<std::byte> bytes(simulation.snapshot_bytes());
  ASSERT_TRUE(simulation.save(bytes));
  run(simulation, 20);
  const std::uint64_t later = simulation.state_hash();
  Simulation other(sharing());
  ASSERT_TRUE(other.restore(bytes, RestoreLimits::none()));
  run(other, 20);
  EXPECT_EQ(other.state_hash(), later);

  // The host continues from the activation of the walk.
  ASSERT_TRUE(simulation.restore(bytes, RestoreLimits::none()));
  LegMuscles hosted = pulling(ExcitationSource::host, Method::modal);
  ASSERT_TRUE(simulation.set_muscles(person, hosted));
  EXPECT_EQ(activation(simulation, person, "triceps_surae", Side::right).activation, excited.activation);
  run(simulation, 5);
  EXPECT_EQ(activation(simulation, person, "triceps_surae", Side::right).excitation, excited.excitation);
  // Without activation the line's length is the belly's again.
  ASSERT_TRUE(simulation.set_muscles(person, pulling(ExcitationSource::none, Method::statics)));
  run(simulation, 2);
  const Entity muscle = simulation.muscle(person, Muscle::triceps_surae, Side::right);
  const auto line = *simulation.get<LineOfAction>(muscle);
  EXPECT_NEAR(simulation.get<BellyReport>(muscle)->elongation_m, line.length_m - line.rest_length_m, 1e-6F);
}

TEST(Activation, LeftIsRightHalfACycleLater) {
  Simulation simulation(sharing({.tick_s = 1.0 / 64}));
  // Two steps a second: 64 ticks a cycle.
  const auto person = simulation.spawn({}, {.speed_m_s = 1.4F, .step_frequency_hz = 2.0F});
  ASSERT_TRUE(person);
  ASSERT_TRUE(simulation.set_muscles(*person, pulling(ExcitationSource::phase)));
  run(simulation, 256);
  const auto right = pull(simulation, *person, "triceps_surae", Side::right);
  const auto excited = activation(simulation, *person, "triceps_surae", Side::right);
  run(simulation, 32);
  const auto left = pull(simulation, *person, "triceps_surae", Side::left);
  EXPECT_NEAR(left.force_n, right.force_n, 0.02F * right.force_n + 1);
  EXPECT_NEAR(activation(simulation, *person, "triceps_surae", Side::left).activation, excited.activation, 0.01F);
}

/// The phase is that of the gait: at a heel strike the leg's tibialis is strongly excited, its calf is not.
TEST(Activation, IsInStepWithTheFeet) {
  Simulation simulation(sharing());
  const Entity person = *simulation.spawn({}, {.speed_m_s = 1.3F});
  ASSERT_TRUE(simulation.set_muscles(person, pulling(ExcitationSource::phase)));
  run(simulation, 120);
  for (int tick = 0; tick < 120; ++tick) {
    simulation.tick();
    const Feet<float> feet = *simulation.get<Feet>(person);
    for (const Side side : {Side::right, Side::left}) {
      const float cycle = feet.phase[side];
      const float calf = activation(simulation, person, "triceps_surae", side).excitation;
      const float shin = activation(simulation, person, "tibialis_anterior", side).excitation;
      if (cycle < 0.03F) {
        EXPECT_GT(shin, 2 * calf) << cycle;
      } else if (cycle > 0.35F && cycle < 0.45F) {
        EXPECT_GT(calf, 3 * shin) << cycle;
      }
    }
  }
}

}  // namespace
}  // namespace mobil::activation_test
