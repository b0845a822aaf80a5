// Skin over muscles that are not simulated: close to the skin over simulated muscles, in walks that it was not fitted
// to.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/engine/world.h>
#include <mobil/simulation.h>
#include <mobil/skin_tables.h>
#include <mobil/skin_writer.h>
#include <mobil/surfaces.h>
#include <mobil/systems/muscles/person.h>
#include <mobil/systems/surfaces/cover_muscles.h>
#include "assets/body/bent_legs.h"
#include "tests/engine/instruction_sets.h"
#include "tests/labels.h"
#include "tests/simulation/people.h"

MOBIL_TEST_LABELS("long");

namespace mobil::skin_table_test {
namespace {

struct Walker {
  float height_m, mass_kg, speed_m_s;
  Sex sex;
};

TEST(SkinTable, IsNearTheSkinOverMusclesInWalks) {
  SkinTables tables;
  for (const Walker& walker : {Walker{1.75F, 75, 1.35F, Sex::man}, Walker{1.65F, 62, 1.1F, Sex::woman},
                               Walker{1.82F, 95, 1.5F, Sex::man}, Walker{1.72F, 58, 1.3F, Sex::man}}) {
    BodyRequest body{.height_m = walker.height_m, .mass_kg = walker.mass_kg};
    body.sex = walker.sex;
    const auto table = tables.of(body);
    ASSERT_TRUE(table) << table.error().message;
    EXPECT_EQ(*tables.of(body), *table);
    Simulation simulation(sharing());
    const Entity person = *simulation.spawn(body, {.speed_m_s = walker.speed_m_s});
    ASSERT_TRUE(simulation.set_muscles(person));
    const Person subject = *simulation.person(person);
    const auto bound = bind_surfaces(subject.body, {.bones = false, .sides = {true, false}});
    ASSERT_TRUE(bound);
    const BodySkin skin = *make_body_skin(subject.body, SkinDetail::distant);
    std::vector<SurfaceMuscle> muscles;
    for (const PersonMuscle& own : subject.muscles) muscles.push_back({own.plan.muscle, own.entity});
    std::vector<Vec3<float>> drawn(bound->vertices);
    SurfaceRequest wanted{person, muscles, &*bound};
    wanted.positions.bytes = std::as_writable_bytes(std::span(drawn));
    SurfaceWriter writer;
    double square = 0, motion = 0, worst = 0, count = 0;
    std::array<float, leg_grid_points> exact, fitted, first{};
    for (int tick = 0; tick < 180; ++tick) {
      simulation.tick();
      if (tick < 60 || tick % 5 != 0) continue;
      ASSERT_TRUE(writer.write(simulation.world(), {&wanted, 1}));
      const Pose<float> pose = *simulation.get<Pose>(person);
      cover_muscles(skin, pose, 1, Side::right, drawn, exact);
      cover_by_table(**table, leg_angles_of(pose, Side::right), fitted);
      if (tick == 60) first = exact;
      for (std::size_t n = 0; n < leg_grid_points; ++n) {
        const double off = static_cast<double>(fitted[n]) - static_cast<double>(exact[n]),
                     moved = static_cast<double>(exact[n]) - static_cast<double>(first[n]);
        square += off * off;
        motion += moved * moved;
        worst = std::max(worst, std::abs(off));
        count += 1;
      }
    }
    const double rms = std::sqrt(square / count);
    std::printf("[ table ] %.2f m %.0f kg at %.2f m/s: %.2f mm rms off where skin moves by %.2f, worst %.1f mm\n",
                static_cast<double>(walker.height_m), static_cast<double>(walker.mass_kg),
                static_cast<double>(walker.speed_m_s), 1e3 * rms, 1e3 * std::sqrt(motion / count), 1e3 * worst);
    EXPECT_LT(rms, 0.0012);
    EXPECT_LT(rms, 0.5 * std::sqrt(motion / count));
    EXPECT_LT(worst, 0.013);
  }
}

TEST(SkinTable, EvaluatesItsTermsAndModes) {
  SkinTable table;
  for (std::size_t m = 0; m < skin_modes; ++m) {
    for (std::size_t t = 0; t < skin_terms; ++t) table.weight[t][m] = std::cos(static_cast<float>(t * skin_modes + m));
    for (std::size_t n = 0; n < leg_grid_points; ++n)
      table.mode[m][n] = 1e-3F * std::sin(static_cast<float>(m * leg_grid_points + n));
  }
  const Body body = *make_body({});
  const Pose<float> pose = with_bent_legs(body, {30, 60, -15});
  const LegAngles right = leg_angles_of(pose, Side::right), left = leg_angles_of(pose, Side::left);
  EXPECT_NEAR(right.hip, 0.5236, 1e-5);
  EXPECT_NEAR(right.knee, 1.0472, 1e-5);
  EXPECT_NEAR(right.ankle, -0.2618, 1e-5);
  EXPECT_NEAR(left.knee, right.knee, 1e-6);
  const auto value = skin_term_values(right);
  std::vector<std::array<float, leg_grid_points>> all;
  for_each_fused_instruction_set([&] { cover_by_table(table, right, all.emplace_back()); });
  if (all.empty()) cover_by_table(table, right, all.emplace_back());  // without fused multiply-add
  for (const auto& lift : all) EXPECT_EQ(std::memcmp(&lift, all.data(), sizeof lift), 0);
  for (std::size_t n = 0; n < leg_grid_points; ++n) {
    double sum = 0;
    for (std::size_t m = 0; m < skin_modes; ++m)
      for (std::size_t t = 0; t < skin_terms; ++t)
        sum += static_cast<double>(value[t]) * static_cast<double>(table.weight[t][m]) *
               static_cast<double>(table.mode[m][n]);
    ASSERT_NEAR(all[0][n], sum, 1e-8);
  }
  // beyond the poses that a table is made from, it stays at the limit
  EXPECT_EQ(skin_term_values({3, 3, 3}), skin_term_values(max_leg_angles));
}

TEST(SkinTable, MovesOnlyLegsWithoutMuscles) {
  SkinTables tables;
  BodySkins skins;
  Simulation simulation(sharing());
  const Entity person = *simulation.spawn({});
  simulation.advance(0.5);
  const SkinShape shape = *skins.of({}, SkinDetail::far);
  const std::size_t vertices = shape.skin->rest.size();
  std::vector<Vec3<float>> bare(vertices), moved(vertices);
  SkinWriter writer;
  SkinRequest request{person, shape, {std::as_writable_bytes(std::span(bare)), 0}};
  request.positions.stride = sizeof(Vec3<float>);
  ASSERT_TRUE(writer.write(simulation.world(), {&request, 1}));
  request.table = *tables.of({});
  request.positions.bytes = std::as_writable_bytes(std::span(moved));
  ASSERT_TRUE(writer.write(simulation.world(), {&request, 1}));
  const std::vector<LegPlace>& leg = skin_mesh(Sex::man, SkinDetail::far).leg;
  float most = 0;
  for (std::size_t v = 0; v < vertices; ++v) {
    const float off = std::hypot(moved[v].x - bare[v].x, moved[v].y - bare[v].y, moved[v].z - bare[v].z);
    if (leg[v].amount > 0) {
      most = std::max(most, off);
    } else {
      EXPECT_EQ(off, 0) << v;
    }
  }
  EXPECT_GT(most, 0.003F);
  EXPECT_LT(most, 0.05F);
}

TEST(SkinTable, RefusesInvalidBodies) {
  SkinTables tables;
  EXPECT_FALSE(tables.of({.height_m = 9}));
}

}  // namespace
}  // namespace mobil::skin_table_test
