// Body composition, compared with the published tables that it follows, and the resolution of contradictory requests.
#include <mobil/body_composition.h>
#include "assets/body/body_scales.h"
#include "assets/body/fat_distribution.h"
#include "assets/body/segment_masses.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numeric>
#include <utility>

#include <mobil/anthropometry.h>
#include <mobil/assets/muscles/muscle_plan.h>
#include "tests/simulation/people.h"

namespace mobil::body_composition_test {
BodyRequest any_request() {
  BodyRequest r;
  r.height_m = static_cast<float>(*rc::gen::inRange(1200, 2191)) / 1000;
  r.mass_kg = living_mass(r.height_m + 0.01F, *rc::gen::inRange(0, 951) / 1000.0);
  const auto part = [] { return static_cast<float>(*rc::gen::inRange(1, 121)) / 10; };
  r.biotype = *rc::gen::arbitrary<bool>() ? Biotype{part(), part(), part()} : Biotype{3, part(), 3};
  r.constitution = static_cast<Constitution>(*rc::gen::inRange(0, 4));
  return r;
}
BodyRequest of_any_age() {
  const auto z = [] { return static_cast<float>(*rc::gen::inRange(-20, 21)) / 10; };
  const Sex sex = *rc::gen::arbitrary<bool>() ? Sex::man : Sex::woman;
  return typical_body(sex, static_cast<float>(*rc::gen::inRange(12, 191)) / 2, z(), z());
}

/// Returns Gallagher's and Deurenberg's share of fat in a person of average build, percent.
double published_fat(const BodyRequest& r) {
  const auto height = static_cast<double>(r.height_m), age = static_cast<double>(r.age_y);
  const double b = static_cast<double>(r.mass_kg) / (height * height), man = r.sex == Sex::man ? 1 : 0;
  const auto adult = [&](double y) { return 64.5 - 848 / b + 0.079 * y - 16.4 * man + 0.05 * man * y + 39 * man / b; };
  const double child = 1.51 * b - 0.7 * age - 3.6 * man + 1.4;
  if (age >= 18) return adult(age);
  return age <= 14 ? child : child + (age - 14) / 4 * (adult(18) - child);
}

/// Returns the muscle of both legs, kg.
double leg_muscle_kg(const Body& body) {
  double m3 = 0;
  for (const MemberMuscle& line : member_muscles()) m3 += member_volume_m3(body, line);
  return 2 * 1060 * m3;
}

double fat_share(const BodyComposition& c) {
  return static_cast<double>(c.fat_kg) / static_cast<double>(c.fat_kg + c.lean_kg);
}

TEST(BodyComposition, FatOfSkinfoldsIsDurninAndWomersleys) {
  // Durnin and Womersley's table for men of 17 to 29: sum of four folds, mm, and fat in percent.
  for (const auto& [folds, percent] :
       {std::pair{15.0, 4.8}, {20.0, 8.1}, {25.0, 10.5}, {30.0, 12.9}, {40.0, 16.4}, {50.0, 19.0}}) {
    const double three = 0.75 * folds;
    const double endomorphy = -0.7182 + 0.1451 * three - 0.00068 * std::pow(three, 2) + 0.0000014 * std::pow(three, 3);
    EXPECT_NEAR(100 * fat_share_of_endomorphy(endomorphy), percent, 0.5) << folds << " mm";
    EXPECT_NEAR(endomorphy_of_fat_share(fat_share_of_endomorphy(endomorphy)), endomorphy, 1e-6);
  }
}

TEST(BodyComposition, FatOfBodyMassIndexIsGallaghers) {
  // Gallagher's table for white men of 20 to 39 years.
  for (const auto& [index, percent] : {std::pair{18.5, 8.0}, {25.0, 20.0}, {30.0, 25.0}}) {
    EXPECT_NEAR(100 * fat_share_of_mass_index(index), percent, 1.5) << index;
  }
}

RC_GTEST_PROP(BodyComposition, FatIsThatOfSexAndAge, ()) {
  const BodyRequest r = of_any_age();
  const double published = published_fat(r), least = r.sex == Sex::woman ? 8 : 3;
  if (published < least || published > 61) return;
  RC_ASSERT(std::abs(100 * fat_share(make_body(r)->composition) - published) < 0.1);
}

TEST(BodyComposition, FatOfSkinfoldsOfWomenIsDurninAndWomersleys) {
  // Their table for women of 16 to 29: sum of four folds, mm, and fat in percent.
  for (const auto& [folds, percent] : {std::pair{20.0, 14.1}, {30.0, 19.5}, {40.0, 23.4}, {50.0, 26.5}, {70.0, 31.2}}) {
    const double three = 0.75 * folds;
    const double endomorphy = -0.7182 + 0.1451 * three - 0.00068 * std::pow(three, 2) + 0.0000014 * std::pow(three, 3);
    EXPECT_NEAR(100 * fat_share_of_endomorphy(endomorphy, Sex::woman), percent, 0.8) << folds << " mm";
    EXPECT_NEAR(endomorphy_of_fat_share(fat_share_of_endomorphy(endomorphy, Sex::woman), Sex::woman), endomorphy, 1e-6);
  }
}

// The right columns of the design's table: fat by formula, leg muscle after Lee, Janssen and Maden-Wilkinson.
TEST(BodyComposition, FatAndLegMuscleOfPeopleAreThePublishedOnes) {
  struct Person {
    BodyRequest body;
    double fat_percent, leg_muscle_kg;
  };
  const Person people[] = {{{.height_m = 1.63F, .mass_kg = 67.8F, .sex = Sex::woman}, 33.3, 12.4},
                           {{.height_m = 1.60F, .mass_kg = 68, .sex = Sex::woman, .age_y = 72}, 38.3, 9.7},
                           {{.height_m = 1.756F, .mass_kg = 85.5F}, 22.1, 17.7},
                           {{.height_m = 1.73F, .mass_kg = 82, .age_y = 72}, 27.9, 12.5},
                           {{.height_m = 1.154F, .mass_kg = 20.7F, .age_y = 6}, 17.1, 2.88},
                           {{.height_m = 1.38F, .mass_kg = 32.9F, .sex = Sex::woman, .age_y = 10}, 20.5, 5.2}};
  for (const Person& person : people) {
    const Body body = make_body(person.body).value();
    EXPECT_NEAR(100 * fat_share(body.composition), person.fat_percent, 0.1) << person.body.age_y;
    EXPECT_NEAR(leg_muscle_kg(body) / person.leg_muscle_kg, 1, 0.02) << person.body.age_y;
    EXPECT_EQ(body.composition.notes, 0);
  }
}

RC_GTEST_PROP(BodyComposition, LegsOfWomenAndEldersHaveLessMuscle, ()) {
  BodyRequest man{.height_m = static_cast<float>(*rc::gen::inRange(1500, 1901)) / 1000};
  man.mass_kg = static_cast<float>(*rc::gen::inRange(190, 300)) / 10 * man.height_m * man.height_m;
  BodyRequest woman = man, old_man = man, old_woman = man;
  woman.sex = old_woman.sex = Sex::woman;
  old_man.age_y = old_woman.age_y = 72;
  const auto ratio = [](const BodyRequest& a, const BodyRequest& b) {
    return static_cast<double>(make_body(a)->composition.muscle_factor / make_body(b)->composition.muscle_factor);
  };
  RC_ASSERT(ratio(woman, man) > 0.90 && ratio(woman, man) < 0.92);
  RC_ASSERT(ratio(old_man, man) > 0.72 && ratio(old_man, man) < 0.79);
  RC_ASSERT(ratio(old_woman, woman) > 0.72 && ratio(old_woman, woman) < 0.79);
}

RC_GTEST_PROP(BodyComposition, PeopleOfAllAgesStayWithinLivingRanges, ()) {
  BodyRequest r = of_any_age();
  const auto [low, high] = living_mass_kg(static_cast<double>(r.height_m), r.age_y);
  r.mass_kg = static_cast<float>(low + (high - low) * *rc::gen::inRange(0, 10001) * 1e-4);
  const Body body = make_body(r).value();
  const BodyComposition& c = body.composition;
  const double height = static_cast<double>(r.height_m), lean = static_cast<double>(c.lean_kg) / (height * height);
  RC_ASSERT(fat_share(c) > 0.0299 && fat_share(c) < 0.6101);
  RC_ASSERT(lean < 36.001 && lean > (r.age_y < 18 ? 10.1 : 11.6));
  RC_ASSERT(leg_muscle_kg(body) > 0);
  RC_ASSERT(leg_muscle_kg(body) < 0.65 * 0.55 * static_cast<double>(c.lean_kg) * 1.02);
}

TEST(BodyComposition, GrowsWithoutJumps) {
  for (const Sex sex : {Sex::man, Sex::woman}) {
    for (float age_y = 6; age_y < 95; age_y += 0.5F) {
      const Body now = *make_body(typical_body(sex, age_y)), then = *make_body(typical_body(sex, age_y + 0.5F));
      EXPECT_NEAR(fat_share(then.composition), fat_share(now.composition), 0.013) << age_y;
      EXPECT_NEAR(leg_muscle_kg(then) / leg_muscle_kg(now), 1, 0.12) << age_y;
    }
  }
}

TEST(BodyComposition, EctomorphyIsHeathAndCarters) {
  EXPECT_NEAR(height_weight_ratio(1.80, 80), 41.77, 0.01);
  EXPECT_NEAR(ectomorphy(45), 0.732 * 45 - 28.58, 1e-12);
  EXPECT_NEAR(ectomorphy(40), 0.463 * 40 - 17.63, 1e-12);
  EXPECT_EQ(ectomorphy(36), 0.1);
  for (double ratio = 30; ratio < 60; ratio += 0.01) {
    EXPECT_GE(ectomorphy(ratio + 0.01), ectomorphy(ratio));
    EXPECT_LT(ectomorphy(ratio + 0.01) - ectomorphy(ratio), 0.021);  // the two pieces nearly meet
  }
}

TEST(BodyComposition, ReferenceBodyIsAnAverageMan) {
  const Body body = make_body({.height_m = 1.80F, .mass_kg = 80}).value();
  const BodyComposition& c = body.composition;
  EXPECT_NEAR(c.body_mass_index, 24.69, 0.01);
  EXPECT_NEAR(fat_share(c), 0.186, 0.005);
  EXPECT_EQ(c.muscle_factor, 1.0F);
  EXPECT_EQ(c.notes, 0);
  EXPECT_TRUE(body_notes(body).empty());
}

RC_GTEST_PROP(BodyComposition, OrdinaryRequestsAreGranted, ()) {
  BodyRequest r;
  r.height_m = static_cast<float>(*rc::gen::inRange(1500, 2001)) / 1000;
  r.mass_kg = static_cast<float>(*rc::gen::inRange(190, 280)) / 10 * r.height_m * r.height_m;
  r.constitution = static_cast<Constitution>(*rc::gen::inRange(0, 4));
  const Body body = make_body(r).value();
  RC_ASSERT(body_notes(body).empty());
  RC_ASSERT(std::abs(static_cast<double>(body.composition.muscle_factor) / physique_factor(r) - 1) < 0.02);
}

RC_GTEST_PROP(BodyComposition, StaysWithinLivingRanges, ()) {
  const BodyRequest r = any_request();
  const Body body = make_body(r).value();
  const BodyComposition& c = body.composition;
  const double height = static_cast<double>(r.height_m), lean = static_cast<double>(c.lean_kg);
  RC_ASSERT(std::abs(c.fat_kg + c.lean_kg - r.mass_kg) <= 1e-5F * r.mass_kg);
  RC_ASSERT(fat_share(c) > 0.0299 && fat_share(c) < 0.6101);
  RC_ASSERT(lean < 36.001 * height * height && lean > 11.6 * height * height);
  RC_ASSERT(c.muscle_factor > 0 && static_cast<double>(c.muscle_factor) <= physique_factor(r) * (1 + 1e-6));
  // The muscles of the legs are at most 52 % of 65 % of the lean mass.
  const double limb_cm3 = 47 * static_cast<double>(r.mass_kg) * height + 1285;
  RC_ASSERT(2 * 1.06e-3 * limb_cm3 * static_cast<double>(c.muscle_factor) < 0.65 * 0.52 * lean * (1 + 1e-5));
  RC_ASSERT(c.biotype.endo >= 0.1F && c.biotype.endo <= 12.0F && c.biotype.ecto >= 0.1F);
  for (const std::string& note : body_notes(body)) RC_ASSERT(note.find('\n') == std::string::npos);
}

RC_GTEST_PROP(BodyComposition, LeanMassGrowsWithHeightAndMassAndFatWithEndomorphy, ()) {
  const BodyRequest r = any_request();
  BodyRequest taller = r, heavier = r, fatter = r;
  taller.height_m += 0.01F;
  heavier.mass_kg += 1;
  const double slack = 1e-5 * static_cast<double>(r.mass_kg);
  const auto lean = [](const BodyRequest& q) { return static_cast<double>(body_composition(q).lean_kg); };
  RC_ASSERT(lean(taller) >= lean(r) - slack);
  RC_ASSERT(lean(heavier) >= lean(r) - slack);
  if (r.biotype.endo == 3 || r.biotype.endo > 11) return;
  fatter.biotype.endo += r.biotype.endo < 3 && r.biotype.endo > 2.5F ? 0.1F : 0.5F;
  if (fatter.biotype.endo == 3) return;  // with an ectomorphy of 3 this counts as not set
  RC_ASSERT(lean(fatter) <= lean(r) + slack);
}

TEST(BodyComposition, EveryContradictionIsReportedAndResolved) {
  struct Case {
    BodyRequest request;
    BodyNote note;
    const char* words;
  };
  const Case cases[] = {{{1.80F, 80, {4, 4, 6}, {}}, BodyNote::ectomorphy, "ectomorphy 6.0"},
                        {{1.50F, 200, {3, 4, 3}, Constitution::average}, BodyNote::fat_raised, "kg without fat"},
                        {{1.80F, 41, {8, 4, 9.5F}, Constitution::average}, BodyNote::fat_lowered, "too little else"},
                        {{1.80F, 80, {4, 11, 2}, Constitution::athletic}, BodyNote::muscle, "kg of lean mass"}};
  for (const Case& c : cases) {
    const auto body = make_body(c.request);
    ASSERT_TRUE(body) << body.error().message;
    EXPECT_TRUE(has_note(body->composition, c.note)) << c.words;
    std::string all;
    for (const auto& note : body_notes(*body)) all += note + "\n";
    EXPECT_NE(all.find(c.words), std::string::npos) << all;
  }
}

// At this mass, minimum and maximum lean mass are equal except for rounding.
TEST(BodyComposition, LightestBodiesHaveMinimumFat) {
  for (const float height : {1.625F, 1.7F, 1.9F, 2.2F}) {
    const auto [least, most] = living_mass_kg(static_cast<double>(height));
    ASSERT_LT(least, most);
    for (const auto constitution : {Constitution::thin, Constitution::athletic}) {
      const auto body = make_body({height, static_cast<float>(least), {}, constitution});
      ASSERT_TRUE(body) << body.error().message;
      EXPECT_NEAR(body->composition.fat_kg / body->request.mass_kg, 0.03, 1e-4) << height;
    }
  }
}

TEST(FatDistribution, MassesOfSegmentsFollowTheFatAndAddUp) {
  EXPECT_NEAR(fat_share_of_mass_index(24.5), usual_fat_share(Sex::man, usual_age_y), 1e-3);
  for (const Sex sex : {Sex::man, Sex::woman}) {
    for (const float age_y : {6.0F, 11.0F, 18.0F, 25.0F, 80.0F}) {
      for (float share = 0.03F; share < 0.66F; share += 0.01F) {
        const BodySize<float> size = make_size({.sex = sex, .age_y = age_y}, share);
        double sum = 0;
        for (std::size_t s = 0; s < segment_count; ++s) {
          EXPECT_GT(mass_fraction(size, s), 0) << segment_name[s];
          sum += mass_fraction(size, s);
        }
        EXPECT_NEAR(sum, 1, 1e-6);
      }
    }
  }
  const auto trunk = [](const Body& body) {
    double sum = 0;
    for (std::size_t s = index(Segment::pelvis); s < index(Segment::C7); ++s)
      sum += static_cast<double>(body.mass_kg[s]);
    return sum / static_cast<double>(body.request.mass_kg);
  };
  const auto thigh = [](const Body& body) {
    return static_cast<double>(body.mass_kg[index(Segment::thigh_right)] / body.request.mass_kg);
  };
  const Body lean = make_body({.height_m = 1.75F, .mass_kg = 55}).value(),
             usual = make_body({.height_m = 1.75F, .mass_kg = 75}).value(),
             heavy = make_body({.height_m = 1.75F, .mass_kg = 110}).value();
  EXPECT_LT(trunk(lean), trunk(usual));
  EXPECT_LT(trunk(usual), trunk(heavy));
  EXPECT_GT(thigh(usual), thigh(heavy));
  EXPECT_NEAR(thigh(usual), 0.988 * 0.1416, 2e-4);  // de Leva's, less the kneecap
}

}  // namespace mobil::body_composition_test
