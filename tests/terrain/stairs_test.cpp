// Walkers on slopes, hills, kerbs and stairs: close to measurements, and smooth.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <mobil/components/gait.h>
#include <mobil/components/pose.h>
#include <mobil/components/step_plan.h>
#include <mobil/forces.h>
#include "tests/terrain/hike.h"
#include "tests/terrain/measured_stairs.h"

namespace mobil {
namespace {

constexpr double degrees = 57.29577951308232;

/// Root mean square difference over a stride, deg.
struct Off {
  double thigh = 0, knee = 0, ankle = 0;
};

/// Returns the difference for a person of the measured height, from the strike on the last stair but one to that foot's
/// next strike, on the floor. It is the smallest over all times that a step can take.
Off off_stairs(bool up) {
  constexpr float step_m = 0.30F, rise_m = 0.16F, step_s = 0.55F, ankle_on_tread_m = 0.05F, ankle_down_m = 0.10F;
  const bovi::Stride& measured = up ? bovi::ascending : bovi::descending;
  const float edge = up ? ankle_on_tread_m : ankle_down_m;
  // Footholds are at multiples of the step length. The first stair is under the eleventh.
  const HeightOf flight = stairs(up ? rise_m : -rise_m, step_m, 3);
  const HeightOf ground = [=](float x, float z) { return flight(x, z - 11 * step_m + edge); };
  Hike hike(ground, {.step_length_m = step_m, .step_frequency_hz = 1 / step_s}, {.height_m = 1.47F, .mass_kg = 41},
            step_s / 40);
  Off off;
  std::array<double, bovi::instants> thigh{}, knee{}, ankle{};
  std::size_t instant = 0, side = 2;
  std::uint32_t first = 0;
  double mean = 0;
  while (instant < bovi::instants) {
    const GaitState<float> state = hike.get<GaitState>();
    const bool there = state.line_z_m > 11.5F * step_m && state.line_z_m < 12.5F * step_m;
    if (side == 2 && there) side = state.stance_side, first = state.steps;
    if (side != 2) {
      const double part = (state.steps - first) + double{state.time_s} / double{hike.get<StepPlan>().duration_s};
      if (part >= 0.1 * static_cast<double>(instant) - 1e-6) {
        const JointAngles<float> angles = hike.get<JointAngles>();
        const Quat<float> q = hike.get<Pose>().rotation[index(on_side(Segment::thigh_right, side))];
        const double ahead = -2 * (double{q.y} * double{q.z} + double{q.w} * double{q.x});
        const double down = 1 - 2 * (double{q.x} * double{q.x} + double{q.z} * double{q.z});
        thigh[instant] = std::atan2(ahead, down) * degrees;
        knee[instant] = double{angles.knee_flexion[side]} * degrees;
        ankle[instant] = double{angles.ankle_dorsiflexion[side]} * degrees;
        mean += ankle[instant] / bovi::instants;
        ++instant;
      }
    }
    hike.tick();
  }
  for (std::size_t i = 0; i < bovi::instants; ++i) {
    off.thigh += std::pow(thigh[i] - measured.thigh[i], 2) / bovi::instants;
    off.knee += std::pow(knee[i] - measured.knee[i], 2) / bovi::instants;
    off.ankle += std::pow(ankle[i] - mean - measured.ankle[i], 2) / bovi::instants;
  }
  return {std::sqrt(off.thigh), std::sqrt(off.knee), std::sqrt(off.ankle)};
}

TEST(Terrain, StairAnglesMatchMeasuredPeople) {
  for (const bool up : {true, false}) {
    const Off off = off_stairs(up);
    std::printf("%s: thigh %.1f, knee %.1f, ankle %.1f deg rms\n", up ? "up" : "down", off.thigh, off.knee, off.ankle);
    EXPECT_LT(off.thigh, 10);
    EXPECT_LT(off.knee, 11);
    EXPECT_LT(off.ankle, 11);
  }
}

/// Motion has no jumps, and the ankle of the loaded foot keeps within its limits.
TEST(Terrain, HillsKerbsAndStairsAreSmooth) {
  const struct {
    const char* name;
    HeightOf ground;
    GaitRequest gait;
    float start_z_m = 0;
  } ways[] = {
      {"hills",
       [](float x, float z) {
         constexpr float a = 0.2F;
         return TerrainHeight{a * std::sin(z) * std::cos(x), -a * std::sin(z) * std::sin(x),
                              a * std::cos(z) * std::cos(x)};
       },
       {.speed_m_s = 1.2F}},
      {"a slope up", plane(0, 0.1F), {.speed_m_s = 1.2F}},
      {"a slope down", plane(0, -0.2F), {.speed_m_s = 1.2F}},
      {"a kerb up",
       [](float, float z) {
         return TerrainHeight{z > 4 ? 0.15F : 0, 0, 0};
       },
       {.speed_m_s = 1.2F}},
      {"a kerb down",
       [](float, float z) {
         return TerrainHeight{z > 4 ? -0.15F : 0, 0, 0};
       },
       {.speed_m_s = 1.2F}},
      {"stairs up", stairs(0.17F, 0.30F, 20), {.speed_m_s = 0.5F, .step_length_m = 0.30F}, 0.05F},
      {"stairs down", stairs(-0.17F, 0.30F, 20), {.speed_m_s = 0.5F, .step_length_m = 0.30F}, 0.10F},
  };
  for (const auto& [name, ground, gait, start_z_m] : ways) {
    Hike hike(ground, gait, {.height_m = 1.75F, .mass_kg = 75}, 1.0 / 240, start_z_m);
    std::array<Vec3<float>, 3> pelvis{};
    double fastest = 0, highest = 0, ankle = 0, knee = 0;
    JointAngles<float> before = hike.get<JointAngles>();
    for (int t = 0; t < 240 * 10; ++t) {
      hike.tick();
      std::rotate(pelvis.begin(), pelvis.begin() + 1, pelvis.end());
      pelvis[2] = hike.get<Pose>().position_m[0];
      if (t > 2)
        highest = std::max(highest,
                           std::fabs(double{pelvis[0].y} - 2 * double{pelvis[1].y} + double{pelvis[2].y}) * 240 * 240);
      const JointAngles<float> now = hike.get<JointAngles>();
      const std::uint32_t stance = hike.get<GaitState>().stance_side;
      for (std::size_t side = 0; side < 2; ++side) {
        fastest = std::max(fastest, std::fabs(double{now.knee_flexion[side] - before.knee_flexion[side]}) * 240);
        knee = std::max(knee, double{now.knee_flexion[side]} * degrees);
      }
      ankle = std::max(ankle, double{now.ankle_dorsiflexion[stance]} * degrees);
      before = now;
    }
    std::printf("%s: knees %.1f rad/s and %.0f deg, ankle %.0f deg, hips %.1f m/s2\n", name, fastest, knee, ankle,
                highest);
    EXPECT_LT(fastest, 20) << name;  // measured knees swing at 7 rad/s
    EXPECT_LT(highest, 33) << name;
    EXPECT_LT(ankle, 41) << name;
    EXPECT_LT(knee, 112) << name;
  }
}

/// The edge is anywhere within a step. A foot that lands just behind it passes through it, but not deeper than the
/// bound.
TEST(Terrain, KneesAndAnklesKeepLimitsDownAnyKerb) {
  struct Kerb {
    float high_m, speed_m_s, knee, ankle;
  };
  for (const auto& [high_m, speed_m_s, max_knee, max_ankle] :
       {Kerb{0.15F, 1.2F, 114, 37}, {0.15F, 1.6F, 114, 37}, {0.20F, 1.2F, 125, 42.5}}) {
    double knee = 0, ankle = 0;
    float through_m = 0;
    for (int place = 0; place < 24; ++place) {
      const float edge_m = 4 + 0.03F * static_cast<float>(place);
      const auto kerb = [=, high = high_m](float, float z) { return TerrainHeight{z > edge_m ? -high : 0, 0, 0}; };
      Hike hike(kerb, {.speed_m_s = speed_m_s}, {.height_m = 1.75F, .mass_kg = 75}, 1.0 / 120);
      while (hike.get<GaitState>().line_z_m < edge_m + 1.5F) {
        hike.tick();
        const JointAngles<float> now = hike.get<JointAngles>();
        const Feet<float> feet = hike.get<Feet>();
        const std::uint32_t stance = hike.get<GaitState>().stance_side;
        for (const float flexion : now.knee_flexion) knee = std::max(knee, double{flexion} * degrees);
        ankle = std::max(ankle, double{now.ankle_dorsiflexion[stance]} * degrees);
        for (const Vec3<float>& p : {feet.heel_m[stance ^ 1U], feet.toe_m[stance ^ 1U], feet.tip_m[stance ^ 1U]})
          if (p.y < hike.ground(p.x, p.z).height_m - 0.01F) through_m = std::max(through_m, edge_m - p.z);
      }
    }
    std::printf("down %.0f cm at %.1f m/s: knee %.0f deg, ankle %.0f deg, %.0f cm through the edge\n",
                100 * double{high_m}, double{speed_m_s}, knee, ankle, 100 * double{through_m});
    EXPECT_LT(knee, max_knee);
    EXPECT_LT(ankle, max_ankle);
    EXPECT_LT(through_m, 0.13F);
  }
}

TEST(Terrain, ForcesCarryTheBodyAndPressOnTheGround) {
  for (const float grade : {-0.1F, 0.1F}) {
    Hike hike(plane(0, grade), {.speed_m_s = 1.2F});
    double up = 0, ahead = 0;
    constexpr int ticks = 600;
    for (int t = 0; t < ticks; ++t) {
      hike.tick();
      const GroundReaction<float> ground = hike.get<GroundReaction>();
      for (std::size_t side = 0; side < 2; ++side) {
        up += double{ground.force_n[side].y} / ticks;
        ahead += double{ground.force_n[side].z} / ticks;
        if (ground.force_n[side].y < 50) continue;
        const Vec3<float>& at = ground.centre_m[side];
        EXPECT_NEAR(at.y, hike.ground(at.x, at.z).height_m, 0.001F);
      }
    }
    EXPECT_NEAR(up, 75 * 9.81, 15);
    EXPECT_NEAR(ahead, 0, 12);
  }
}

}  // namespace
}  // namespace mobil
