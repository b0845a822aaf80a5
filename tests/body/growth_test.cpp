// Bodies of all ages: growth charts, ranges by age, and the word that stores an age.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <mobil/anthropometry.h>
#include <mobil/body_composition.h>
#include "assets/body/growth.h"
#include "tests/refused.h"

namespace mobil::growth_test {
namespace {

constexpr std::array both = {Sex::man, Sex::woman};

// Snapshots from before ages have the words of adults of 25 years.
static_assert(build_word(Constitution::heavy, Sex::woman, usual_age_y) == 7);
static_assert(age_of(7) == usual_age_y && sex_of(7) == Sex::woman && constitution_of(7) == Constitution::heavy);
static_assert(BodyRequest{}.age_y == usual_age_y);

RC_GTEST_PROP(BuildWord, KeepsConstitutionSexAndHalfYears, ()) {
  const auto constitution = static_cast<Constitution>(*rc::gen::inRange(0, 4));
  const Sex sex = both[*rc::gen::inRange(std::size_t{0}, std::size_t{2})];
  const float age_y = 0.01F * static_cast<float>(*rc::gen::inRange(600, 9501));
  const std::uint32_t word = build_word(constitution, sex, age_y);
  RC_ASSERT(constitution_of(word) == constitution);
  RC_ASSERT(sex_of(word) == sex);
  RC_ASSERT(age_of(word) == half_years(age_y));
  RC_ASSERT(std::fabs(age_of(word) - age_y) <= 0.2501F);
  RC_ASSERT(build_word(constitution, sex, age_of(word)) == word);
}

TEST(Growth, MediansAreThoseOfTheCharts) {
  struct Row {
    Sex sex;
    float age_y, height_m, mass_index;
  };
  for (const Row& row : {Row{Sex::man, 6, 1.1539F, 15.382F},
                         {Sex::man, 12.5F, 1.5237F, 18.111F},
                         {Sex::man, 18, 1.7616F, 21.869F},
                         {Sex::woman, 6, 1.1471F, 15.211F},
                         {Sex::woman, 10, 1.3799F, 16.838F},
                         {Sex::woman, 17.5F, 1.6303F, 21.086F}}) {
    const BodyRequest body = typical_body(row.sex, row.age_y);
    EXPECT_NEAR(body.height_m, row.height_m, 1e-4F) << row.age_y;
    EXPECT_NEAR(body.mass_kg / (body.height_m * body.height_m), row.mass_index, 1e-3F) << row.age_y;
  }
  // Percentile 97.7 of boys of 10 years: Box–Cox power 0.50261, coefficient of variation 0.047551.
  EXPECT_NEAR(typical_body(Sex::man, 10, 2).height_m, 1.3862 * std::pow(1 + 0.50261 * 0.047551 * 2, 1 / 0.50261), 1e-4);
}

TEST(Growth, AdultsHavePublishedMeans) {
  EXPECT_NEAR(typical_body(Sex::man, 30).height_m, 1.757F, 1e-4F);
  EXPECT_NEAR(typical_body(Sex::man, 30, 1).height_m, 1.826F, 1e-4F);
  EXPECT_NEAR(typical_body(Sex::woman, 30, -1).height_m, 1.565F, 1e-4F);
  EXPECT_NEAR(typical_body(Sex::woman, 70).height_m, 1.579F, 1e-4F);  // 5 cm less
  EXPECT_NEAR(typical_body(Sex::man, 70).height_m, 1.727F, 1e-4F);    // 3 cm less
  EXPECT_NEAR(typical_body(Sex::woman, 30).mass_kg, 23.6 * 1.629 * 1.629, 0.01);
  EXPECT_NEAR(typical_body(Sex::man, 65).mass_kg / typical_body(Sex::man, 65, 0, 1).mass_kg, std::exp(-0.145), 1e-4);
}

TEST(Growth, BodiesWithinTwoDeviationsAreMade) {
  for (const Sex sex : both) {
    for (float age_y = 6; age_y <= 95; age_y += 0.5F) {
      for (int height_z = -2; height_z <= 2; ++height_z) {
        for (int index_z = -2; index_z <= 2; ++index_z) {
          const auto body =
              make_body(typical_body(sex, age_y, static_cast<float>(height_z), static_cast<float>(index_z)));
          ASSERT_TRUE(body) << age_y << " years: " << body.error().message;
          EXPECT_TRUE(body_notes(*body).empty()) << age_y << " years: " << body_notes(*body).front();
        }
      }
    }
  }
}

TEST(Growth, ChildrenBeyondFiveDeviationsAreRefusedWithTheRange) {
  for (const Sex sex : both) {
    for (float age_y = 6; age_y < 18; age_y += 0.5F) {
      EXPECT_TRUE(make_body(typical_body(sex, age_y, -4.5F)) && make_body(typical_body(sex, age_y, 4.5F))) << age_y;
      for (const float z : {-5.0F, 5.0F}) {
        const auto [low, high] = living_height_m(sex, age_y);
        EXPECT_TRUE(is_refused(make_body(typical_body(sex, age_y, z)), fmt::format("{} years", age_y),
                               fmt::format("{:.2f}–{:.2f} m", low, high)));
      }
      EXPECT_FALSE(make_body(typical_body(sex, age_y, 0, 5)));
    }
  }
  BodyRequest tall{.height_m = 1.8F, .mass_kg = 60, .age_y = 6};
  EXPECT_TRUE(is_refused(make_body(tall), "nobody of 6 years is 1.80 m tall; choose 0.92–1.38 m or another age"));
  tall.sex = Sex::woman;
  EXPECT_TRUE(is_refused(make_body(tall), "0.94–1.42 m"));
}

TEST(Growth, MassesOfChildrenAreRefusedWithTheRange) {
  const auto made = [](float mass_kg) { return make_body({.height_m = 1.15F, .mass_kg = mass_kg, .age_y = 6}); };
  EXPECT_TRUE(is_refused(made(70), "6 years", "1.15 m", "13.9–52.8 kg"));
  for (const float mass_kg : {13.9F, 52.8F}) EXPECT_TRUE(made(mass_kg)) << mass_kg;
  EXPECT_TRUE(is_refused(make_body({.height_m = 1.0F, .mass_kg = 11.9F, .age_y = 6}), "12.0–40.0 kg"));
}

TEST(Growth, RequestsWithoutAnAgeAreAdults) {
  EXPECT_TRUE(make_body({.height_m = 1.3F, .mass_kg = 32}));
  EXPECT_FALSE(make_body({.height_m = 1.15F, .mass_kg = 30}));
}

TEST(Growth, NumbersThatAreNotFiniteAreRefused) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  for (const float bad : {nan, inf, -inf}) {
    EXPECT_TRUE(is_refused(make_body({.age_y = bad}), "age", "6–95 years"));
    for (const float age_y : {8.0F, 19.0F, 40.0F}) {
      EXPECT_FALSE(make_body(typical_body(Sex::woman, age_y, bad)));
      EXPECT_FALSE(make_body(typical_body(Sex::woman, age_y, 0, bad)));
      EXPECT_FALSE(make_body({.height_m = bad, .mass_kg = 30, .age_y = age_y}));
      EXPECT_FALSE(make_body({.height_m = 1.3F, .mass_kg = bad, .age_y = age_y}));
    }
    EXPECT_FALSE(make_body(typical_body(Sex::man, bad)));
  }
  for (const float age_y : {0.0F, 5.9F, 95.1F, -25.0F})
    EXPECT_TRUE(is_refused(make_body({.age_y = age_y}), "6–95 years"));
}

TEST(Growth, SizesJoinAtTheAgesOfAdults) {
  for (const Sex sex : both) {
    for (const float z : {-2.0F, 0.0F, 2.0F}) {
      for (float age_y = 16; age_y < 24; age_y += 0.5F) {
        const BodyRequest now = typical_body(sex, age_y, z, z), then = typical_body(sex, age_y + 0.5F, z, z);
        EXPECT_NEAR(then.height_m, now.height_m, 0.015F) << age_y;
        EXPECT_NEAR(then.mass_kg / now.mass_kg, 1, 0.045F) << age_y;
      }
    }
  }
}

TEST(Growth, AgesAreKeptToHalfYears) {
  EXPECT_EQ(make_body({.age_y = 33.3F})->request.age_y, 33.5F);
  EXPECT_EQ(make_body({.age_y = 17.8F})->request.age_y, 18.0F);
  EXPECT_TRUE(is_refused(make_body({.height_m = 1.1F, .mass_kg = 30, .age_y = 17.8F}), "1.2–2.2 m"));
}

TEST(Growth, BodiesOfAnAgeAreThoseOfTheNearestHalfYear) {
  BodyRequest exact = typical_body(Sex::woman, 12.5F), near = exact;
  near.age_y = 12.4F;
  const BodySize<float> a = make_body(exact)->size, b = make_body(near)->size;
  EXPECT_EQ(a.leg_scale_m, b.leg_scale_m);
  EXPECT_EQ(a.trunk_scale_m, b.trunk_scale_m);
  EXPECT_EQ(a.shoulders_scale_m, b.shoulders_scale_m);
}

}  // namespace
}  // namespace mobil::growth_test
