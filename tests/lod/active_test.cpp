// Level of detail with active muscles: finite shape and tension are switched as tolerances require, without a jump.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <mobil/components/activation.h>
#include <mobil/engine/world.h>
#include <mobil/lod.h>
#include <mobil/systems/snapshot/restore_limits.h>
#include "assets/finite/finite_shape.h"
#include "tests/interfaces.h"
#include "tests/labels.h"
#include "tests/simulation/leg_muscles.h"
#include "tests/simulation/people.h"
#include "tests/world_of.h"

namespace mobil::active_lod_test {
namespace {

LegMuscles pulling(bool inertia = true) {
  LegMuscles choice;
  choice.activation = ExcitationSource::phase;
  choice.inertia = inertia;
  return choice;
}

/// Walkers with quadriceps and calves.
struct Scene {
  Simulation simulation;
  Lod lod;
  std::vector<Entity> people;

  LodOptions options;

  explicit Scene(int count, const LegMuscles& choice = pulling())
      : lod(simulation.lod()), options{.switching_s = 1, .stagger = 1, .machine_factor = 1, .leg_muscles = choice} {
    EXPECT_TRUE(lod.set_options(options));
    for (int i = 0; i < count; ++i) {
      BodyRequest body;
      body.height_m = 1.8F;
      people.push_back(*simulation.spawn(body, {.speed_m_s = 1.2F + 0.02F * static_cast<float>(i)}));
    }
  }
  void ask(float tolerance_m, bool looked_at = true) {
    LodScene needs{.muscles = MuscleSet(0b110), .tolerance_m = tolerance_m, .looked_at = looked_at};
    ASSERT_TRUE(lod.set_scene(needs));
  }
  void manage() {
    for (const Entity person : people) ASSERT_TRUE(lod.manage(person));
  }
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      simulation.tick();
      const auto report = lod.report();
      EXPECT_EQ(report.refused, 0U) << report.refusal;
    }
  }
  Entity calf(std::size_t person = 0) const {
    return simulation.muscle(people[person], Muscle::triceps_surae, Side::right);
  }
};

bool has_finite_shape(const Simulation& simulation, Entity muscle) {
  return simulation.world().shared<FiniteShape>(muscle) != nullptr;
}

TEST(LodActive, EachLevelHasTheMethodItIsNamedAfter) {
  Scene scene(1);
  scene.ask(1);
  scene.manage();
  const Entity person = scene.people[0];
  for (std::size_t r = 1; r < level_count; ++r) {
    const LodLevel& level = active_levels[r];
    const MuscleMethod asked = level_method(r, true, true);
    ASSERT_TRUE(scene.lod.force(person, Muscle::triceps_surae, asked)) << level.name;
    const MuscleMethod got = scene.simulation.method(person, Muscle::triceps_surae);
    EXPECT_TRUE(same_method(got, asked)) << level.name;
    EXPECT_EQ(is_tuned(got), level.tuned) << level.name;
    EXPECT_EQ(has_finite_shape(scene.simulation, scene.calf()), level.finite_shape) << level.name;
    const auto why = scene.lod.why(person, Muscle::triceps_surae);
    EXPECT_TRUE(why->active);
    EXPECT_EQ(why->level, r) << level.name;
    scene.run(2);
  }
}

TEST(LodActive, EffectsGrowWithNearnessAndEndOutOfSight) {
  Scene scene(1);
  scene.ask(0.001F);
  scene.manage();
  scene.run(2);
  const MuscleMethod near = scene.simulation.method(scene.people[0], Muscle::triceps_surae);
  EXPECT_TRUE(is_tuned(near));
  EXPECT_FALSE(near.modal.linear_shape);
  scene.ask(0.02F);
  scene.run(2);
  const auto far = scene.lod.why(scene.people[0], Muscle::triceps_surae);
  EXPECT_TRUE(far->method.modal.linear_shape) << far->text;
  EXPECT_FALSE(has_finite_shape(scene.simulation, scene.calf()));
  LodScene away{.muscles = MuscleSet(0b110), .camera = Viewpoint{.position_m = {0, 2, 900}, .reach_m = 50}};
  ASSERT_TRUE(scene.lod.set_scene(away));
  scene.run(40);
  EXPECT_EQ(scene.simulation.method(scene.people[0], Muscle::triceps_surae).method, Method::none);
  const float before = scene.simulation.get<Activation>(scene.calf())->activation;
  scene.run(12);
  EXPECT_NE(scene.simulation.get<Activation>(scene.calf())->activation, before) << "fibres go on pulling unseen";
}

