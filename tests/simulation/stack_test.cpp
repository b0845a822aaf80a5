// Every call works on a thread with 128 kB of stack, which is the default of musl and of many job systems.

#include <gtest/gtest.h>
#include <pthread.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/lod.h>
#include <mobil/muscle_library.h>
#include <mobil/pose_writer.h>
#include <mobil/skin_tables.h>
#include <mobil/skin_writer.h>
#include <mobil/surfaces.h>
#include <mobil/systems/muscles/person.h>
#include <mobil/systems/poses/roots.h>
#include "tests/labels.h"
#include "tests/simulation/crowd_play.h"

MOBIL_TEST_LABELS("long");

namespace mobil::stack_test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool frames_as_released = false;
#else
constexpr bool frames_as_released = true;
#endif

constexpr std::size_t stack_bytes = 1U << 20U, promised_bytes = 128 * 1024, own_bytes = 16 * 1024;

/// Returns the stack that `work` touches on a thread of its own, bytes. It includes the thread's own data.
std::size_t stack_of(const std::function<void()>& work) {
  struct Free {
    void operator()(void* memory) const { std::free(memory); }
  };
  const std::unique_ptr<void, Free> memory(std::aligned_alloc(4096, stack_bytes));
  const std::span stack(static_cast<unsigned char*>(memory.get()), stack_bytes);
  std::ranges::fill(stack, static_cast<unsigned char>(0xA5));
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  EXPECT_EQ(pthread_attr_setstack(&attributes, stack.data(), stack.size()), 0);
  pthread_t thread{};
  const auto run = [](void* argument) -> void* {
    (*static_cast<const std::function<void()>*>(argument))();
    return nullptr;
  };
  EXPECT_EQ(pthread_create(&thread, &attributes, run, const_cast<std::function<void()>*>(&work)), 0);
  pthread_join(thread, nullptr);
  pthread_attr_destroy(&attributes);
  const auto touched = std::ranges::find_if(stack, [](unsigned char byte) { return byte != 0xA5; });
  return static_cast<std::size_t>(stack.end() - touched);
}

void expect_small(const std::string& name, const std::function<void()>& work) {
  const std::size_t bytes = stack_of(work);
  testing::Test::RecordProperty(name, std::to_string(bytes));
  if (std::getenv("MOBIL_LONG") != nullptr) std::printf("%8zu  %s\n", bytes, name.c_str());
  EXPECT_LE(bytes, promised_bytes - own_bytes) << name;
}

/// Runs all bodies in the calling thread.
SimulationOptions alone() {
  return {.jobs = Jobs{}};
}

TEST(Stack, EachCallLeavesRoom) {
  if (!frames_as_released) GTEST_SKIP() << "sanitizers enlarge frames";
  std::unique_ptr<Simulation> made;
  expect_small("make", [&] { made = std::make_unique<Simulation>(alone()); });
  Simulation& simulation = *made;
  Entity one, posed;
  std::vector<Entity> many(40);
  expect_small("spawn", [&] { one = *simulation.spawn({.height_m = 1.8F}, {.speed_m_s = 1.4}); });
  expect_small("spawn with a style", [&] {
    GaitRequest gait{.speed_m_s = 1.2};
    gait.style.step_width_h = 0.09F;
    gait.style.toe_out_deg = 15;
    EXPECT_TRUE(simulation.spawn({.height_m = 1.6F}, gait));
  });
  expect_small("spawn posed", [&] { posed = *simulation.spawn_posed({}); });
  expect_small("spawn many", [&] {
    EXPECT_TRUE(simulation.spawn(std::vector<SpawnRequest>(many.size()), many));
  });
  expect_small("enable forces", [&] { EXPECT_TRUE(simulation.enable(many, Feature::forces)); });
  expect_small("enable posed forces", [&] { EXPECT_TRUE(simulation.enable(posed, Feature::forces)); });
  expect_small("enable fat", [&] { EXPECT_TRUE(simulation.enable(many, Feature::fat)); });
  expect_small("enable step events", [&] { EXPECT_TRUE(simulation.enable(many, Feature::step_events)); });
  std::size_t i = 0;
  for (const MuscleMethod& method : play::every_method()) {
    for (const bool effects : {false, true}) {
      LegMuscles choice;
      choice.method = method.method;
      choice.modal = method.modal;
      choice.inertia = effects;
      if (effects) choice.activation = i % 2 == 0 ? ExcitationSource::phase : ExcitationSource::moments;
      const auto name = "muscles " + std::to_string(i) + (effects ? " with effects" : "");
      const std::span whose = std::span(many).subspan(i, 1);
      expect_small(name, [&] { EXPECT_TRUE(simulation.set_muscles(whose, choice)); });
      expect_small(name + " again", [&] { EXPECT_TRUE(simulation.set_muscles(posed, choice)); });
      ++i;
    }
  }
  expect_small("change method", [&] {
    EXPECT_TRUE(simulation.set_method(many[0], Muscle::hamstrings, play::every_method()[4]));
  });
  simulation.terrain().set_heights([](std::span<const TerrainQuery>, std::span<TerrainHeight> out) {
    std::ranges::fill(out, TerrainHeight{});
  });
  expect_small("manage ground", [&] { EXPECT_TRUE(simulation.terrain().manage(many)); });
  expect_small("manage avoidance", [&] { EXPECT_TRUE(simulation.avoidance().manage(many)); });
  expect_small("tick", [&] { simulation.tick(30); });
  Pose<float> pose = *simulation.get<Pose>(posed);
  expect_small("set pose", [&] { EXPECT_TRUE(simulation.set_pose(posed, pose)); });
  expect_small("tick after a pose", [&] { simulation.tick(5); });
  expect_small("set gait", [&] { EXPECT_TRUE(simulation.set_gait(many[1], {.speed_m_s = 1.9})); });
  expect_small("change gait", [&] { EXPECT_TRUE(simulation.change_gait(many[2], {.speed_m_s = 0.6})); });
  expect_small("turn", [&] { EXPECT_TRUE(simulation.turn_to(many[3], 1)); });
  expect_small("place", [&] { EXPECT_TRUE(simulation.place(many[4], 30, 40, 1)); });
  expect_small("shift origin", [&] { EXPECT_TRUE(simulation.shift_origin(64, 64)); });
  expect_small("person", [&] { EXPECT_TRUE(simulation.person(many[1])); });
  expect_small("sleep", [&] { EXPECT_TRUE(simulation.set_state(std::span(many).last(9), PersonState::asleep)); });
  expect_small("tick with sleepers", [&] { simulation.tick(5); });
  std::vector<Root> roots(many.size());
  expect_small("roots", [&] { EXPECT_TRUE(simulation.roots(many, roots, 0.01)); });
  expect_small("wake", [&] { EXPECT_TRUE(simulation.set_state(many, PersonState::full)); });
  expect_small("compact", [&] { EXPECT_TRUE(simulation.set_state(std::span(many).last(9), PersonState::compact)); });
  expect_small("tick with compact people", [&] { simulation.tick(5); });
  std::vector<std::byte> bytes;
  expect_small("save", [&] {
    bytes.resize(simulation.snapshot_bytes());
    EXPECT_TRUE(simulation.save(bytes));
  });
  expect_small("restore", [&] { EXPECT_TRUE(simulation.restore(bytes)); });
  expect_small("restore into another", [&] { EXPECT_TRUE(Simulation(alone()).restore(bytes)); });
  expect_small("hash", [&] { EXPECT_NE(simulation.state_hash(), 0U); });
  std::vector<std::byte> baked;
  expect_small("bake", [&] { baked = simulation.muscle_library().bake(); });
  expect_small("load", [&] { EXPECT_TRUE(Simulation(alone()).muscle_library().load(baked)); });
  expect_small("despawn", [&] { EXPECT_TRUE(simulation.despawn(many)); });
}

