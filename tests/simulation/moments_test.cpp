// Muscles that follow joint moments, in the simulation.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <mobil/components/activation.h>
#include <mobil/forces.h>
#include <mobil/simulation.h>
#include <mobil/systems/snapshot/restore_limits.h>
#include "tests/simulation/people.h"

namespace mobil::moments_test {
namespace {

LegMuscles following(Method method = Method::none) {
  LegMuscles choice;
  choice.method = method;
  choice.activation = ExcitationSource::moments;
  return choice;
}

Entity walker(Simulation& simulation) {
  return *simulation.spawn({.height_m = 1.8F, .mass_kg = 80}, {.speed_m_s = 1.39F});
}

struct Pair {
  std::vector<float> muscles, joint;
};
double off(const Pair& of) {
  double error = 0, all = 0;
  for (std::size_t i = 0; i < of.joint.size(); ++i)
    error += std::pow(of.muscles[i] - of.joint[i], 2), all += std::pow(of.joint[i], 2);
  return std::sqrt(error / all);
}

/// Activation follows with a lag of 10 to 40 ms, so the moments are slightly late.
TEST(Moments, MusclesMakeTheMomentsOfTheWalk) {
  Simulation simulation(sharing());
  const Entity person = walker(simulation);
  ASSERT_TRUE(simulation.enable(person, Feature::forces));
  LegMuscles choice = following();
  choice.muscles = muscle_members();
  choice.line_motion = true;
  ASSERT_TRUE(simulation.set_muscles(person, choice));
  for (const Side side : {Side::right, Side::left}) {
    Pair ankle, knee;
    float squares = 0, count = 0;
    for (int tick = 0; tick < 240; ++tick) {
      simulation.tick();
      if (tick < 60) continue;
      float ankle_nm = 0, knee_nm = 0;
      for (const MuscleRef& own : simulation.muscles(person)) {
        const float force_n = simulation.get<Musculotendon>(own.entity[side])->force_n;
        const auto arms = *simulation.get<LineMotion>(own.entity[side]);
        ankle_nm -= force_n * arms.ankle_dorsiflexion_arm_m, knee_nm -= force_n * arms.knee_flexion_arm_m;
      }
      const auto moments = *simulation.get<JointMoments>(person);
      ankle.muscles.push_back(ankle_nm), ankle.joint.push_back(moments.ankle_nm[side]);
      knee.muscles.push_back(knee_nm), knee.joint.push_back(moments.knee_nm[side]);
      const auto left = (*simulation.get<MomentReserve>(person)).left_nm[side];
      for (const float one : {left.hip, left.hip_abduction, left.hip_rotation, left.knee, left.ankle})
        squares += one * one, ++count;
    }
    EXPECT_LT(off(ankle), 0.15);
    EXPECT_LT(off(knee), 0.3);
    EXPECT_LT(std::sqrt(squares / count), 1.2) << "N m, most of it the abductors' in heel strikes";
  }
}

TEST(Moments, NeedForces) {
  Simulation simulation(sharing());
  const Entity person = walker(simulation);
  const auto refused = simulation.set_muscles(person, following());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().status, Status::missing);
  EXPECT_NE(refused.error().message.find("Feature::forces"), std::string::npos) << refused.error().message;
  EXPECT_TRUE(simulation.muscles(person).empty());
  SpawnRequest request;
  request.muscles = following();
  Entity none;
  const auto spawned = simulation.spawn({&request, 1}, {&none, 1});
  ASSERT_FALSE(spawned);
  ASSERT_TRUE(simulation.enable(person, Feature::forces));
  EXPECT_TRUE(simulation.set_muscles(person, following()));
}

/// Components for following moments are added and removed with the choice, and with the forces they depend on.
TEST(Moments, CanBeSwitched) {
  Simulation simulation(sharing());
  const Entity person = walker(simulation);
  ASSERT_TRUE(simulation.enable(person, Feature::forces));
  ASSERT_TRUE(simulation.set_muscles(person, following(Method::modal)));
  EXPECT_TRUE(simulation.get<MomentReserve>(person));
  LegMuscles phase = following(Method::modal);
  phase.activation = ExcitationSource::phase;
  ASSERT_TRUE(simulation.set_muscles(person, phase));
  EXPECT_FALSE(simulation.get<MomentReserve>(person));
  ASSERT_TRUE(simulation.set_muscles(person, following(Method::modal)));
  EXPECT_TRUE(simulation.get<MomentReserve>(person));
  for (int tick = 0; tick < 60; ++tick) simulation.tick();
  ASSERT_TRUE(simulation.enable(person, Feature::forces, false));
  EXPECT_FALSE(simulation.get<MomentReserve>(person));
  for (int tick = 0; tick < 60; ++tick) simulation.tick();
  const Entity calf = simulation.muscle(person, Muscle::triceps_surae, Side::right);
  EXPECT_LT(simulation.get<Activation>(calf)->activation, 0.02F) << "nothing is asked of them";
  ASSERT_FALSE(simulation.set_muscles(person, following(Method::none)));
  ASSERT_TRUE(simulation.enable(person, Feature::forces));
  ASSERT_TRUE(simulation.set_muscles(person, following(Method::none)));
  ASSERT_TRUE(simulation.set_muscles(person, std::nullopt));
  EXPECT_FALSE(simulation.get<MomentReserve>(person));
}

TEST(Moments, PeopleUnableToFollowStayAsleepOrCompact) {
  Simulation simulation(sharing());
  LegMuscles plain = following(Method::modal);
  plain.activation = ExcitationSource::none;
  plain.modal.control_points = false;
  for (const bool compact : {false, true}) {
    const Entity with = walker(simulation), without = walker(simulation);
    ASSERT_TRUE(simulation.set_muscles(with, plain));
    for (int tick = 0; tick < 240; ++tick) simulation.tick();
    const std::array both = {with, without};
    const PersonState state = compact ? PersonState::compact : PersonState::asleep;
    ASSERT_EQ(simulation.set_state(both, state).value(), 2U) << compact;
    const std::uint64_t before = simulation.state_hash();
    EXPECT_EQ(simulation.set_muscles(with, following(Method::modal)).error().status, Status::missing);
    LegMuscles wild = plain;
    wild.modal.modes = 9999;
    EXPECT_FALSE(simulation.set_muscles(with, wild));
    EXPECT_EQ(simulation.state_hash(), before);
    for (const Entity person : both) EXPECT_EQ(simulation.state(person), state);
    ASSERT_TRUE(simulation.despawn(both));
  }
}

TEST(Moments, ContinueFromASnapshot) {
  Simulation simulation(sharing()), other(sharing());
  const Entity person = walker(simulation);
  ASSERT_TRUE(simulation.enable(person, Feature::forces));
  ASSERT_TRUE(simulation.set_muscles(person, following(Method::modal)));
  for (int tick = 0; tick < 40; ++tick) simulation.tick();
  std::vector<std::byte> saved(simulation.snapshot_bytes());
  ASSERT_TRUE(simulation.save(saved));
  const auto restored = other.restore(saved, RestoreLimits::none());
  ASSERT_TRUE(restored) << restored.error().message;
  for (int tick = 0; tick < 40; ++tick) simulation.tick(), other.tick();
  EXPECT_EQ(simulation.state_hash(), other.state_hash());
}

/// A posed person's moments are a tick late. Standing needs calves more than shins.
TEST(Moments, FollowPosedPeople) {
  Simulation simulation(sharing());
  Simulation walking(sharing());
  const Entity model = walker(walking);
  const auto posed = simulation.spawn_posed({.height_m = 1.8F, .mass_kg = 80});
  ASSERT_TRUE(posed);
  ASSERT_TRUE(simulation.enable(*posed, Feature::forces));
  ASSERT_TRUE(simulation.set_muscles(*posed, following()));
  float most = 0;
  for (int tick = 0; tick < 120; ++tick) {
    walking.tick();
    ASSERT_TRUE(simulation.set_pose(*posed, *walking.get<Pose>(model)));
    simulation.tick();
    const Entity calf = simulation.muscle(*posed, Muscle::triceps_surae, Side::right);
    const float activation = simulation.get<Activation>(calf)->activation;
    ASSERT_TRUE(std::isfinite(activation));
    most = std::max(most, activation);
  }
  EXPECT_GT(most, 0.3F);
}

}  // namespace
}  // namespace mobil::moments_test
