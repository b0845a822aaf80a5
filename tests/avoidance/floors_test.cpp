// Avoidance between people at different heights: on and below a bridge, on slopes and stairs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <mobil/components/avoidance.h>
#include <mobil/terrain.h>
#include "tests/avoidance/walkers.h"

namespace mobil {
namespace {

/// Result of two people who walk towards each other, the second on ground that is higher: maximum sideways deviation of
/// the first, and final speeds of both.
struct Meeting {
  double aside_m = 0;
  float speed_m_s[2] = {0, 0};
};
Meeting meet_at(float higher_m) {
  Avoiders all;
  const Entity low = all.come(1.3F, 0.0F, -6.0F), high = all.come(1.3F, 0.05F, 6.0F, pi);
  all.simulation.terrain().set_heights([=](std::span<const TerrainQuery> at, std::span<TerrainHeight> out) {
    for (std::size_t i = 0; i < at.size(); ++i) out[i].height_m = at[i].person == high ? higher_m : 0;
  });
  EXPECT_TRUE(all.simulation.terrain().manage({&high, 1}));
  Meeting meeting;
  for (int tick = 0; tick < 600; ++tick) {
    all.run();
    meeting.aside_m = std::max(meeting.aside_m, std::fabs(all.root(low).x_m));
  }
  for (const Entity one : {low, high}) meeting.speed_m_s[one == high] = all.simulation.get<Gait>(one)->speed_m_s;
  EXPECT_GT(all.root(low).z_m, 4);
  EXPECT_LT(all.root(high).z_m, -4);
  return meeting;
}

TEST(Floors, PeopleOnABridgeDoNotAffectThoseBelow) {
  const Meeting level = meet_at(0), kerb = meet_at(0.3F), bridge = meet_at(4), pit = meet_at(-4);
  for (const Meeting& same : {level, kerb}) EXPECT_GT(same.aside_m, 0.1);
  for (const Meeting& apart : {bridge, pit}) {
    EXPECT_LT(apart.aside_m, 0.01);
    for (const float speed : apart.speed_m_s) EXPECT_EQ(speed, 1.3F);
  }
}

/// A crowd that stands under a bridge does not stop a person who crosses the bridge.
TEST(Floors, CrowdBelowDoesNotBlockTheBridge) {
  for (const float height_m : {0.0F, 5.0F}) {
    Avoiders all;
    for (int i = -3; i <= 3; ++i)
      for (int k = -1; k <= 1; ++k) all.come(0.0F, 0.4F * static_cast<float>(i), 0.4F * static_cast<float>(k));
    const Entity crosses = all.come(1.3F, 0.0F, -5.0F);
    all.simulation.terrain().set_heights([=](std::span<const TerrainQuery>, std::span<TerrainHeight> out) {
      for (TerrainHeight& at : out) at.height_m = height_m;
    });
    EXPECT_TRUE(all.simulation.terrain().manage({&crosses, 1}));
    all.run(60 * 8);
    const Root end = all.root(crosses);
    const bool straight = std::fabs(end.x_m) < 0.02 && end.z_m > 5;
    EXPECT_EQ(straight, height_m > 0) << end.x_m << ' ' << end.z_m;
  }
}

/// Walls and discs upstairs do not stop people below, and those of the ground floor do not stop people upstairs.
TEST(Floors, ObstaclesOfOtherFloorsAreIgnored) {
  struct Case {
    float ground_m;
    HeightRange height;
    bool seen;
  };
  const Case cases[] = {{0, {}, true},          {0, {0, 3}, true},     {0, {3, 6}, false},  {0, {1.9F, 3}, true},
                        {0, {2.1F, 3}, false},  {0, {-3, 0}, false},   {3, {0, 3}, false},  {3, {3, 6}, true},
                        {3, {0, 3.1F}, true},   {3, {5.1F, 9}, false}, {50, {0, 3}, false}, {-4, {0, 3}, false},
                        {-4, {-4, -1}, true}};
  for (const auto& [ground_m, height, seen] : cases) {
    for (const bool disc : {false, true}) {
      Avoiders all;
      const Entity one = all.come(1.3F, 0.0F, -4.0F);
      all.simulation.terrain().set_heights([=](std::span<const TerrainQuery>, std::span<TerrainHeight> out) {
        for (TerrainHeight& at : out) at.height_m = ground_m;
      });
      EXPECT_TRUE(all.simulation.terrain().manage({&one, 1}));
      all.run(60);
      const Wall across = {{-9, 0}, {9, 0}, height};
      const Disc pillar = {{0, 0}, 0.6F, 0, 0, height};
      if (disc)
        EXPECT_TRUE(all.avoidance.set_discs({&pillar, 1}));
      else
        EXPECT_TRUE(all.avoidance.set_walls({&across, 1}));
      double aside_m = 0;
      for (int tick = 0; tick < 480; ++tick) {
        all.run();
        aside_m = std::max(aside_m, std::fabs(all.root(one).x_m));
      }
      const bool straight = aside_m < 0.02 && all.root(one).z_m > 4;
      EXPECT_EQ(straight, !seen) << ground_m << " m, " << height.low_m << " to " << height.high_m << " m";
    }
  }
}

/// People who climb a slope or stairs see those who descend, at any steepness.
TEST(Floors, PeopleOnSlopesKeepTheirDistance) {
  for (const bool stairs : {false, true}) {
    for (const float rise : {0.3F, 0.6F, 0.8F}) {
      Avoiders all;
      all.simulation.terrain().set_options({.slows_down = false});
      all.simulation.terrain().set_heights([=](std::span<const TerrainQuery> at, std::span<TerrainHeight> out) {
        constexpr float tread_m = 0.3F;
        for (std::size_t i = 0; i < at.size(); ++i) {
          const float z = at[i].z_m;
          out[i] =
              stairs ? TerrainHeight{rise * tread_m * std::floor(z / tread_m), 0, 0} : TerrainHeight{rise * z, 0, rise};
        }
      });
      std::vector<Entity> up, down;
      for (int i = 0; i < 12; ++i) {
        const float x = 20.0F * static_cast<float>(i), speed = 0.8F + 0.05F * static_cast<float>(i);
        up.push_back(all.come(speed, x, -4.5F));
        down.push_back(all.come(speed, x + 0.02F * static_cast<float>(i), 4.5F, pi));
        ASSERT_TRUE(all.simulation.terrain().manage({&up.back(), 1}));
        ASSERT_TRUE(all.simulation.terrain().manage({&down.back(), 1}));
      }
      double nearest_m = 10;
      for (int tick = 0; tick < 60 * 12; ++tick) {
        all.run();
        for (std::size_t i = 0; i < up.size(); ++i) nearest_m = std::min(nearest_m, all.apart_m(up[i], down[i]));
      }
      EXPECT_GT(nearest_m, 0.33) << (stairs ? "stairs of " : "a slope of ") << rise;
    }
  }
}

}  // namespace
}  // namespace mobil