TEST(Stack, LevelOfDetailLeavesRoom) {
  if (!frames_as_released) GTEST_SKIP() << "sanitizers enlarge frames";
  Simulation simulation(alone());
  std::vector<Entity> many(40);
  ASSERT_TRUE(simulation.spawn(std::vector<SpawnRequest>(many.size()), many));
  Lod lod = simulation.lod();
  expect_small("lod options", [&] { EXPECT_TRUE(lod.set_options({})); });
  expect_small("lod scene", [&] { EXPECT_TRUE(lod.set_scene({.tolerance_m = 0.01F})); });
  expect_small("lod prepare", [&] { EXPECT_TRUE(lod.prepare()); });
  expect_small("lod manage", [&] { EXPECT_TRUE(lod.manage(many)); });
  expect_small("tick", [&] { simulation.tick(60); });
}

TEST(Stack, WritersLeaveRoom) {
  if (!frames_as_released) GTEST_SKIP() << "sanitizers enlarge frames";
  Simulation simulation(alone());
  const Entity person = *simulation.spawn({});
  ASSERT_TRUE(simulation.set_muscles(person));
  simulation.tick();
  std::optional<BodySurfaces> bound;
  expect_small("bind surfaces", [&] { bound = *bind_surfaces(make_body({}).value()); });
  std::vector<std::byte> buffer(24 * std::size_t{bound->vertices});
  std::vector<SurfaceMuscle> muscles;
  const Person built = *simulation.person(person);
  for (const auto& own : built.muscles) muscles.push_back({own.plan.muscle, own.entity});
  const auto fit = fit_surfaces(*bound, built.body);
  expect_small("write surfaces", [&] {
    const SurfaceRequest request{person, muscles, &*bound, {buffer, 24}, {std::span(buffer).subspan(12), 24}, {}, &fit};
    SurfaceWriter writer;
    EXPECT_TRUE(writer.write(simulation.world(), {&request, 1}));
  });
  BodySkins skins;
  std::optional<SkinShape> shape;
  expect_small("skin", [&] { shape = *skins.of({}, SkinDetail::near); });
  expect_small("write skin", [&] {
    std::vector<std::byte> vertices(24 * shape->skin->rest.size());
    const SkinRequest request{person, *shape, {vertices, 24}, {std::span(vertices).subspan(12), 24}};
    SkinWriter writer;
    EXPECT_TRUE(writer.write(simulation.world(), {&request, 1}));
  });
  SkinTables tables;
  expect_small("skin table", [&] { EXPECT_TRUE(tables.of({})); });
  expect_small("write poses", [&] {
    std::vector<std::byte> poses(sizeof(float) * 16 * segment_count);
    PoseWriter writer;
    EXPECT_TRUE(writer.write(simulation.world(), {&person, 1}, 0.01, {}, {poses}));
  });
}

}  // namespace mobil::stack_test