/// Two runs are equal until one of them requests another level. Their distance then grows by less than 2.5 mm a tick.
TEST(LodActive, EffectsAreSwitchedWithoutAJump) {
  MOBIL_SLOW();
  constexpr int before = 100, after = 40;
  for (const auto& [from_m, to_m] : {std::pair(0.02F, 0.001F), std::pair(0.001F, 0.02F)}) {
    Scene changes(1), stays(1);
    for (Scene* scene : {&changes, &stays}) {
      scene->ask(from_m);
      scene->manage();
      scene->run(before);
    }
    const auto same = displacement(changes.simulation, changes.calf());
    ASSERT_EQ(same, displacement(stays.simulation, stays.calf()));
    changes.ask(to_m);
    ASSERT_EQ(changes.lod.why(changes.people[0], Muscle::triceps_surae)->level,
              stays.lod.why(stays.people[0], Muscle::triceps_surae)->level);
    double apart_before = 0;
    for (int t = 0; t < after; ++t) {
      changes.run(1), stays.run(1);
      const auto a = displacement(changes.simulation, changes.calf()), b = displacement(stays.simulation, stays.calf());
      double apart = 0;
      for (std::size_t i = 0; i < a.size(); ++i) apart = std::max(apart, std::abs(double{a[i]} - double{b[i]}));
      EXPECT_LT(apart - apart_before, 0.0025) << from_m << " at " << t;
      apart_before = apart;
    }
    EXPECT_GT(apart_before, 0.0005) << "the levels differ";
  }
}

TEST(LodActive, FluctuatingToleranceSwitchesNothing) {
  Scene scene(3);
  scene.ask(0.004F);
  scene.manage();
  scene.run(3);
  std::size_t switched = 0;
  for (int t = 0; t < 60; ++t) {
    scene.ask(t % 2 == 0 ? 0.0042F : 0.0038F);
    scene.simulation.tick();
    switched += scene.lod.report().switched;
    scene.simulation.tick();
  }
  EXPECT_LE(switched, 2 * scene.people.size());  // once up, where 3.8 mm requires more
}

TEST(LodActive, WithoutFiniteShapeTheLinearLevelsServes) {
  LegMuscles choice = pulling();
  choice.finite_shape = false;
  Scene scene(1, choice);
  scene.ask(0.002F);
  scene.manage();
  scene.run(2);
  const auto why = scene.lod.why(scene.people[0], Muscle::triceps_surae);
  EXPECT_FALSE(why->active);
  EXPECT_FALSE(is_tuned(why->method));
  EXPECT_FALSE(has_finite_shape(scene.simulation, scene.calf()));
}

TEST(LodActive, SnapshotKeepsLinearDisplay) {
  Scene scene(1);
  scene.ask(0.02F);
  scene.manage();
  scene.run(40);
  const MuscleMethod was = scene.simulation.method(scene.people[0], Muscle::triceps_surae);
  ASSERT_TRUE(was.modal.linear_shape);
  ASSERT_TRUE(scene.lod.force(scene.people[0], Muscle::triceps_surae, level_method(2, true, true)));
  scene.run(40);
  std::vector<std::byte> bytes(scene.simulation.snapshot_bytes());
  ASSERT_TRUE(scene.simulation.save(bytes));
  Simulation other;
  ASSERT_TRUE(other.restore(bytes, RestoreLimits::none()));
  ASSERT_TRUE(other.lod().set_options(scene.options));
  ASSERT_TRUE(other.lod().set_scene(scene.lod.scene()));
  EXPECT_EQ(other.state_hash(), scene.simulation.state_hash());
  EXPECT_TRUE(same_method(other.method(scene.people[0], Muscle::triceps_surae), level_method(2, true, true)));
  for (int t = 0; t < 30; ++t) other.tick(), scene.simulation.tick();
  EXPECT_EQ(other.state_hash(), scene.simulation.state_hash());
}

}  // namespace
}  // namespace mobil::active_lod_test
