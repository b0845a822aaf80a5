// Names that 0.5 removes behave as their replacements.

#pragma GCC diagnostic ignored "-Wdeprecated-declarations"

#include <array>

#include "tests/c/c_fixture.h"

namespace mobil::c_deprecated_test {
namespace {
using namespace c_test;

TEST(CDeprecated, OldNamesStillWork) {
  const Sim old, now;
  const auto muscles = modal_muscles();
  auto options = filled<mobil_choosing>(MOBIL_CHOOSING);
  options.machine_factor = 1;
  auto scene = filled<mobil_scene>(MOBIL_SCENE);
  scene.tolerance_m = 0.004F;
  scene.muscles = 1U << static_cast<unsigned>(MOBIL_HAMSTRINGS);
  const float wall[6] = {-2, 0, -9, -2, 0, 50}, disc[7] = {3, 0, 9, 0, 0, 0, 0.3F};
  const auto a = spawn(old, 8), b = spawn(now, 8);
  for (const int code :
       {mobil_start_choosing(old, &options, &muscles), mobil_set_scene(old, &scene),
        mobil_manage(old, a.data(), 4, nullptr), mobil_start_avoidance(old, nullptr), mobil_avoid(old, a.data(), 8, 1),
        mobil_set_walls(old, wall, 0, 1), mobil_set_discs(old, disc, 0, 1), mobil_set_slowing(old, 1),
        mobil_set_on_ground(old, &a[6], 2, 1), mobil_set_forces(old, &a[4], 2, 1),
        mobil_set_fat_wobble(old, &a[4], 2, 1), mobil_watch(old, a.data(), 8, 1)})
    ASSERT_EQ(code, MOBIL_OK) << old.message();
  for (const int code :
       {mobil_lod_set_options(now, &options, &muscles), mobil_lod_set_scene(now, &scene),
        mobil_lod_manage(now, b.data(), 4, nullptr), mobil_avoidance_set_options(now, nullptr),
        mobil_avoidance_manage(now, b.data(), 8, 1), mobil_avoidance_set_walls(now, wall, 0, 1),
        mobil_avoidance_set_discs(now, disc, 0, 1), mobil_terrain_set_speed_scaling(now, 1),
        mobil_terrain_manage(now, &b[6], 2, 1), mobil_enable(now, &b[4], 2, MOBIL_FORCES, 1),
        mobil_enable(now, &b[4], 2, MOBIL_FAT, 1), mobil_enable(now, b.data(), 8, MOBIL_STEP_EVENTS, 1)})
    ASSERT_EQ(code, MOBIL_OK) << now.message();
  const std::array<float, 16> wishes = {1.2F, 0.5F, 1.2F, 0.5F, 1.2F, 0.5F, 1.2F, 0.5F};
  ASSERT_EQ(mobil_want(old, a.data(), 4, wishes.data(), 0), MOBIL_OK) << old.message();
  ASSERT_EQ(mobil_avoidance_set_desired_velocity(now, b.data(), 4, wishes.data(), 0), MOBIL_OK) << now.message();
  std::size_t chose = 0, switched = 0;
  for (int tick = 0; tick < 60; ++tick) {
    auto chosen = filled<mobil_chosen>(MOBIL_CHOSEN);
    auto steered = filled<mobil_steered>(MOBIL_STEERED);
    ASSERT_EQ(mobil_choose(old, &chosen), MOBIL_OK);
    ASSERT_EQ(mobil_steer(old, &steered), MOBIL_OK);
    chose += steered.chose;
    switched += chosen.switched;
    std::size_t count = 0;
    ASSERT_EQ(mobil_ask_ground(old, nullptr, 0, nullptr, 0, &count), MOBIL_OK);
    const std::vector<float> level(4 * count);
    ASSERT_EQ(mobil_answer_ground(old, level.data(), 0, count, nullptr), MOBIL_OK);
    ASSERT_EQ(mobil_terrain_query(now, nullptr, 0, nullptr, 0, &count), MOBIL_OK);
    ASSERT_EQ(mobil_terrain_resolve(now, level.data(), 0, count, nullptr), MOBIL_OK);
    ASSERT_EQ(mobil_tick(old, 1), MOBIL_OK);
    ASSERT_EQ(mobil_tick(now, 1), MOBIL_OK);
  }
  EXPECT_EQ(old.hash(), now.hash());
  EXPECT_GT(chose, 0U);
  EXPECT_GT(switched, 0U);
  EXPECT_EQ(mobil_prepare_scene(nullptr), mobil_lod_prepare(nullptr));
  int bits = 0;
  ASSERT_EQ(mobil_state(old, a[7], &bits), MOBIL_OK);
  EXPECT_EQ(bits, bits_of(now, b[7]));
  mobil_way_figures way;
  EXPECT_EQ(mobil_way(0, 0, 1.4F, 1.8F, 0, 0, &way), MOBIL_OK);
  char line[99];
  EXPECT_EQ(mobil_why(old, a[0], MOBIL_HAMSTRINGS, line, sizeof line, nullptr, nullptr), MOBIL_OK) << old.message();
  EXPECT_EQ(mobil_release(old, a.data(), 4), MOBIL_OK) << old.message();
}

TEST(CDeprecated, WakingAndExpandingAreSeparate) {
  const Sim sim;
  const auto ids = spawn(sim, 4);
  ASSERT_EQ(mobil_tick(sim, 120), MOBIL_OK);
  std::size_t changed = 0;
  ASSERT_EQ(mobil_sleep(sim, ids.data(), 2, &changed), MOBIL_OK);
  EXPECT_EQ(changed, 2U);
  ASSERT_EQ(mobil_compact(sim, &ids[2], 2, &changed), MOBIL_OK);
  EXPECT_EQ(changed, 2U);
  ASSERT_EQ(mobil_wake(sim, ids.data(), 4, 0.005F), MOBIL_OK);
  EXPECT_EQ(bits_of(sim, ids[0]), MOBIL_FULL);
  EXPECT_EQ(bits_of(sim, ids[2]), MOBIL_COMPACT);
  ASSERT_EQ(mobil_sleep(sim, ids.data(), 2, nullptr), MOBIL_OK);
  ASSERT_EQ(mobil_expand(sim, ids.data(), 4), MOBIL_OK);
  EXPECT_EQ(bits_of(sim, ids[0]), MOBIL_ASLEEP);
  EXPECT_EQ(bits_of(sim, ids[2]), MOBIL_FULL);
  const mobil_id gone = {99, 9};
  EXPECT_EQ(mobil_wake(sim, &gone, 1, 0.005F), MOBIL_STALE);
}

}  // namespace
}  // namespace mobil::c_deprecated_test
