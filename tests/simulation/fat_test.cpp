// Fat that wobbles like a mass on a damped spring, through all changes of its person.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <mobil/components/fat.h>
#include <mobil/rows.h>
#include <mobil/simulation.h>
#include "assets/body/body_scales.h"
#include "systems/gait/fat_motion.h"

namespace mobil::fat_test {
namespace {

using Block = FatWobble<Lanes<float>>;

float length(const Vec3<float>& v) {
  return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

/// The mass in double precision: two thousand small steps a tick, with a uniformly moving anchor.
struct Mass {
  double hz, place = 0, speed = 0;

  void tick(double from, double to, double tick_s) {
    constexpr int parts = 2000;
    const double circular = 2 * M_PI * hz, h = tick_s / parts;
    const auto pull = [&](double t, double x, double v) {
      const double point = from + (to - from) * t / tick_s, pace = (to - from) / tick_s;
      return -circular * circular * (x - point) - 2 * double{fat_damping} * circular * (v - pace);
    };
    for (int i = 0; i < parts; ++i) {  // the midpoint rule
      const double t = i * h, x = place + 0.5 * h * speed, v = speed + 0.5 * h * pull(t, place, speed);
      place += h * v;
      speed += h * pull(t + 0.5 * h, x, v);
    }
  }
};

/// Returns a pose with all segments at the same position.
Pose<Lanes<float>> pose_at(float x_m) {
  Pose<Lanes<float>> pose{};
  for (auto& place : pose.position_m)
    for (std::size_t l = 0; l < lane_count; ++l) place.x[l] = x_m;
  return pose;
}

TEST(Fat, SwingsAsAMassOnASpring) {
  BodySize<Lanes<float>> size;
  for (std::size_t l = 0; l < lane_count; ++l)
    put_row(make_size({.height_m = 1.6F + 0.02F * static_cast<float>(l), .mass_kg = 60 + 3 * static_cast<float>(l)},
                      0.15F + 0.02F * static_cast<float>(l)),
            size, l);
  for (const double tick_s : {1.0 / 30, 1.0 / 60, 1.0 / 240, 0.2}) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> pace(-1.5, 1.5);
    const auto region = index(FatRegion::belly);
    std::array<Mass, lane_count> mass;
    for (std::size_t l = 0; l < lane_count; ++l) {
      const double thick = static_cast<double>(fat_thickness_m(row_of(size, l))[region]);
      mass[l].hz = static_cast<double>(fat_hz) * std::sqrt(static_cast<double>(fat_hz_thickness_m) / thick);
    }
    Block fat{};
    double at = 0, before = 0, largest = 0;
    for (int tick = 0; tick < 60; ++tick) {
      before = at;
      at += tick_s * pace(random);
      fat_motion(size, pose_at(static_cast<float>(at)), fat, static_cast<float>(tick_s));
      for (std::size_t l = 0; l < lane_count; ++l) {
        if (tick < 2) mass[l].place = at, mass[l].speed = (at - before) / tick_s;  // it first moves with the anchor
        if (tick >= 2) mass[l].tick(before, at, tick_s);
        const double beside = mass[l].place - at;
        largest = std::max(largest, std::abs(beside));
        EXPECT_NEAR(static_cast<double>(fat.beside_m[region].x[l]), beside, 2e-5) << tick << " lane " << l;
        EXPECT_EQ(fat.beside_m[region].y[l], 0);
      }
    }
    EXPECT_GT(largest, 0.005);
  }
}

TEST(Fat, IsThickerInHeavierPeople) {
  const auto thickness_m = [](float mass_kg, float fat_share) {
    BodySize<float> size{};
    size.height_m = 1.75F;
    size.mass_kg = mass_kg;
    size.fat_share = fat_share;
    return fat_thickness_m(size);
  };
  const auto usual = thickness_m(75, 0.183F), heavy = thickness_m(110, 0.35F), thin = thickness_m(55, 0.1F);
  for (std::size_t r = 0; r < fat_regions; ++r) {
    EXPECT_NEAR(usual[r], fat_points[r].thickness_m, 1e-4F);
    EXPECT_GT(heavy[r], 1.5F * usual[r]);
    EXPECT_LT(thin[r], usual[r]);
  }
}

TEST(Fat, ShakesInWalkersAndRestsInStandingPeople) {
  Simulation simulation;
  std::vector<Entity> people = {*simulation.spawn({.height_m = 1.75F, .mass_kg = 75}, {.speed_m_s = 1.4F}),
                                *simulation.spawn({.height_m = 1.70F, .mass_kg = 105}, {.speed_m_s = 1.4F}),
                                *simulation.spawn({.height_m = 1.75F, .mass_kg = 75}, {.speed_m_s = 0.0F})};
  ASSERT_TRUE(simulation.enable(people, Feature::fat));
  std::array<float, 3> thigh{}, belly{};
  for (int tick = 0; tick < 300; ++tick) {
    simulation.tick();
    for (std::size_t p = 0; p < people.size() && tick >= 120; ++p) {
      const auto fat = *simulation.get<FatWobble>(people[p]);
      const auto size = *simulation.get<BodySize>(people[p]);
      const auto shown = shown_fat(size, fat);
      const auto thick = fat_thickness_m(size);
      for (std::size_t r = 0; r < fat_regions; ++r) {
        EXPECT_LE(length(shown[r]), fat_reach * thick[r]);
        EXPECT_LE(length(shown[r]), length(fat.beside_m[r]));
      }
      thigh[p] = std::max(thigh[p], length(shown[index(FatRegion::thigh_right)]));
      belly[p] = std::max(belly[p], length(shown[index(FatRegion::belly)]));
    }
  }
  EXPECT_GT(thigh[0], 0.0005F);
  EXPECT_NEAR(belly[0], 0.002F, 0.001F);
  EXPECT_NEAR(belly[1], 0.0045F, 0.0015F);
  EXPECT_GT(thigh[1], thigh[0]);
  EXPECT_LT(std::max(thigh[2], belly[2]), 1e-5F);
}

/// A walker whose fat has been shaken for two seconds.
struct Shaken {
  Simulation simulation;
  Entity person = *simulation.spawn({.height_m = 1.75F, .mass_kg = 90}, {.speed_m_s = 1.4F});

