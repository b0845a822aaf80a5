// Level of detail where muscles pull: finite shape and tension come and go as tolerances ask, without a jump.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <mobil/engine/world.h>
#include <mobil/lod.h>
#include "assets/finite/finite_shape.h"
#include "tests/interfaces.h"
#include "tests/labels.h"
#include "tests/simulation/leg_muscles.h"
#include "tests/simulation/people.h"
#include "tests/world_of.h"

namespace mobil::living_relevance_test {
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
  Lod relevance;
  std::vector<Entity> people;

  LodOptions options;

  explicit Scene(int humans, const LegMuscles& choice = pulling())
      : relevance(simulation.lod()),
        options{.switching_s = 1, .stagger = 1, .machine_factor = 1, .leg_muscles = choice} {
    EXPECT_TRUE(relevance.set_options(options));
    for (int i = 0; i < humans; ++i) {
      BodyRequest body;
      body.height_m = 1.8F;
      people.push_back(*simulation.spawn(body, {.speed_m_s = 1.2F + 0.02F * static_cast<float>(i)}));
    }
  }
  void ask(float tolerance_m, bool looked_at = true) {
    SceneNeeds needs{.muscles = MuscleSet(0b110), .tolerance_m = tolerance_m, .looked_at = looked_at};
    ASSERT_TRUE(relevance.set_scene(needs));
  }
  void manage() {
    for (const Entity human : people) ASSERT_TRUE(relevance.manage(human));
  }
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      simulation.tick();
      const auto report = relevance.report();
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

TEST(LodLiving, EachRungIsWhatItsNameSays) {
  Scene scene(1);
  scene.ask(1);
  scene.manage();
  const Entity human = scene.people[0];
  for (std::size_t r = 1; r < rung_count; ++r) {
    const Rung& rung = living_rungs[r];
    const MuscleMethod asked = rung_method(r, true, true);
    ASSERT_TRUE(scene.relevance.force(human, Muscle::triceps_surae, asked)) << rung.name;
    const MuscleMethod got = scene.simulation.method(human, Muscle::triceps_surae);
    EXPECT_TRUE(same_method(got, asked)) << rung.name;
    EXPECT_EQ(is_tuned(got), rung.tuned) << rung.name;
    EXPECT_EQ(has_finite_shape(scene.simulation, scene.calf()), rung.finite_shape) << rung.name;
    const auto why = scene.relevance.why(human, Muscle::triceps_surae);
    EXPECT_TRUE(why->living);
    EXPECT_EQ(why->rung, r) << rung.name;
    scene.run(2);
  }
}

TEST(LodLiving, TheNearerTheMoreEffectsAndNoneOutOfSight) {
  Scene scene(1);
  scene.ask(0.001F);
  scene.manage();
  scene.run(2);
  const MuscleMethod near = scene.simulation.method(scene.people[0], Muscle::triceps_surae);
  EXPECT_TRUE(is_tuned(near));
  EXPECT_FALSE(near.reduced.linear_shape);
  scene.ask(0.02F);
  scene.run(2);
  const auto far = scene.relevance.why(scene.people[0], Muscle::triceps_surae);
  EXPECT_TRUE(far->method.reduced.linear_shape) << far->text;
  EXPECT_FALSE(has_finite_shape(scene.simulation, scene.calf()));
  SceneNeeds away{.muscles = MuscleSet(0b110), .camera = Viewpoint{.position_m = {0, 2, 900}, .reach_m = 50}};
  ASSERT_TRUE(scene.relevance.set_scene(away));
  scene.run(40);
  EXPECT_EQ(scene.simulation.method(scene.people[0], Muscle::triceps_surae).method, Method::none);
  const float before = scene.simulation.get<Activation>(scene.calf())->activation;
  scene.run(12);
  EXPECT_NE(scene.simulation.get<Activation>(scene.calf())->activation, before) << "fibres go on pulling unseen";
}

/// The largest step of a control point between ticks; of two runs alike up to `change`, when another ladder's rung is
/// asked for, that after it.
TEST(LodLiving, EffectsComeAndGoWithoutAJump) {
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
    ASSERT_EQ(changes.relevance.why(changes.people[0], Muscle::triceps_surae)->rung,
              stays.relevance.why(stays.people[0], Muscle::triceps_surae)->rung);
    double apart_before = 0;
    for (int t = 0; t < after; ++t) {
      changes.run(1), stays.run(1);
      const auto a = displacement(changes.simulation, changes.calf()), b = displacement(stays.simulation, stays.calf());
      double apart = 0;
      for (std::size_t i = 0; i < a.size(); ++i) apart = std::max(apart, std::abs(double{a[i]} - double{b[i]}));
      EXPECT_LT(apart - apart_before, 0.0025) << from_m << " at " << t;
      apart_before = apart;
    }
    EXPECT_GT(apart_before, 0.0005) << "the rungs differ";
  }
}

TEST(LodLiving, AToleranceThatTremblesSwitchesNothing) {
  Scene scene(3);
  scene.ask(0.004F);
  scene.manage();
  scene.run(3);
  std::size_t switched = 0;
  for (int t = 0; t < 60; ++t) {
    scene.ask(t % 2 == 0 ? 0.0042F : 0.0038F);
    scene.simulation.tick();
    switched += scene.relevance.report().switched;
    scene.simulation.tick();
  }
  EXPECT_LE(switched, 2 * scene.people.size());  // once up, where 3.8 mm asks for more
}

TEST(LodLiving, WithoutFiniteShapeTheLinearLadderServes) {
  LegMuscles choice = pulling();
  choice.finite_shape = false;
  Scene scene(1, choice);
  scene.ask(0.002F);
  scene.manage();
  scene.run(2);
  const auto why = scene.relevance.why(scene.people[0], Muscle::triceps_surae);
  EXPECT_FALSE(why->living);
  EXPECT_FALSE(is_tuned(why->method));
  EXPECT_FALSE(has_finite_shape(scene.simulation, scene.calf()));
}

TEST(LodLiving, ASnapshotKeepsWhoIsShownLinearly) {
  Scene scene(1);
  scene.ask(0.02F);
  scene.manage();
  scene.run(40);
  const MuscleMethod was = scene.simulation.method(scene.people[0], Muscle::triceps_surae);
  ASSERT_TRUE(was.reduced.linear_shape);
  ASSERT_TRUE(scene.relevance.force(scene.people[0], Muscle::triceps_surae, rung_method(2, true, true)));
  scene.run(40);
  std::vector<std::byte> bytes(scene.simulation.snapshot_bytes());
  ASSERT_TRUE(scene.simulation.save(bytes));
  Simulation other;
  ASSERT_TRUE(other.restore(bytes, RestoreLimits::none()));
  ASSERT_TRUE(other.lod().set_options(scene.options));
  ASSERT_TRUE(other.lod().set_scene(scene.relevance.scene()));
  EXPECT_EQ(other.state_hash(), scene.simulation.state_hash());
  EXPECT_TRUE(same_method(other.method(scene.people[0], Muscle::triceps_surae), rung_method(2, true, true)));
  for (int t = 0; t < 30; ++t) other.tick(), scene.simulation.tick();
  EXPECT_EQ(other.state_hash(), scene.simulation.state_hash());
}

}  // namespace
}  // namespace mobil::living_relevance_test
