// Foot placement near edges.

#include "systems/terrain/sole_fit.h"
#include "tests/labels.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/terrain/hike.h"

MOBIL_TEST_LABELS("slow");

namespace mobil {
namespace {

constexpr float height_m = 1.75F;

/// Returns a slope with or without an edge, and the sole above it:
///
///                         __________ high_m
///       heel  ankle      |      toes
///        |______|________|_______|
///      __________________|               edge_m: ahead of the ankle
SoleGround ground_of(float rise, float edge_m, float high_m) {
  SoleGround ground;
  for (std::size_t i = 0; i < SoleGround::places; ++i) {
    const float ahead_m = SoleGround::ahead_h(i) * height_m;
    ground.height_m[i] = rise * ahead_m + (ahead_m > edge_m ? high_m : 0);
    ground.rise[i] = rise;
  }
  return ground;
}

/// Returns the length of sole that reaches over the edge: the shorter side, m.
float over_m(float edge_m, float moved_m) {
  const float heel = moved_m - SoleGround::back_h * height_m, toes = moved_m + SoleGround::front_h * height_m;
  return std::max(std::min(edge_m - heel, toes - edge_m), 0.0F);
}

RC_GTEST_PROP(SoleFit, ReducesOverhangAndStaysAboveGround, ()) {
  const float rise = 0.01F * static_cast<float>(*rc::gen::inRange(-30, 30));
  const float edge_m = 0.001F * static_cast<float>(*rc::gen::inRange(-400, 400));
  const float high_m = (*rc::gen::inRange(0, 2) == 0 ? -0.01F : 0.01F) * static_cast<float>(*rc::gen::inRange(5, 25));
  const float step_m = *rc::gen::inRange(0, 2) == 0 ? 0.3F : 0.7F;
  const SoleGround ground = ground_of(rise, edge_m, high_m);
  const SoleFit fit = fit_sole(ground, height_m, step_m);
  const float place_m = SoleGround::apart_h * height_m;
  RC_ASSERT(std::fabs(fit.ahead_m) < (step_m < 0.4F ? 2.01F : 1.01F) * place_m);
  RC_ASSERT(over_m(edge_m, fit.ahead_m) <= over_m(edge_m, 0) + 1e-5F);
  // The plane of the foot is nowhere below the ground.
  for (std::size_t i = 0; i < SoleGround::places; ++i) {
    const float from_ankle_m = SoleGround::ahead_h(i) * height_m - fit.ahead_m;
    if (from_ankle_m < -SoleGround::back_h * height_m - 1e-5F || from_ankle_m > SoleGround::front_h * height_m + 1e-5F)
      continue;
    RC_ASSERT(fit.height_m + rise * from_ankle_m >= ground.height_m[i] - 1e-4F);
  }
}

RC_GTEST_PROP(SoleFit, WithoutEdgesNoFootIsMoved, ()) {
  const float rise = 0.01F * static_cast<float>(*rc::gen::inRange(-100, 100));
  const SoleFit fit = fit_sole(ground_of(rise, 10, 0), height_m, 0.3F);
  RC_ASSERT(fit.ahead_m == 0);
  RC_ASSERT(std::fabs(fit.height_m) < 1e-4F);
}

/// For any phase of steps on stairs and kerbs, feet stand on one level with all of the sole except a few centimetres,
/// and motion has no jumps.
TEST(SoleFit, FeetComeDownClearOfEdges) {
  struct Way {
    const char* name;
    HeightOf ground;
    GaitRequest gait;
    float apart_m, max_over_m, max_hips;
  };
  const auto kerb = [](float high_m) {
    return [=](float, float z) { return TerrainHeight{z > 2 ? high_m : 0, 0, 0}; };
  };
  for (const Way& way :
       {Way{"up", stairs(0.15F, 0.32F, 9), {.speed_m_s = 0.55F, .step_length_m = 0.32F}, 0.032F, 0.05F, 33},
        {"down", stairs(-0.15F, 0.32F, 9), {.speed_m_s = 0.55F, .step_length_m = 0.32F}, 0.032F, 0.05F, 33},
        {"a kerb up", kerb(0.15F), {.speed_m_s = 1.2F}, 0.066F, 0.082F, 33},
        {"a kerb down", kerb(-0.15F), {.speed_m_s = 1.2F}, 0.066F, 0.082F, 33}}) {
    double over_m = 0, hips = 0;
    for (int start = 0; start < 10; ++start) {
      Hike hike(way.ground, way.gait, {.height_m = 1.70F, .mass_kg = 70}, 1.0 / 240,
                -0.9F - way.apart_m * static_cast<float>(start));
      Vec3<float> pelvis[3] = {};
      for (int t = 0; t < 240 * 6; ++t) {
        hike.tick();
        pelvis[0] = pelvis[1], pelvis[1] = pelvis[2], pelvis[2] = hike.get<Pose>().position_m[0];
        if (t > 2)
          hips = std::max(hips,
                          std::fabs(double{pelvis[0].y} - 2 * double{pelvis[1].y} + double{pelvis[2].y}) * 240 * 240);
        const GaitState<float> state = hike.get<GaitState>();
        if (state.time_s < 0.2F || state.time_s > 0.22F) continue;  // once a step, when the foot is flat
        const Feet<float> feet = hike.get<Feet>();
        const float heel = feet.heel_m[state.stance_side].z, sole_m = feet.tip_m[state.stance_side].z - heel;
        for (float part = 0.01F; part <= 1; part += 0.01F) {
          const float before_m = hike.ground(0, heel + (part - 0.01F) * sole_m).height_m;
          if (std::fabs(hike.ground(0, heel + part * sole_m).height_m - before_m) > 0.05F)
            over_m = std::max(over_m, double{std::min(part, 1 - part) * sole_m});
        }
      }
    }
    std::printf("%s: %.1f cm over an edge at most, hips %.0f m/s2\n", way.name, 100 * over_m, hips);
    EXPECT_LT(over_m, way.max_over_m) << way.name;
    EXPECT_LT(hips, way.max_hips) << way.name;
  }
}

/// The centre of pressure is under the sole, on stairs as well.
TEST(SoleFit, CentresOfPressureAreUnderTheSole) {
  Hike hike(stairs(0.15F, 0.32F, 9), {.speed_m_s = 0.55F, .step_length_m = 0.32F}, {.height_m = 1.70F, .mass_kg = 70},
            1.0 / 60, -1.1F);
  for (int t = 0; t < 600; ++t) {
    hike.tick();
    const GroundReaction<float> ground = hike.get<GroundReaction>();
    const Feet<float> feet = hike.get<Feet>();
    for (std::size_t side = 0; side < 2; ++side) {
      if (!(ground.force_n[side].y > 50)) continue;
      EXPECT_GT(ground.centre_m[side].z, feet.heel_m[side].z - 0.01F);
      EXPECT_LT(ground.centre_m[side].z, feet.tip_m[side].z + 0.01F);
    }
  }
}

/// A person who stands at an edge stands still.
TEST(SoleFit, StandingAtAnEdgeIsStill) {
  for (int k = 0; k < 15; ++k) {
    const float edge_m = -0.1F + 0.02F * static_cast<float>(k);
    Hike hike([=](float, float z) { return TerrainHeight{z > edge_m ? 0.15F : 0, 0, 0}; }, {.speed_m_s = 0.0F});
    hike.tick();
    const Vec3<float> before = hike.get<Pose>().position_m[0];
    for (int t = 0; t < 120; ++t) {
      hike.tick();
      const Vec3<float> now = hike.get<Pose>().position_m[0];
      ASSERT_NEAR(now.z, before.z, 0.003F) << edge_m;
      ASSERT_NEAR(now.y, before.y, 0.003F) << edge_m;
    }
  }
}

}  // namespace
}  // namespace mobil