  Shaken() {
    simulation.enable({&person, 1}, Feature::fat);
    simulation.tick(130);
  }
  FatWobble<float> fat() const { return *simulation.get<FatWobble>(person); }
};

TEST(Fat, MovesWithPlacementAndOriginShifts) {
  Shaken stays, placed, shifted;
  const auto here = *placed.simulation.get<GaitState>(placed.person);
  ASSERT_TRUE(placed.simulation.place(placed.person, 7, -3, here.heading_rad + 1.1F));
  ASSERT_TRUE(shifted.simulation.shift_origin(-64, 128));
  float most = 0;
  for (int tick = 0; tick < 60; ++tick) {
    for (Shaken* one : {&stays, &placed, &shifted}) one->simulation.tick();
    for (std::size_t r = 0; r < fat_regions; ++r) {
      const Vec3<float> a = stays.fat().beside_m[r], b = placed.fat().beside_m[r], c = shifted.fat().beside_m[r];
      const float s = std::sin(1.1F), t = std::cos(1.1F);
      EXPECT_LT(length({a.x * t + a.z * s - b.x, a.y - b.y, a.z * t - a.x * s - b.z}), 5e-5F) << tick;
      EXPECT_LT(length({a.x - c.x, a.y - c.y, a.z - c.z}), 5e-4F) << tick;  // 15 µm at 128 m, every tick
      most = std::max(most, length(a));
    }
  }
  EXPECT_GT(most, 0.002F);
}

TEST(Fat, RestartsAtRestWhenAPosedPersonJumps) {
  Simulation simulation;
  const Entity person = *simulation.spawn_posed({});
  ASSERT_TRUE(simulation.enable({&person, 1}, Feature::fat));
  Pose<float> pose = *simulation.get<Pose>(person);
  const auto go = [&](float by_m, Arrival arrival) {
    for (auto& place : pose.position_m) place.x += by_m;
    EXPECT_TRUE(simulation.set_pose(person, pose, arrival));
    simulation.tick();
    return length(simulation.get<FatWobble>(person)->beside_m[index(FatRegion::belly)]);
  };
  for (const float by : {0.0F, 0.0F, 0.0F, 0.02F}) go(by, Arrival::moved);
  EXPECT_GT(go(-0.02F, Arrival::moved), 0.005F);
  EXPECT_EQ(go(0.05F, Arrival::jumped), 0);
  EXPECT_EQ(go(0.0F, Arrival::moved), 0);
  EXPECT_GT(go(0.02F, Arrival::moved), 0.005F);
  EXPECT_EQ(go(3.0F, Arrival::moved), 0) << "nobody goes so fast";
}

TEST(Fat, IsKeptAsleepAndCompactAndRestartsAtRest) {
  Shaken asleep, compact;
  ASSERT_EQ(asleep.simulation.set_state({&asleep.person, 1}, PersonState::asleep).value(), 1U);
  ASSERT_EQ(compact.simulation.set_state({&compact.person, 1}, PersonState::compact).value(), 1U);
  for (Shaken* one : {&asleep, &compact}) one->simulation.tick(3);
  ASSERT_TRUE(asleep.simulation.set_state({&asleep.person, 1}, PersonState::full));
  ASSERT_TRUE(compact.simulation.set_state({&compact.person, 1}, PersonState::full));
  for (Shaken* one : {&asleep, &compact}) {
    std::vector<std::byte> saved(one->simulation.snapshot_bytes());
    ASSERT_TRUE(one->simulation.save(saved));
    const auto restored = one->simulation.restore(saved);
    ASSERT_TRUE(restored) << restored.error().message;
    one->simulation.tick();
    EXPECT_EQ(length(one->fat().beside_m[0]), 0);
    one->simulation.tick(30);
    EXPECT_GT(length(one->fat().beside_m[0]), 0);
    EXPECT_LT(length(one->fat().beside_m[0]), 0.02F);
  }
}

/// Asleep it is a tag, which is saved, switched, and moves with the sleeper.
TEST(Fat, IsSavedSwitchedAndPlacedForSleepers) {
  Shaken one;
  Simulation& simulation = one.simulation;
  const Entity other = *simulation.spawn({.height_m = 1.75F, .mass_kg = 90}, {.speed_m_s = 1.4F});
  simulation.tick(130);
  const std::array both = {one.person, other};
  ASSERT_EQ(simulation.set_state(both, PersonState::asleep).value(), 2U);
  EXPECT_FALSE(simulation.get<FatWobble>(one.person)) << "nothing of it is kept";
  ASSERT_TRUE(simulation.enable({&other, 1}, Feature::fat));
  ASSERT_TRUE(simulation.enable({&one.person, 1}, Feature::fat, false));
  ASSERT_TRUE(simulation.place(other, 30, 40, 1));
  ASSERT_TRUE(simulation.shift_origin(64, -64));
  EXPECT_TRUE((simulation.state(one.person) == PersonState::asleep) &&
              (simulation.state(other) == PersonState::asleep));
  std::vector<std::byte> saved(simulation.snapshot_bytes());
  ASSERT_TRUE(simulation.save(saved));
  Simulation copy;
  ASSERT_TRUE(copy.restore(saved));
  for (Simulation* const world : {&simulation, &copy}) {
    ASSERT_TRUE(world->set_state(both, PersonState::full));
    world->tick(40);
    EXPECT_FALSE(world->get<FatWobble>(one.person));
    const auto fat = world->get<FatWobble>(other);
    ASSERT_TRUE(fat);
    EXPECT_GT(length(fat->beside_m[0]), 0);
    EXPECT_LT(length(fat->beside_m[0]), 0.02F);
  }
  EXPECT_EQ(copy.state_hash(), simulation.state_hash());
}

TEST(Fat, IsSavedAndRemovedAllOrNone) {
  Shaken shaken;
  Simulation& simulation = shaken.simulation;
  std::vector<std::byte> saved(simulation.snapshot_bytes());
  ASSERT_TRUE(simulation.save(saved));
  simulation.tick(20);
  const auto hash = simulation.state_hash();
  Simulation other;
  ASSERT_TRUE(other.restore(saved));
  other.tick(20);
  EXPECT_EQ(other.state_hash(), hash);
  const Entity second = *simulation.spawn(BodyRequest{}), gone = *simulation.spawn(BodyRequest{});
  ASSERT_TRUE(simulation.despawn(gone));
  const std::array with_gone = {second, gone}, twice = {second, second}, both = {shaken.person, second};
  EXPECT_FALSE(simulation.enable(with_gone, Feature::fat));
  EXPECT_FALSE(simulation.enable(twice, Feature::fat));
  EXPECT_FALSE(simulation.get<FatWobble>(second));
  ASSERT_TRUE(simulation.enable(both, Feature::fat));
  simulation.tick(20);
  EXPECT_GT(length(shaken.fat().beside_m[0]), 0);
  ASSERT_TRUE(simulation.enable(both, Feature::fat, false));
  EXPECT_FALSE(simulation.get<FatWobble>(second));
  EXPECT_FALSE(simulation.get<FatWobble>(shaken.person));
}

}  // namespace
}  // namespace mobil::fat_test
