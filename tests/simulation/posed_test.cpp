// People animated by their host: their muscles follow, and they have no gait or kinematics.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/engine/world.h>
#include <mobil/step_report.h>
#include <mobil/systems/muscles/person.h>
#include "tests/refused.h"
#include "tests/simulation/leg_muscles.h"

namespace mobil::posed_test {
Entity pose_person(Simulation& simulation, int i) {
  const auto person = simulation.spawn_posed(sample_person(i).body);
  EXPECT_TRUE(person) << person.error().message;
  return person.value_or(Entity{});
}

TEST(Posed, StandsInTheAnatomicalPosition) {
  for (int i = 0; i < 6; ++i) {
    Simulation simulation(sharing());
    const Entity person = pose_person(simulation, i);
    const Person made = *simulation.person(person);
    EXPECT_TRUE(made.posed);
    const auto pose = *simulation.get<Pose>(person);
    for (std::size_t s = 0; s < segment_count; ++s) {
      const auto& [x, y, z, w] = pose.rotation[s];
      EXPECT_TRUE(x == 0 && y == 0 && z == 0 && w == 1) << segment_name[s];
      const std::size_t parent = index(segment_parent[s]);
      const Vec3<float> from = parent == s ? Vec3<float>{0, 0, 0} : pose.position_m[parent];
      const Vec3<float> offset = made.body.joint_offset_m[s];
      EXPECT_NEAR(pose.position_m[s].x - from.x, offset.x, 1e-6F) << segment_name[s];
      EXPECT_NEAR(pose.position_m[s].y - from.y, offset.y, 1e-6F) << segment_name[s];
      EXPECT_NEAR(pose.position_m[s].z - from.z, offset.z, 1e-6F) << segment_name[s];
    }
  }
}

/// One invalid number in any segment: the pose stays.
TEST(Posed, InvalidPoseIsRefused) {
  Simulation simulation(sharing());
  const Entity person = pose_person(simulation, 0);
  const auto sound = *simulation.get<Pose>(person);
  ASSERT_EQ(simulation.set_pose(person, sound), Status::ok);
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  for (std::size_t s = 0; s < segment_count; ++s) {
    for (const float bad : {nan, inf, -inf}) {
      Pose<float> pose = sound;
      (s % 3 == 0 ? pose.position_m[s].x : s % 3 == 1 ? pose.position_m[s].y : pose.rotation[s].w) = bad;
      EXPECT_EQ(simulation.set_pose(person, pose), Status::not_valid) << segment_name[s];
    }
    for (const Quat<float>& q :
         {Quat<float>{0, 0, 0, 0}, Quat<float>{0, 0, 0, 2}, Quat<float>{0.1F, 0.2F, 0.3F, 0.4F}}) {
      Pose<float> pose = sound;
      pose.rotation[s] = q;
      EXPECT_EQ(simulation.set_pose(person, pose), Status::not_valid) << segment_name[s];
    }
  }
  const auto now = *simulation.get<Pose>(person);
  EXPECT_EQ(std::memcmp(&now, &sound, sizeof now), 0);
}

/// A walker, and a person of the same body who receives the walker's poses.
struct Couple {
  Simulation walking{sharing()}, posed{sharing()};
  Entity walker, puppet;

