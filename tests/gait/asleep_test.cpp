// Unseen walkers: a steady walk in closed form, and the effect of a change computed from strikes only.

#include <gtest/gtest.h>

#include <cstring>
#include <memory>

#include "systems/gait/asleep.h"
#include "tests/gait/walkers.h"
#include "tests/labels.h"

namespace mobil {
namespace {

constexpr float tick_s = 1.0F / 60;

template <template <class> class C>
std::size_t words_off(const C<Lanes<float>>& a, const C<Lanes<float>>& b, std::size_t lane) {
  const C<float> x = row(a, lane), y = row(b, lane);
  std::uint32_t left[sizeof(x) / 4], right[sizeof(x) / 4];
  std::memcpy(left, &x, sizeof(x));
  std::memcpy(right, &y, sizeof(y));
  std::size_t off = 0;
  for (std::size_t w = 0; w < std::size(left); ++w) off += left[w] != right[w] ? 1 : 0;
  return off;
}

Lanes<std::uint32_t> all_at(std::uint32_t tick) {
  Lanes<std::uint32_t> lanes;
  for (auto& lane : lanes.lane) lane = tick;
  return lanes;
}

/// Walkers after random requests, and their next requests.
struct Scene {
  explicit Scene(unsigned seed) : w(random_walkers(seed)), dice{std::mt19937(seed + 500)} {
    for (std::size_t l = 0; l < lane_count; ++l) {
      even(l);
      w->gait.heading_rad[l] = w->state.heading_rad[l] = dice.single(-3, 3);
      w->state.line_x_m[l] = w->state.anchor_x_m[l] = dice.single(-500, 500);
    }
  }
  /// Makes steps even, because uneven steps are never steady.
  void even(std::size_t lane) {
    w->gait.style.step_asymmetry[lane] = w->gait.style.time_asymmetry[lane] = 0;
    ++w->gait.revision[lane];
  }
  void tick() {
    w->tick(tick_s);
    ++now;
  }
  void tick(int count) {
    for (int i = 0; i < count; ++i) tick();
  }
  /// Makes every fourth walker turn, every fourth change speed, and the others turn and change speed or stop.
  void change() {
    for (std::size_t l = 0; l < lane_count; ++l) {
      const auto what = static_cast<int>(dice(0, 4));
      if (what != 1) w->gait.heading_rad[l] += dice.single(-2.5, 2.5);
      if (what == 0) continue;
      GaitRequest request;
      request.style = row(w->gait, l).style;
      request.speed_m_s = what == 2 ? 0.0F : dice.single(0.9, 1.6);
      w->ask(l, request);
    }
  }

  std::unique_ptr<Walkers> w;
  Dice dice;
  std::uint32_t now = 0;
};

TEST(Asleep, StyleOnTheGridRoundTripsBitExactly) {
  Dice dice{std::mt19937(3)};
  EXPECT_TRUE(packed_style(GaitStyle{}));
  for (int i = 0; i < 2000; ++i) {
    const GaitStyle any = random_style(dice, 1), near = snapped(any);
    for (const GaitParameter& p : gait_parameters) {
      EXPECT_LE(std::abs(near.*p.value - any.*p.value), (p.high - p.low) / 254 * 1.01F) << p.name;
      EXPECT_GE(near.*p.value, p.low) << p.name;
      EXPECT_LE(near.*p.value, p.high) << p.name;
    }
    const auto packed = packed_style(near);
    ASSERT_TRUE(packed);
    const GaitStyle back = style_of(*packed);
    EXPECT_EQ(std::memcmp(&back, &near, sizeof(back)), 0);
    EXPECT_FALSE(packed_style(any));
  }
}

TEST(Asleep, SteadyWalkIsExactAtAnyTick) {
  std::size_t seen = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    Scene scene(seed);
    scene.tick(400);
    for (int round = 0; round < 4; ++round) {
      scene.change();
      scene.tick(500);
      Walkers& w = *scene.w;
      SteadyWalk<Lanes<float>> walk;
      const auto steady = steady_walkers(w.size, w.gait, w.plan, w.state, all_at(scene.now), tick_s, walk);
      const auto block = std::make_unique<WalkingBlock>();
      block->size = w.size;
      block->gait = w.gait;
      for (const int ahead : {0, 1, 7, 60, 431}) {
        scene.tick(ahead);
        begin_steady(walk, all_at(scene.now), tick_s, *block);
        Lanes<float> x_m, z_m;
        steady_places(walk, scene.now, tick_s, x_m, z_m);
        for (std::size_t l = 0; l < lane_count; ++l) {
          if ((steady >> l & 1U) == 0) continue;
          ++seen;
          ASSERT_EQ(words_off(block->state, w.state, l), 0U) << "after " << ahead << ", lane " << l;
          ASSERT_EQ(words_off(block->plan, w.plan, l), 0U) << "after " << ahead << ", lane " << l;
          EXPECT_NEAR(x_m[l], w.pose.position_m[index(Segment::pelvis)].x[l], 0.8F);
          EXPECT_NEAR(z_m[l], w.pose.position_m[index(Segment::pelvis)].z[l], 0.8F);
        }
      }
    }
  }
  EXPECT_GT(seen, 12U * 4 * 5 * lane_count * 8 / 10);  // more than 80 % are steady after eight seconds
}

TEST(Asleep, ChangesFollowFromStrikesOnly) {
  MOBIL_SLOW();
  std::size_t settled = 0, asked = 0;
  for (unsigned seed = 20; seed < 32; ++seed) {
    Scene scene(seed);
    scene.tick(600);
    for (int round = 0; round < 4; ++round) {
      Walkers& w = *scene.w;
      scene.tick(static_cast<int>(scene.dice(0, 40)));
      SteadyWalk<Lanes<float>> before, after{};
      const auto at = all_at(scene.now);
      const auto steady = steady_walkers(w.size, w.gait, w.plan, w.state, at, tick_s, before);
      const auto block = std::make_unique<WalkingBlock>();
      const auto gait_before = w.gait;
      scene.change();
      block->size = w.size;
      block->gait = w.gait;
      Lanes<std::uint32_t> until;
      settle(gait_before, before, at, tick_s, *block, after, until);
      const auto work = std::make_unique<WalkingBlock>();
      GaitState<Lanes<float>> then;
      for (int i = 0; i < 700; ++i) {
        const bool look = i % 23 == 0;
        if (look) walk_on(gait_before, before, at, all_at(scene.now), tick_s, *block, *work);
        steady_state(after, all_at(scene.now), tick_s, then);
        for (std::size_t l = 0; l < lane_count; ++l) {
          if ((steady >> l & 1U) == 0) continue;
          if (look) {
            ASSERT_EQ(words_off(block->state, w.state, l), 0U) << i << " ticks on, lane " << l;
            ASSERT_EQ(words_off(block->plan, w.plan, l), 0U) << i << " ticks on, lane " << l;
          }
          if (i == 0) ++asked;
          if (until[l] != scene.now) continue;
          ++settled;
        }
        for (std::size_t l = 0; l < lane_count; ++l) {
          if ((steady >> l & 1U) == 0 || until[l] > scene.now) continue;
          ASSERT_EQ(words_off(then, w.state, l), 0U) << i << " ticks on, settled, lane " << l;
        }
        scene.tick();
      }
    }
  }
  EXPECT_GT(asked, 500U);
  EXPECT_GE(settled * 100, asked * 97) << settled << " of " << asked;
}

}  // namespace
}  // namespace mobil
