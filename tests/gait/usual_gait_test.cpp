// Usual style, speed and step length by sex and age, compared with measured norms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/components/step_plan.h>
#include <mobil/rows.h>
#include <mobil/simulation.h>
#include <mobil/systems/snapshot/restore_limits.h>
#include <mobil/usual_gait.h>
#include "tests/gait/walkers.h"

namespace mobil::usual_gait_test {
namespace {

constexpr float degree = 3.14159265F / 180;

BodyRequest aged(Sex sex, float age_y) {
  return typical_body(sex, age_y);
}

TEST(UsualGait, StylesHaveTheOffsetsOfSexAndAge) {
  struct Row {
    Sex sex;
    float age_y, list_deg, rotation_deg, lean_deg, arms;
  };
  constexpr Row rows[] = {
      {Sex::man, 6, 4.00F, 6.50F, 2.0F, 1.00F},      {Sex::man, 12, 3.75F, 6.50F, 2.0F, 1.00F},
      {Sex::man, 25, 3.50F, 6.50F, 2.0F, 1.00F},     {Sex::man, 72, 3.50F, 5.20F, 2.8F, 0.84F},
      {Sex::man, 87, 3.50F, 3.90F, 3.6F, 0.68F},     {Sex::woman, 10, 4.00F, 6.50F, 2.0F, 1.00F},
      {Sex::woman, 14, 4.25F, 7.15F, 2.0F, 1.05F},   {Sex::woman, 60, 4.25F, 7.15F, 2.0F, 1.05F},
      {Sex::woman, 75, 4.25F, 5.3625F, 3.0F, 0.84F},
  };
  for (const Row& row : rows) {
    GaitStyle expected, style = usual_style(aged(row.sex, row.age_y));
    expected.arm_back_deg *= row.arms;
    expected.arm_forward_deg *= row.arms;
    for (const auto& [value, is] : {std::pair{&GaitStyle::pelvis_list_deg, row.list_deg},
                                    {&GaitStyle::pelvis_rotation_deg, row.rotation_deg},
                                    {&GaitStyle::trunk_lean_deg, row.lean_deg}})
      expected.*value = is;
    for (const GaitParameter& p : gait_parameters)
      EXPECT_NEAR(style.*p.value, expected.*p.value, 1e-4) << row.age_y << ' ' << p.name;
  }
  EXPECT_FLOAT_EQ(usual_speed_m_s(aged(Sex::man, 25)), 1.33F);
  EXPECT_FLOAT_EQ(usual_speed_m_s(aged(Sex::woman, 82)), 1.06F);
  EXPECT_FLOAT_EQ(usual_speed_m_s(aged(Sex::man, 7)), 1.02F);
  EXPECT_FLOAT_EQ(usual_speed_m_s(aged(Sex::woman, 95)), 0.99F);
}

/// Range of the pelvis' list, and ankle angle at toe-off, in the usual walk of a body.
struct UsualWalk {
  float list_range_deg = 0, toe_off_plantarflexion_deg = 0;
};
UsualWalk usual_walk(const BodyRequest& body) {
  const auto w = std::make_unique<Walkers>();
  for (std::size_t l = 0; l < lane_count; ++l) {
    w->set_body(l, body);
    if (!w->ask(l, {.speed_m_s = usual_speed_m_s(body), .style = usual_style(body)}, Footwear::shoes))
      throw std::runtime_error("a usual walk was refused");
  }
  w->begin();
  UsualWalk walk;
  float least = 1, most = -1;
  constexpr int instants = 100;
  for (int i = 0; i < 2 * instants; ++i) {
    if (i == instants) w->strike();
    w->place_at(static_cast<float>(i % instants) / instants);
    const Quat<float> pelvis = row(w->pose, 0).rotation[index(Segment::pelvis)];
    const float list = std::asin(rotated(pelvis, Vec3<float>{1, 0, 0}).y);
    least = std::min(least, list);
    most = std::max(most, list);
  }
  walk.list_range_deg = (most - least) / degree;
  w->strike();
  w->place_at(w->plan.double_support[0]);
  walk.toe_off_plantarflexion_deg = -w->angles.ankle_dorsiflexion[Side::left][0] / degree;
  return walk;
}

/// Smith, Lelas & Kerrigan 2002: ranges of 9.4 ± 3.5 (women) and 7.4 ± 3.4° (men).
TEST(UsualGait, WomensPelvisListsMoreThanMens) {
  const float women = usual_walk(aged(Sex::woman, 25)).list_range_deg,
              men = usual_walk(aged(Sex::man, 25)).list_range_deg;
  EXPECT_NEAR(women, 9.4, 0.5);
  EXPECT_NEAR(men, 7.4, 0.5);
  EXPECT_GE(women / men, 1.2);
  std::printf("list range %.2f women, %.2f men\n", static_cast<double>(women), static_cast<double>(men));
}

/// Judge, Davis & Ounpuu 1996: 13° at 79 and 17° at 26 years.
TEST(UsualGait, OldPeoplePushOffLess) {
  for (const Sex sex : {Sex::man, Sex::woman}) {
    const float young = usual_walk(aged(sex, 26)).toe_off_plantarflexion_deg,
                old = usual_walk(aged(sex, 79)).toe_off_plantarflexion_deg;
    EXPECT_GE(young - old, 3);
    EXPECT_LE(young - old, 6);
    std::printf("plantarflexion at toe-off: %.1f at 26, %.1f at 79 years\n", static_cast<double>(young),
                static_cast<double>(old));
  }
}

/// A class of norms: step length, m, and cadence, steps/min. Children in shoes: Lythgo et al. 2011; adults: GAITRite,
/// Hollman et al. 2011. Statures are not published: medians of growth charts, and of adults 1.763 and 1.629 m.
struct Norm {
  Sex sex;
  float from_y, to_y, step_m, steps_min;
};
constexpr Norm norms[] = {
    {Sex::man, 5, 5, 0.477F, 122},          {Sex::man, 5, 5, 0.545F, 140},
    {Sex::man, 6, 6, 0.510F, 117.9F},       {Sex::man, 6, 6, 0.581F, 136.6F},
    {Sex::man, 7, 7, 0.528F, 114.4F},       {Sex::man, 7, 7, 0.597F, 133.1F},
    {Sex::man, 7, 7, 0.652F, 162.3F},       {Sex::man, 9, 9, 0.563F, 108.3F},
    {Sex::man, 9, 9, 0.631F, 125.8F},       {Sex::man, 9, 9, 0.717F, 146},
    {Sex::man, 10, 10, 0.587F, 105.9F},     {Sex::man, 10, 10, 0.674F, 123.4F},
    {Sex::man, 10, 10, 0.752F, 146.6F},     {Sex::man, 11, 11, 0.601F, 104.5F},
    {Sex::man, 11, 11, 0.687F, 119.9F},     {Sex::man, 11, 11, 0.777F, 137.3F},
    {Sex::man, 18, 29, 0.6645F, 93.45F},    {Sex::man, 18, 29, 0.7515F, 106.1F},
    {Sex::man, 18, 29, 0.919F, 129.8F},     {Sex::man, 30, 39, 0.674F, 92.65F},
    {Sex::man, 30, 39, 0.7665F, 106.35F},   {Sex::man, 30, 39, 0.898F, 124.45F},
    {Sex::man, 50, 59, 0.6865F, 91.65F},    {Sex::man, 50, 59, 0.7775F, 106},
    {Sex::man, 50, 59, 0.902F, 123.3F},     {Sex::man, 60, 69, 0.6495F, 92.25F},
    {Sex::man, 60, 69, 0.729F, 107.45F},    {Sex::man, 60, 69, 0.8425F, 127.8F},
    {Sex::man, 70, 74, 0.69F, 102},         {Sex::man, 80, 84, 0.65F, 103},
    {Sex::man, 85, 89, 0.59F, 102},         {Sex::woman, 18, 29, 0.62F, 99.35F},
    {Sex::woman, 18, 29, 0.7075F, 115.7F},  {Sex::woman, 18, 29, 0.848F, 142.6F},
    {Sex::woman, 30, 39, 0.5995F, 100.75F}, {Sex::woman, 30, 39, 0.6885F, 118.3F},
    {Sex::woman, 30, 39, 0.8045F, 141.3F},  {Sex::woman, 50, 59, 0.5965F, 95.95F},
    {Sex::woman, 50, 59, 0.6905F, 116.5F},  {Sex::woman, 50, 59, 0.787F, 142.25F},
    {Sex::woman, 60, 69, 0.588F, 93.95F},   {Sex::woman, 60, 69, 0.666F, 114.05F},
    {Sex::woman, 60, 69, 0.771F, 140.8F},   {Sex::woman, 70, 74, 0.61F, 113},
    {Sex::woman, 80, 84, 0.55F, 110},       {Sex::woman, 85, 89, 0.54F, 108},
};

/// Means of the classes, over slow, usual and fast walks, are within 5 %; each walk is within 6 %.
TEST(UsualGait, StepLengthsAreNearNormsOfTheClass) {
  std::map<std::pair<Sex, float>, std::vector<double>> errors;
  for (const Norm& of : norms) {
    const float age_y = 0.5F * (of.from_y + of.to_y), stature_m = of.sex == Sex::woman ? 1.629F : 1.763F;
    BodyRequest body = aged(of.sex, std::max(age_y, 6.0F));
    if (age_y >= 18) {
      body.height_m = stature_m - (aged(of.sex, 30).height_m - aged(of.sex, std::max(age_y, 30.0F)).height_m);
    } else {
      constexpr float grown_from_5_to_6_m = 0.064F;
      body.height_m = 0.5F * (body.height_m + aged(Sex::woman, std::max(age_y, 6.0F)).height_m);
      if (age_y < 6) body.height_m -= grown_from_5_to_6_m;
    }
    const auto gait = resolve_gait(*make_body(body), {.speed_m_s = of.step_m * of.steps_min / 60});
    ASSERT_TRUE(gait) << gait.error().message;
    const double error = 100 * (static_cast<double>(gait->step_length_m / of.step_m) - 1);
    EXPECT_LE(std::fabs(error), 6) << of.from_y << ' ' << of.step_m;
    errors[{of.sex, of.from_y}].push_back(error);
  }
  for (const auto& [of, error] : errors) {
    const double mean = std::reduce(error.begin(), error.end()) / static_cast<double>(error.size());
    EXPECT_LE(std::fabs(mean), 5) << of.second;
    std::printf("%s from %2.0f years: %+.1f %%\n", of.first == Sex::man ? "man" : "woman",
                static_cast<double>(of.second), mean);
  }
}

TEST(UsualGait, StepLengthLeftOutIsThatOfAgeAndFootwear) {
  for (const float age_y : {6.0F, 18.0F, 25.0F, 66.0F, 87.0F}) {
    const Body body = *make_body(aged(Sex::man, age_y));
    const GaitRequest request{.speed_m_s = 1.1F};
    const double shod = resolve_gait(body, request)->step_length_m,
                 barefoot = resolve_gait(body, request, Footwear::barefoot)->step_length_m;
    EXPECT_NEAR(shod / barefoot, usual_step_factor(age_y), 1e-6);
    EXPECT_EQ(resolve_gait(body, request)->step_length_m, resolve_gait(body.size, request, age_y)->step_length_m);
  }
  EXPECT_NEAR(usual_step_factor(6), shod_step_factor * 1.15 / 1.035, 1e-9);
  EXPECT_EQ(usual_step_factor(usual_age_y), shod_step_factor);
  EXPECT_EQ(usual_step_factor(66), shod_step_factor);
  EXPECT_NEAR(usual_step_factor(87), shod_step_factor * 0.925 / 1.035, 1e-9);
}

/// The age's step length holds through changes of gait, sleep and snapshots, and is applied once.
TEST(UsualGait, ChangesOfSpeedKeepTheStepsOfTheAge) {
  Simulation simulation;
  const BodyRequest body = aged(Sex::woman, 8);
  const Entity child = *simulation.spawn(body, {.speed_m_s = 1.0F, .style = usual_style(body)});
  const auto expect_length = [&](const Simulation& in, float speed_m_s) {
    const GaitRequest now = *in.gait_request(child);
    const Body made = *make_body(body);
    EXPECT_FLOAT_EQ(*now.step_length_m, resolve_gait(made, {.speed_m_s = speed_m_s})->step_length_m);
    for (const GaitParameter& p : gait_parameters) EXPECT_EQ(now.style.*p.value, usual_style(body).*p.value) << p.name;
  };
  expect_length(simulation, 1.0F);
  ASSERT_TRUE(simulation.set_gait(child, *simulation.gait_request(child)));
  expect_length(simulation, 1.0F);
  ASSERT_TRUE(simulation.change_gait(child, {.speed_m_s = 1.2F}));
  expect_length(simulation, 1.2F);
  simulation.tick(600);
  ASSERT_EQ(*simulation.set_state(std::span(&child, 1), PersonState::asleep), 1U);
  expect_length(simulation, 1.2F);
  ASSERT_TRUE(simulation.change_gait(child, {.speed_m_s = 0.9F}));
  expect_length(simulation, 0.9F);
  std::vector<std::byte> bytes(simulation.snapshot_bytes());
  ASSERT_TRUE(simulation.save(bytes));
  Simulation other;
  ASSERT_TRUE(other.restore(bytes, RestoreLimits::none()));
  expect_length(other, 0.9F);
}

}  // namespace
}  // namespace mobil::usual_gait_test