  Couple(int i, const LegMuscles& choice)
      : walker(join(walking, sample_person(i), false)), puppet(pose_person(posed, i)) {
    EXPECT_EQ(posed.set_pose(puppet, *walking.get<Pose>(walker)), Status::ok);
    EXPECT_TRUE(walking.set_muscles(walker, choice));
    EXPECT_TRUE(posed.set_muscles(puppet, choice));
  }
  void tick() {
    walking.tick();
    EXPECT_EQ(posed.set_pose(puppet, *walking.get<Pose>(walker)), Status::ok);
    posed.tick();
  }
};

const std::vector<LegMuscles>& choices() {
  static const std::vector<LegMuscles> all = [] {
    std::vector<LegMuscles> some;
    for (const Method method :
         {Method::explicit_central, Method::newmark, Method::statics, Method::modal, Method::none}) {
      some.push_back({.method = method, .modal = {.cells = {2, 2, 8}}, .line_motion = true});
    }
    return some;
  }();
  return all;
}

TEST(Posed, WithAWalkersPosesHasTheWalkersMuscles) {
  for (const LegMuscles& choice : choices()) {
    Couple two(4, choice);
    for (int i = 0; i < 40; ++i) two.tick();
    const auto walkers = muscles_of(two.walking, two.walker), puppets = muscles_of(two.posed, two.puppet);
    ASSERT_EQ(walkers.size(), puppets.size());
    for (std::size_t m = 0; m < walkers.size(); ++m) {
      EXPECT_EQ(hash_row(two.walking.world(), walkers[m], 1), hash_row(two.posed.world(), puppets[m], 1))
          << name(choice.method);
    }
  }
}

TEST(Posed, WithInertiaConvergesToTheWalkersLoads) {
  for (LegMuscles choice : choices()) {
    choice.inertia = true;
    if (choice.method == Method::none) continue;
    Couple two(3, choice);
    for (int i = 0; i < 4; ++i) two.tick();
    const auto walkers = muscles_of(two.walking, two.walker), puppets = muscles_of(two.posed, two.puppet);
    for (std::size_t m = 0; m < walkers.size(); ++m) {
      const auto a = *two.walking.get<FrameLoad>(walkers[m]), b = *two.posed.get<FrameLoad>(puppets[m]);
      EXPECT_EQ(std::memcmp(&a, &b, sizeof a), 0) << name(choice.method);
    }
    for (int i = 0; i < 180; ++i) two.tick();
    Difference d;
    compare(two.walking, two.walker, two.posed, two.puppet, d);
    EXPECT_LT(d.apart, 1e-4) << name(choice.method);
    EXPECT_GT(d.most, 1e-3) << name(choice.method);
  }
}

TEST(Posed, StartsWithGravityOnly) {
  Simulation simulation(sharing());
  const Entity person = pose_person(simulation, 2);
  ASSERT_TRUE(simulation.set_muscles(person, {.inertia = true}));
  for (const Entity muscle : muscles_of(simulation, person)) {
    const auto load = *simulation.get<FrameLoad>(muscle);
    const auto& [x, y, z] = load.constant_to;
    EXPECT_NEAR(std::sqrt(x * x + y * y + z * z), 9.81F, 1e-4F);
    EXPECT_NEAR(load.gradient_to.x.x, 0, 1e-9F);
  }
  for (int i = 0; i < 240; ++i) simulation.tick();  // stands still
  for (const Entity muscle : muscles_of(simulation, person)) {
    EXPECT_LT(simulation.get<BellyReport>(muscle)->kinetic_energy_j, 1e-6F);
  }
}

TEST(Posed, RunsNoGaitAndNoKinematics) {
  Simulation simulation(sharing());
  for (int i = 0; i < 3; ++i) {
    const Entity person = pose_person(simulation, i);
    ASSERT_TRUE(simulation.set_muscles(person));
  }
  for (int i = 0; i < 3; ++i) simulation.tick();
  for (const SystemReport& system : simulation.report().systems) {
    const bool a_persons = system.name == "leg frames" || system.name == "centre of mass";
    const bool theirs = a_persons || system.name == "lines of action" || system.name == "deformation";
    const std::uint64_t each = a_persons ? 1 : 8;  // a person, or a person's muscles
    EXPECT_EQ(system.total_entities, theirs ? 3 * 3 * each : 0) << system.name;
    EXPECT_EQ(system.total_seconds > 0, theirs) << system.name;
  }
}

TEST(Posed, RequestsForAGaitAreRefusedAndChangeNothing) {
  Simulation simulation(sharing());
  const Entity person = pose_person(simulation, 1), walker = join(simulation, sample_person(2), false);
  simulation.tick();
  const auto before = hash_world(simulation);
  EXPECT_TRUE(is_refused(simulation.change_gait(person, {.speed_m_s = 1.0F}), "host"));
  EXPECT_TRUE(is_refused(simulation.turn_to(person, 1), "host"));
  EXPECT_EQ(simulation.enable(person, Feature::step_events), Status::missing);
  EXPECT_EQ(simulation.set_pose(walker, {}), Status::missing);
  EXPECT_EQ(simulation.set_pose({}, {}), Status::stale_entity);
  EXPECT_TRUE(is_refused(simulation.spawn_posed({.height_m = 9.0F})));
  EXPECT_EQ(hash_world(simulation), before);
  EXPECT_EQ(simulation.despawn(person), Status::ok);
  EXPECT_EQ(simulation.set_pose(person, {}), Status::stale_entity);
  EXPECT_EQ(rows(simulation.world()), 1U);
}

TEST(Posed, WithChangedMethodsHasTheWalkersMusclesAtEveryTick) {
  Couple two(5, {.line_motion = true});
  for (int i = 0; i < 4; ++i) two.tick();
  for (const Method method :
       {Method::none, Method::statics, Method::none, Method::modal, Method::newmark, Method::explicit_central}) {
    for (std::size_t m = 0; m < usual_muscle_count; ++m) {
      const MuscleMethod wanted{method, {.modes = 10, .cells = {2, 2, 8}}};
      ASSERT_TRUE(two.walking.set_method(two.walker, static_cast<Muscle>(m), wanted)) << name(method);
      ASSERT_TRUE(two.posed.set_method(two.puppet, static_cast<Muscle>(m), wanted)) << name(method);
    }
    for (int i = 0; i < 20; ++i) {
      two.tick();
      const auto walkers = muscles_of(two.walking, two.walker), puppets = muscles_of(two.posed, two.puppet);
      ASSERT_EQ(walkers.size(), puppets.size());
      for (std::size_t m = 0; m < walkers.size(); ++m) {
        ASSERT_EQ(hash_row(two.walking.world(), walkers[m], 1), hash_row(two.posed.world(), puppets[m], 1))
            << name(method) << ", tick " << i;
      }
    }
    Difference d;
    if (method != Method::none) compare(two.walking, two.walker, two.posed, two.puppet, d);
    EXPECT_EQ(d.apart, 0) << name(method);
    EXPECT_EQ(d.most > 1e-3, method != Method::none) << name(method);  // they do deform
  }
}

/// A standing person, after several changes of method and at rest again.
TEST(Posed, StandingComesToTheSameRestAfterAnyMethods) {
  Simulation changed(sharing()), steady(sharing());
  const Entity a = pose_person(changed, 5), b = pose_person(steady, 5);
  const ModalOptions coarse = {.modes = 10, .cells = {2, 2, 8}};
  ASSERT_TRUE(changed.set_muscles(a, {.inertia = true}));
  ASSERT_TRUE(steady.set_muscles(b, {.method = Method::newmark, .inertia = true}));
  for (const Method method :
       {Method::none, Method::statics, Method::modal, Method::explicit_central, Method::newmark}) {
    for (std::size_t m = 0; m < usual_muscle_count; ++m) {
      ASSERT_TRUE(changed.set_method(a, static_cast<Muscle>(m), {method, coarse})) << name(method);
    }
    for (int i = 0; i < 20; ++i) changed.tick();
  }
  for (int i = 0; i < 180; ++i) changed.tick(), steady.tick();
  Difference d;
  compare(changed, a, steady, b, d);
  EXPECT_LT(d.apart, 2e-5);
  EXPECT_GT(d.most, 1e-2);
}

}  // namespace mobil::posed_test
