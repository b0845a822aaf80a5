// A camera flies over a crowd, turns and cuts. People far from view sleep.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/components/lod.h>
#include <mobil/engine/world.h>
#include <mobil/lod.h>
#include <mobil/simulation.h>
#include <mobil/systems/muscles/person.h>
#include "demo/scene/crowd_people.h"
#include "engine/row_hash.h"
#include "systems/gait/asleep.h"
#include "systems/gait/gait.h"
#include "tests/interfaces.h"
#include "tests/labels.h"

MOBIL_TEST_LABELS("long");

namespace mobil::lod_sleep_test {
namespace {

constexpr std::size_t everybody = 900;
constexpr float side_m = 120;

/// People and a camera. With `sleep` the scene puts people to sleep, otherwise no person ever sleeps.
struct Scene {
  explicit Scene(bool sleep, int threads = 1, bool muscles = false, std::size_t people_count = everybody)
      : simulation({.threads = threads}) {
    LodOptions options;
    options.machine_factor = 1;
    options.leg_muscles.muscles = MuscleSet(1);
    lod.emplace(lod_of(simulation, options));
    needs.muscles = MuscleSet(1);
    needs.tolerance_px = muscles ? 4.0F : 1e4F;
    if (sleep) needs.asleep_beyond_m = 5;
    look(0);
    std::vector<SpawnRequest> requests;
    for (std::uint64_t number = 0; requests.size() < people_count; ++number) {
      const CrowdPerson person = crowd_person(3, number, 0);
      const auto body = make_body(person.body);
      SpawnRequest request{.body = person.body, .gait = person.gait};
      if (number % 4 != 0) request.gait.style = snapped(person.gait.style);
      if (!body || !resolve_gait(*body, request.gait)) continue;
      const CrowdPlace place = crowd_place(3, number);
      request.x_m = side_m * place.across;
      request.z_m = side_m * place.along;
      request.heading_rad = place.heading_rad;
      if (!sleep) request.parts = managed_parts();
      requests.push_back(request);
    }
    people.resize(requests.size());
    EXPECT_TRUE(simulation.spawn(requests, people));
    changes.resize(people.size());
    if (sleep) {
      EXPECT_EQ(lod->manage_asleep(people).value(), people.size());
    }
  }

  /// Sets the camera of a tick: a new place every five seconds.
  void look(std::uint32_t tick) {
    const std::uint32_t take = tick / 300;
    const float since_s = static_cast<float>(tick % 300) / 60;
    CrowdRandom random(17, take, 1);
    const float yaw = random.even(-3, 3) + 0.4F * std::sin(since_s);
    Viewpoint camera;
    camera.position_m = {random.even(-0.4F, 0.4F) * side_m + 4 * since_s, 3, random.even(-0.4F, 0.4F) * side_m};
    camera.forward = {std::sin(yaw), 0, std::cos(yaw)};
    camera.half_angle_rad = 0.5F;
    camera.radians_per_pixel = 0.0005F;
    camera.near_m = 2;
    camera.reach_m = 30;
    needs.camera = camera;
    ASSERT_TRUE(lod->set_scene(needs));
  }
  LodReport tick() {
    ask();
    look(simulation.ticks());
    simulation.tick();
    return lod->report();
  }
  void ask() {
    std::vector<WalkChange> all;
    for (std::size_t i = 0; i < people.size(); ++i) {
      CrowdRandom random(5, i, simulation.ticks());
      if (random.even(0, 1) > 0.003F) continue;
      const CrowdChange change = crowd_change(3, i, changes[i]++, changes[i] % 6 == 5);
      WalkChange one{people[i], std::nullopt, std::nullopt};
      if (change.speed_m_s >= 0) one.gait = GaitChange{.speed_m_s = change.speed_m_s};
      if (change.turn_rad != 0) one.heading_rad = 3 * change.turn_rad;
      all.push_back(one);
    }
    EXPECT_TRUE(simulation.change_gait(all));
  }
  std::size_t asleep() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(people, [&](Entity e) { return (simulation.state(e) == PersonState::asleep); }));
  }
  /// Returns a hash of gaits, clocks and poses of all people, asleep or not.
  std::uint64_t walks_hash() const {
    std::uint64_t hash = 0;
    const auto add = [&](const auto& row) { hash = mix64(hash ^ hash_bytes(&*row, sizeof(*row))); };
    for (const Entity person : people) {
      add(simulation.get<Gait>(person));
      add(simulation.get<GaitState>(person));
      add(simulation.get<Pose>(person));
    }
    return hash;
  }
  /// Returns true if the camera sees the person, or is near.
  bool sees(Entity person) const {
    const Viewpoint& camera = *needs.camera;
    const Vec3<float> at = simulation.get<Pose>(person)->position_m[0];
    const double x = at.x - camera.position_m.x, y = at.y - camera.position_m.y, z = at.z - camera.position_m.z;
    const double distance = std::sqrt(x * x + y * y + z * z);
    const double along = (x * camera.forward.x + z * camera.forward.z) / distance;
    return distance < camera.near_m || (distance < camera.reach_m && std::acos(along) < camera.half_angle_rad);
  }

