// Skin in lanes: equal to plain code, and the same bits on every instruction set.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <span>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/engine/geometry.h>
#include <mobil/engine/world.h>
#include <mobil/simulation.h>
#include <mobil/surfaces.h>
#include <mobil/systems/muscles/person.h>
#include "assets/body/bent_legs.h"
#include "tests/engine/instruction_sets.h"
#include "tests/simulation/people.h"
#include "tests/surfaces/skin_oracle.h"
#include "tests/surfaces/skin_placed.h"

namespace mobil::skin_test {
using namespace geometry;
namespace {

double length_of(const Vec3<double>& v) {
  return std::sqrt(dot(v, v));
}

TEST(SkinLanes, MatchesOneVertexAtATime) {
  Simulation simulation(sharing());
  const Entity one = *simulation.spawn({.height_m = 1.75F, .mass_kg = 75}, {.speed_m_s = 1.6F});
  ASSERT_TRUE(simulation.set_muscles(one));
  const Person person = *simulation.person(one);
  const auto bound = bind_surfaces(person.body, {.bones = false, .sides = {true, false}, .detail = 0.1});
  ASSERT_TRUE(bound);
  std::vector<SurfaceMuscle> muscles;
  for (const PersonMuscle& own : person.muscles) muscles.push_back({own.plan.muscle, own.entity});
  std::vector<Vec3<float>> drawn(bound->vertices);
  SurfaceRequest wanted{one, muscles, &*bound};
  wanted.positions.bytes = std::as_writable_bytes(std::span(drawn));
  SurfaceWriter writer;
  double max_lift = 0;
  for (int tick = 0; tick < 60; ++tick) {
    simulation.tick();
    if (tick % 20 != 19) continue;
    ASSERT_TRUE(writer.write(simulation.world(), {&wanted, 1}));
    const Pose<float> pose = *simulation.get<Pose>(one);
    for (const SkinDetail detail : {SkinDetail::near, SkinDetail::distant}) {
      const BodySkin skin = *make_body_skin(person.body, detail);
      SkinCover cover, plain;
      for (std::size_t count : {drawn.size(), drawn.size() - 3}) {
        cover_muscles(skin, pose, 1, Side::right, std::span(drawn).first(count), cover.lift_m[Side::right]);
        skin_oracle::cover(skin, pose, 1, Side::right, std::span(drawn).first(count), plain.lift_m[Side::right]);
        for (std::size_t n = 0; n < leg_grid_points; ++n) {
          ASSERT_NEAR(cover.lift_m[Side::right][n], plain.lift_m[Side::right][n], 1e-5) << n;
          max_lift = std::max(max_lift, static_cast<double>(cover.lift_m[Side::right][n]));
        }
      }
      for (const SkinCover* over : {static_cast<const SkinCover*>(nullptr), static_cast<const SkinCover*>(&cover)}) {
        const Placed now = place(skin, pose, over);
        const auto exact = skin_oracle::place(skin, pose, over);
        for (std::size_t v = 0; v < exact.size(); ++v) {
          ASSERT_LT(length_of(to_double(now.position[v]) - exact[v][0]), 2e-6) << v;
          ASSERT_LT(length_of(to_double(now.normal[v]) - exact[v][1]), 1e-5) << v;
        }
      }
    }
  }
  EXPECT_GT(max_lift, 0.005);
}

/// Either leg, bent slightly or far, larger than its skin, with NaN and distant vertices among the others.
TEST(SkinLanes, CoversEitherLegInAnyPoseAsPlainCode) {
  const Body body = *make_body({.height_m = 1.75F, .mass_kg = 75});
  const BodySkin skin = *make_body_skin(body, SkinDetail::distant);
  std::mt19937 random(8);
  const auto within = [&](float low, float high) { return std::uniform_real_distribution<float>(low, high)(random); };
  const float inf = std::numeric_limits<float>::infinity(), nan = std::nanf("");
  double max_lift = 0;
  for (int round = 0; round < 60; ++round) {
    const Side side = round % 2 == 0 ? Side::right : Side::left;
    const float lengths = round % 3 == 0 ? 1.0F : 1.1F;
    const BodyRequest taller{.height_m = 1.75F * lengths, .mass_kg = 75};
    const Pose<float> pose = with_bent_legs(*make_body(taller), {within(-20, 100), within(0, 140), within(-45, 30)});
    std::vector<Vec3<float>> cloud, plain;
    for (int i = 0; i < 400; ++i) {
      const std::size_t upper = index(on_side(i % 2 == 0 ? Segment::thigh_right : Segment::shank_right, side));
      const Vec3<float> off{within(-0.09F, 0.09F), within(-0.45F, 0.05F), within(-0.09F, 0.09F)};
      cloud.push_back(pose.position_m[upper] + rotated(pose.rotation[upper], off));
    }
    plain = cloud;
    for (const Vec3<float>& odd : {Vec3<float>{nan, 1, 0}, Vec3<float>{0, inf, 0}, Vec3<float>{0, 0.5F, -inf},
                                   Vec3<float>{3e38F, 3e38F, -3e38F}, Vec3<float>{0, 0.6F, 3e38F}})
      for (std::size_t at : {std::size_t{3}, std::size_t{100}, cloud.size() - 1})
        cloud.insert(cloud.begin() + static_cast<std::ptrdiff_t>(at), odd);
    SkinCover cover, oracle;
    cover_muscles(skin, pose, lengths, side, cloud, cover.lift_m[side]);
    skin_oracle::cover(skin, pose, lengths, side, plain, oracle.lift_m[side]);
    std::size_t off = 0;  // vertices on the border of two rings can be in either
    for (std::size_t n = 0; n < leg_grid_points; ++n) {
      ASSERT_TRUE(std::isfinite(cover.lift_m[side][n]));
      off += std::abs(cover.lift_m[side][n] - oracle.lift_m[side][n]) > 2e-5F ? 1 : 0;
      max_lift = std::max(max_lift, static_cast<double>(cover.lift_m[side][n]));
    }
    EXPECT_LT(off, leg_grid_points / 50) << round;
  }
  EXPECT_GT(max_lift, 0.01);
}

TEST(SkinLanes, HoldsTheSameBitsOnEveryInstructionSet) {
  Simulation simulation(sharing());
  const Entity one = *simulation.spawn({});
  simulation.advance(0.4);
  const Pose<float> pose = *simulation.get<Pose>(one);
  const BodySkin skin = *make_body_skin(simulation.person(one)->body, SkinDetail::far);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> near(-0.15F, 0.15F);
  std::vector<Vec3<float>> cloud(501);  // around the shank and the knee
  for (Vec3<float>& p : cloud)
    p = pose.position_m[index(Segment::shank_right)] + Vec3<float>{near(random), 2 * near(random), near(random)};
  std::vector<Placed> all;
  for_each_fused_instruction_set([&] {
    SkinCover cover;
    cover_muscles(skin, pose, 1, Side::right, cloud, cover.lift_m[Side::right]);
    all.push_back(place(skin, pose, &cover));
  });
  if (all.empty()) GTEST_SKIP() << "no instruction set of this build fuses multiply and add";
  for (const Placed& other : all) {
    EXPECT_EQ(std::memcmp(other.position.data(), all[0].position.data(), other.position.size() * sizeof(Vec3<float>)),
              0);
    EXPECT_EQ(std::memcmp(other.normal.data(), all[0].normal.data(), other.normal.size() * sizeof(Vec3<float>)), 0);
  }
}

}  // namespace
}  // namespace mobil::skin_test
