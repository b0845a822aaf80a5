// Requests through the C interface for features of people who sleep or are compact.

#include <vector>

#include "tests/c/c_fixture.h"

namespace mobil::c_absent_test {
namespace {
using namespace c_test;

mobil_muscles unseen_muscles() {
  auto muscles = modal_muscles();
  muscles.control_points = 0;
  return muscles;
}

/// Six people with muscles: two asleep, with forces; two compact; two awake.
struct Absent {
  Absent() {
    const auto muscles = unseen_muscles();
    ids = spawn(sim, 6, &muscles);
    EXPECT_EQ(mobil_enable(sim, ids.data(), 2, MOBIL_FORCES, 1), MOBIL_OK);
    EXPECT_EQ(mobil_tick(sim, 120), MOBIL_OK);
    std::size_t changed = 0;
    EXPECT_EQ(mobil_set_state(sim, ids.data(), 2, MOBIL_ASLEEP, 0, &changed), MOBIL_OK);
    EXPECT_EQ(changed, 2U);
    EXPECT_EQ(mobil_set_state(sim, &ids[2], 2, MOBIL_COMPACT, 0, &changed), MOBIL_OK);
    EXPECT_EQ(changed, 2U);
  }
  Sim sim;
  std::vector<mobil_id> ids;
};

TEST(CAbsent, StateIncludesFeaturesKeptForWaking) {
  const Absent all;
  EXPECT_EQ(bits_of(all.sim, all.ids[0]), MOBIL_ASLEEP | MOBIL_HAS_MUSCLES | MOBIL_HAS_FORCES);
  EXPECT_EQ(bits_of(all.sim, all.ids[2]), MOBIL_COMPACT | MOBIL_HAS_MUSCLES);
  EXPECT_EQ(bits_of(all.sim, all.ids[4]), MOBIL_HAS_MUSCLES);
}

TEST(CAbsent, RemovedMusclesDoNotComeBack) {
  const Absent all;
  ASSERT_EQ(mobil_set_muscles(all.sim, all.ids.data(), 6, nullptr), MOBIL_OK) << all.sim.message();
  ASSERT_EQ(mobil_set_state(all.sim, all.ids.data(), 6, MOBIL_FULL, 0.005F, nullptr), MOBIL_OK);
  for (const mobil_id id : all.ids) EXPECT_EQ(bits_of(all.sim, id) & MOBIL_HAS_MUSCLES, 0);
}

TEST(CAbsent, MusclesAndMethodsCanBeChanged) {
  const Absent all;
  auto others = unseen_muscles();
  others.muscles = 1U << MOBIL_QUADRICEPS;
  ASSERT_EQ(mobil_set_muscles(all.sim, all.ids.data(), 6, &others), MOBIL_OK) << all.sim.message();
  const Absent again;
  auto method = filled<mobil_method>(MOBIL_METHOD);
  method.method = MOBIL_STATIC;
  ASSERT_EQ(mobil_set_method(again.sim, again.ids.data(), 6, MOBIL_HAMSTRINGS, &method), MOBIL_OK)
      << again.sim.message();
  for (std::size_t i = 0; i < 6; ++i) {
    mobil_method is;
    is.size = sizeof is;
    ASSERT_EQ(mobil_get_method(all.sim, all.ids[i], MOBIL_HAMSTRINGS, &is), MOBIL_OK);
    EXPECT_EQ(is.method, MOBIL_NONE);
    ASSERT_EQ(mobil_get_method(all.sim, all.ids[i], MOBIL_QUADRICEPS, &is), MOBIL_OK);
    EXPECT_EQ(is.method, MOBIL_MODAL);
    ASSERT_EQ(mobil_get_method(again.sim, again.ids[i], MOBIL_HAMSTRINGS, &is), MOBIL_OK);
    EXPECT_EQ(is.method, MOBIL_STATIC);
  }
}

TEST(CAbsent, ForcesOfSleepersCanBeChanged) {
  const Absent all;
  ASSERT_EQ(mobil_enable(all.sim, all.ids.data(), 1, MOBIL_FORCES, 0), MOBIL_OK);
  ASSERT_EQ(mobil_enable(all.sim, &all.ids[1], 1, MOBIL_FORCES, 1), MOBIL_OK);
  EXPECT_NE(bits_of(all.sim, all.ids[1]) & MOBIL_ASLEEP, 0);
  ASSERT_EQ(mobil_set_state(all.sim, all.ids.data(), 2, MOBIL_FULL, 0.005F, nullptr), MOBIL_OK);
  EXPECT_EQ(bits_of(all.sim, all.ids[0]) & MOBIL_HAS_FORCES, 0);
  EXPECT_NE(bits_of(all.sim, all.ids[1]) & MOBIL_HAS_FORCES, 0);
}

/// Sleepers that level of detail put to sleep, and whose muscles it keeps for waking.
TEST(CAbsent, MusclesOfManagedSleepersAreOneSet) {
  for (const bool away : {true, false}) {
    const Sim sim;
    const auto muscles = unseen_muscles();
    const auto ids = spawn(sim, 4, &muscles);
    const auto choosing = filled<mobil_lod_options>(MOBIL_LOD_OPTIONS);
    ASSERT_EQ(mobil_lod_set_options(sim, &choosing, &muscles), MOBIL_OK);
    ASSERT_EQ(mobil_lod_manage(sim, ids.data(), 4, nullptr), MOBIL_OK) << sim.message();
    auto scene = filled<mobil_scene>(MOBIL_SCENE);
    scene.has_camera = 1;
    scene.eye[0] = 500;
    scene.gaze[2] = 1;
    scene.asleep_beyond_m = 20;
    ASSERT_EQ(mobil_lod_set_scene(sim, &scene), MOBIL_OK) << sim.message();
    ASSERT_EQ(mobil_tick(sim, 200), MOBIL_OK);
    ASSERT_NE(bits_of(sim, ids[0]) & MOBIL_ASLEEP, 0);
    ASSERT_NE(bits_of(sim, ids[3]) & MOBIL_ASLEEP, 0);
    ASSERT_EQ(mobil_lod_release(sim, &ids[3], 1), MOBIL_OK) << sim.message();
    EXPECT_EQ(bits_of(sim, ids[3]) & (MOBIL_ASLEEP | MOBIL_MANAGED | MOBIL_HAS_MUSCLES), MOBIL_HAS_MUSCLES);
    EXPECT_EQ(mobil_lod_release(sim, &ids[3], 1), MOBIL_MISSING);
    auto others = unseen_muscles();
    others.muscles = 1U << MOBIL_QUADRICEPS;
    const mobil_id twice[] = {ids[0], ids[0], ids[1]};
    ASSERT_EQ(mobil_set_muscles(sim, twice, 3, away ? nullptr : &others), MOBIL_OK) << sim.message();
    ASSERT_EQ(mobil_tick(sim, 100), MOBIL_OK);
    EXPECT_EQ(bits_of(sim, ids[0]) & MOBIL_HAS_MUSCLES, away ? 0 : MOBIL_HAS_MUSCLES);
    ASSERT_EQ(mobil_set_state(sim, ids.data(), 4, MOBIL_FULL, 0.005F, nullptr), MOBIL_OK);
    mobil_method method;
    method.size = sizeof method;
    if (!away) {
      ASSERT_EQ(mobil_set_method(sim, ids.data(), 1, MOBIL_QUADRICEPS, &(method = filled<mobil_method>(MOBIL_METHOD))),
                MOBIL_OK)
          << sim.message();
      ASSERT_EQ(mobil_set_muscles(sim, ids.data(), 1, nullptr), MOBIL_OK) << sim.message();
      EXPECT_EQ(bits_of(sim, ids[0]) & MOBIL_HAS_MUSCLES, 0) << "there was one set";
    }
  }
}

/// A refused request wakes no sleeper.
TEST(CAbsent, OneRefusalChangesNoPerson) {
  const Absent all;
  const auto before = all.sim.hash();
  const auto refused = [&](int code) {
    EXPECT_LT(code, 0);
    EXPECT_EQ(all.sim.hash(), before) << all.sim.message();
  };
  auto wild = unseen_muscles();
  wild.young_pa = -1;
  refused(mobil_set_muscles(all.sim, all.ids.data(), 6, &wild));
  auto method = filled<mobil_method>(MOBIL_METHOD);
  refused(mobil_set_method(all.sim, all.ids.data(), 6, MOBIL_QUADRICEPS, &method));
  method.modes = 40;
  method.method = MOBIL_MODAL;
  refused(mobil_set_method(all.sim, all.ids.data(), 6, MOBIL_HAMSTRINGS, &method));
  const float pull = 0.5F;
  refused(mobil_set_excitation(all.sim, all.ids.data(), 1, MOBIL_HAMSTRINGS, MOBIL_RIGHT, &pull, 0));
  refused(mobil_step_aside(all.sim, all.ids[0], 5, 5));
  const auto choosing = filled<mobil_lod_options>(MOBIL_LOD_OPTIONS);
  ASSERT_EQ(mobil_lod_set_options(all.sim, &choosing, nullptr), MOBIL_OK);
  ASSERT_EQ(mobil_lod_manage(all.sim, all.ids.data(), 6, nullptr), MOBIL_OK) << all.sim.message();
  for (const mobil_id id : all.ids) {
    EXPECT_EQ(bits_of(all.sim, id) & (MOBIL_ASLEEP | MOBIL_COMPACT), 0);
    EXPECT_NE(bits_of(all.sim, id) & MOBIL_MANAGED, 0);
  }
  mobil_lod_counts unfilled{};
  EXPECT_EQ(mobil_lod_report(all.sim, &unfilled), MOBIL_STRUCT);
}

}  // namespace
}  // namespace mobil::c_absent_test