  Simulation simulation;
  std::optional<Lod> lod;
  LodScene needs;
  std::vector<Entity> people;
  std::vector<std::uint32_t> changes;
};

TEST(LodSleep, SeenPeopleAreAwake) {
  MOBIL_SLOW();
  Scene scene(true);
  std::size_t seen = 0;
  for (int i = 0; i < 700; ++i) {
    const LodReport report = scene.tick();
    if (report.to_wake > 0 || i % 7 != 0) continue;
    for (const Entity person : scene.people) {
      if (!scene.sees(person)) continue;
      ++seen;
      EXPECT_NE(scene.simulation.state(person), PersonState::asleep) << "tick " << i;
    }
  }
  EXPECT_GT(seen, 1000U);
}

TEST(LodSleep, NearestPeopleWakeFirst) {
  Scene scene(true);
  LodOptions few;
  few.machine_factor = 1;
  few.wakes = 10;
  few.leg_muscles.muscles = MuscleSet(1);
  Lod lod = lod_of(scene.simulation, few);
  ASSERT_TRUE(lod.set_scene(scene.needs));
  std::set<Entity, decltype([](Entity a, Entity b) { return a.index < b.index; })> awake;
  double before = 0;
  std::size_t batches = 0;
  for (;; ++batches) {
    scene.simulation.tick();
    const LodReport report = lod.report();
    double nearest = 1e9, farthest = 0;
    for (const Entity person : scene.people) {
      if ((scene.simulation.state(person) == PersonState::asleep) || awake.contains(person)) continue;
      awake.insert(person);
      if (!scene.sees(person)) continue;
      const Vec3<float> at = scene.simulation.get<Pose>(person)->position_m[0];
      const double d = std::hypot(at.x - scene.needs.camera->position_m.x, at.z - scene.needs.camera->position_m.z);
      nearest = std::min(nearest, d);
      farthest = std::max(farthest, d);
    }
    EXPECT_LE(report.woken, few.wakes);
    if (farthest > 0) {
      EXPECT_GT(nearest, before - 1);  // a walker's pelvis is next to the line
      before = farthest;
    }
    if (report.to_wake == 0) break;
  }
  EXPECT_GT(batches, 2U);
}

TEST(LodSleep, ThreadsDoNotMatter) {
  const auto hashes = [](int threads) {
    Scene scene(true, threads, true);
    scene.needs.compact_unseen = true;
    std::vector<std::uint64_t> all;
    for (int i = 0; i < 360; ++i) {
      scene.tick();
      if (i % 40 == 39) all.push_back(scene.simulation.state_hash());
    }
    return all;
  };
  const auto alone = hashes(1);
  for (const int threads : {2, 3, 8}) EXPECT_EQ(hashes(threads), alone) << threads << " threads";
}

TEST(LodSleep, SnapshotHalfWayContinuesEqually) {
  Scene scene(true, 1, true);
  for (int i = 0; i < 330; ++i) scene.tick();
  EXPECT_GT(scene.asleep(), 0U);
  std::vector<std::byte> bytes(scene.simulation.snapshot_bytes());
  ASSERT_TRUE(scene.simulation.save(bytes));
  const auto changes = scene.changes;
  const auto go_on = [&] {
    std::vector<std::uint64_t> all;
    for (int i = 0; i < 320; ++i) {
      scene.tick();
      if (i % 40 == 39) all.push_back(scene.simulation.state_hash());
    }
    return all;
  };
  const auto first = go_on();
  ASSERT_TRUE(scene.simulation.restore(bytes));
  scene.changes = changes;
  EXPECT_EQ(go_on(), first);
}

TEST(LodSleep, MusclesAreCreatedWhenNeededAndRemovedAgain) {
  Scene scene(true, 1, true);
  std::size_t begun = 0, ended = 0;
  for (int i = 0; i < 900; ++i) {
    const LodReport report = scene.tick();
    begun += report.begun;
    ended += report.ended;
    EXPECT_EQ(report.refused, 0U) << report.refusal;
  }
  EXPECT_GT(begun, 50U);
  EXPECT_GT(ended, 5U);
  std::size_t bare = 0;
  for (const Entity person : scene.people) {
    const bool has = !scene.simulation.muscles(person).empty();
    std::size_t rows = 0;
    scene.simulation.world().each_member(person, [&](Entity) { ++rows; });
    EXPECT_EQ(rows, has ? 2U : 0U) << "one muscle, right and left";
    if (scene.simulation.state(person) == PersonState::asleep) {
      EXPECT_FALSE(has);
      continue;
    }
    const auto lod_state = *scene.simulation.get<LodState>(person);
    if (lod_state.relative_size == 0) continue;  // has just woken
    EXPECT_EQ(has, (lod_state.effects & lod_bare) == 0);
    EXPECT_EQ(scene.simulation.person(person)->leg_muscles.muscles, MuscleSet(1));
    // A method forced by the host applies to the existing muscles, or to those that are then created.
    bare += has ? 0 : 1;
    const MuscleMethod asked = {Method::modal, {.modes = 3}};
    ASSERT_TRUE(scene.lod->force(person, static_cast<Muscle>(0), asked));
    std::size_t forced = 0;
    scene.simulation.world().each_member(person, [&](Entity) { ++forced; });
    EXPECT_EQ(forced, 2U);
    EXPECT_TRUE(same_method(scene.simulation.method(person, static_cast<Muscle>(0)), asked));
  }
  EXPECT_GT(bare, 0U);
}

TEST(LodSleep, RemovedMusclesStayRemoved) {
  Scene scene(true, 1, true);
  for (int i = 0; i < 300; ++i) scene.tick();
  std::vector<Entity> some;
  for (const Entity person : scene.people)
    if (some.size() < 6 && !scene.simulation.muscles(person).empty()) some.push_back(person);
  ASSERT_EQ(some.size(), 6U);
  LegMuscles other;
  other.muscles = MuscleSet(2);
  other.method = Method::none;
  for (const Entity person : some) ASSERT_TRUE(scene.simulation.set_muscles(person, std::nullopt));
  for (const Entity person : std::span(some).first(3)) {
    ASSERT_TRUE(scene.simulation.set_muscles(person, other));
    EXPECT_EQ(scene.simulation.person(person)->leg_muscles.muscles, MuscleSet(2));
  }
  for (int i = 0; i < 600; ++i) scene.tick();
  for (const Entity person : std::span(some).first(3))
    if (scene.simulation.is_person(person)) {
      EXPECT_EQ(scene.simulation.person(person)->leg_muscles.muscles, MuscleSet(2));
      EXPECT_LE(scene.simulation.muscles(person).size(), 1U);
    }
  for (const Entity person : std::span(some).last(3)) {
    EXPECT_TRUE(scene.simulation.muscles(person).empty());
    EXPECT_TRUE(scene.simulation.set_muscles(person, std::nullopt)) << "none are there";
  }
}

TEST(LodSleep, ForcedMethodReachesCompactPeopleWithoutMuscles) {
  Scene scene(true, 1, true);
  scene.needs.compact_unseen = true;
  std::size_t found = 0;
  for (int i = 0; i < 400 && found < 3; ++i) {
    scene.tick();
    for (const Entity person : scene.people) {
      const auto lod_state = scene.simulation.get<LodState>(person);
      if (found > 2 || !lod_state || (scene.simulation.state(person) != PersonState::compact) ||
          (lod_state->effects & lod_bare) == 0 || lod_state->relative_size == 0)
        continue;
      ++found;
      const MuscleMethod asked = {Method::modal, {.modes = 3}}, impossible = {Method::modal, {.modes = 9999}};
      const std::uint64_t before = scene.simulation.state_hash();
      EXPECT_FALSE(scene.lod->force(person, static_cast<Muscle>(0), impossible));
      EXPECT_EQ(scene.simulation.state_hash(), before) << "what is refused changes nobody";
      ASSERT_TRUE(scene.lod->force(person, static_cast<Muscle>(0), asked));
      EXPECT_NE(scene.simulation.state(person), PersonState::compact);
      EXPECT_EQ(scene.simulation.muscles(person).size(), 1U);
      EXPECT_TRUE(same_method(scene.simulation.method(person, static_cast<Muscle>(0)), asked));
    }
  }
  EXPECT_GT(found, 0U);
}

/// Pending muscles start on release, because nothing would start them later.
TEST(LodSleep, ReleasedPeopleHaveTheirMuscles) {
  Scene scene(true, 1, true);
  scene.needs.compact_unseen = true;
  std::size_t asleep = 0, bare = 0, compact = 0;
  for (int i = 0; i < 400 && (compact < 3 || i < 300); ++i) {
    scene.tick();
    for (const Entity person : scene.people) {
      const auto lod_state = scene.simulation.get<LodState>(person);
      if (compact > 2 || !lod_state || (scene.simulation.state(person) != PersonState::compact) ||
          (lod_state->effects & lod_bare) == 0)
        continue;
      ++compact;
      ASSERT_TRUE(scene.lod->release(person));
      EXPECT_EQ(scene.simulation.muscles(person).size(), 1U);
    }
  }
  std::vector<Entity> people;
  for (const Entity person : scene.people) {
    const bool sleeps = (scene.simulation.state(person) == PersonState::asleep);
    const MuscleSet meant = scene.simulation.person(person)->leg_muscles.muscles;
    if (!is_managed(scene.simulation.world(), person) || (scene.simulation.state(person) == PersonState::compact) ||
        meant.none())
      continue;
    if ((sleeps ? asleep : bare) > 4 || (!sleeps && !scene.simulation.muscles(person).empty())) continue;
    ++(sleeps ? asleep : bare);
    people.push_back(person);
  }
  ASSERT_GT(asleep * bare * compact, 0U);
  const std::uint64_t before = scene.simulation.state_hash();
  const std::vector<Entity> twice = {people[0], people[1], people[0]};
  EXPECT_FALSE(scene.lod->release(twice));
  EXPECT_EQ(scene.simulation.state_hash(), before);
  ASSERT_TRUE(scene.lod->release(people));
  for (const Entity person : people) {
    EXPECT_FALSE(is_managed(scene.simulation.world(), person));
    EXPECT_NE(scene.simulation.state(person), PersonState::asleep);
    EXPECT_EQ(scene.simulation.muscles(person).size(), scene.simulation.person(person)->leg_muscles.muscles.count());
    EXPECT_EQ(scene.lod->release(person).error().status, Status::missing);
  }
}

/// An hour with MOBIL_LONG (tests/run --long), else half a minute. Sleepers match people who never slept, on any number
/// of threads. One crowd is restored to its halfway state and continues from there.
TEST(LodSleep, AnHourAsleepIsAnHourAwake) {
  MOBIL_SLOW();
  const int ticks = std::getenv("MOBIL_LONG") != nullptr ? 216'000 : 1800;
  constexpr std::size_t few = 160;
  std::size_t compact = 0;
  Scene wakes(false, 1, false, few);
  std::vector<std::unique_ptr<Scene>> sleep;
  for (const int threads : {1, 2, 3, 8}) {
    sleep.push_back(std::make_unique<Scene>(true, threads, false, few));
    sleep.back()->needs.compact_unseen = true;
  }
  for (int i = 1; i <= ticks; ++i) {
    wakes.tick();
    for (const auto& scene : sleep) scene->tick();
    if (i == ticks / 2) {
      Scene& back = *sleep[1];
      std::vector<std::byte> bytes(back.simulation.snapshot_bytes());
      ASSERT_TRUE(back.simulation.save(bytes));
      const auto changes = back.changes;
      for (int k = 0; k < 200; ++k) back.tick();
      ASSERT_TRUE(back.simulation.restore(bytes));
      back.changes = changes;
    }
    for (const Entity person : sleep[0]->people)
      compact += sleep[0]->simulation.state(person) == PersonState::compact ? 1 : 0;
    if (i % (ticks / 12) != 0) continue;
    const std::uint64_t expected = wakes.walks_hash(), whole = sleep[0]->simulation.state_hash();
    for (const auto& scene : sleep) {
      ASSERT_EQ(scene->walks_hash(), expected) << "tick " << i;
      ASSERT_EQ(scene->simulation.state_hash(), whole) << "tick " << i;
      EXPECT_GT(scene->asleep(), 0U);
      EXPECT_LT(scene->asleep(), few);
    }
  }
  EXPECT_GT(compact, static_cast<std::size_t>(ticks));
}

/// Camera and requests are fixed, so only a change of the scene can wake people.
struct Standing : Scene {
  Standing() : Scene(true) {
    for (int i = 0; i < 60; ++i) update();
  }
  LodReport update() {
    EXPECT_TRUE(lod->set_scene(needs));
    simulation.tick();
    return lod->report();
  }
  std::size_t seen_asleep() const {
    return static_cast<std::size_t>(std::ranges::count_if(
        people, [&](Entity e) { return sees(e) && (simulation.state(e) == PersonState::asleep); }));
  }
};

TEST(LodSleep, WiderViewWakesThePeopleItShows) {
  const auto wider = {+[](Viewpoint& camera) { camera.half_angle_rad = 1.2F; },
                      +[](Viewpoint& camera) { camera.reach_m = 90; }, +[](Viewpoint& camera) { camera.near_m = 25; }};
  for (const auto widen : wider) {
    Standing scene;
    const std::size_t before = scene.asleep();
    widen(*scene.needs.camera);
    EXPECT_GT(scene.seen_asleep(), 15U);
    for (int i = 0; i < 4; ++i) scene.update();
    EXPECT_EQ(scene.seen_asleep(), 0U);
    EXPECT_GT(scene.asleep(), 100U);
    EXPECT_LT(scene.asleep(), before);
  }
}

TEST(LodSleep, AllWakeWhenSleepIsDisabled) {
  for (const bool camera : {true, false}) {
    Standing scene;
    ASSERT_GT(scene.asleep(), 100U);
    scene.needs.asleep_beyond_m.reset();
    if (!camera) scene.needs.camera.reset();
    for (int i = 0; i < 4; ++i) scene.update();
    EXPECT_EQ(scene.asleep(), 0U);
  }
}

TEST(LodSleep, PeopleMarkedAsSeenStayAwake) {
  Standing scene;
  const auto far =
      std::ranges::find_if(scene.people, [&](Entity e) { return (scene.simulation.state(e) == PersonState::asleep); });
  ASSERT_TRUE(far != scene.people.end() && scene.simulation.set_state({&*far, 1}, PersonState::full));
  ASSERT_TRUE(scene.lod->manage(*far, {.looked_at = true}));
  for (int i = 0; i < 120; ++i) scene.update();
  EXPECT_NE(scene.simulation.state(*far), PersonState::asleep);
  ASSERT_TRUE(scene.lod->manage(*far, {}));
  for (int i = 0; i < 120; ++i) scene.update();
  EXPECT_EQ(scene.simulation.state(*far), PersonState::asleep);
}

TEST(LodSleep, ManagedSleepersAreNotManagedAgain) {
  Scene scene(true, 1, true, 20);
  const std::size_t asleep = scene.asleep();
  EXPECT_EQ(scene.lod->manage_asleep(scene.people).error().status, Status::already_there);
  EXPECT_EQ(scene.asleep(), asleep);
  scene.needs.muscles = MuscleSet().set();
  EXPECT_NE(scene.lod->set_scene(scene.needs).error().message.find("muscles"), std::string::npos);
}

TEST(LodSleep, InvalidScenesAreRefused) {
  Scene scene(true);
  LodScene needs;
  needs.asleep_beyond_m = 10;
  EXPECT_FALSE(scene.lod->set_scene(needs));  // without a camera
  needs.camera = scene.needs.camera;
  needs.asleep_beyond_m = 1;
  EXPECT_FALSE(scene.lod->set_scene(needs));
  needs.asleep_beyond_m = NAN;
  EXPECT_FALSE(scene.lod->set_scene(needs));
  needs.asleep_beyond_m = 2;
  EXPECT_TRUE(scene.lod->set_scene(needs));
  const std::vector<Entity> twice = {scene.people[0], scene.people[0]};
  EXPECT_FALSE(scene.lod->manage_asleep(twice));
}

}  // namespace
}  // namespace mobil::lod_sleep_test
