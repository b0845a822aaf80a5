// Body composition, compared with the published tables that it follows, and the resolution of contradictory requests.
#include <mobil/body_composition.h>
#include "assets/body/fat_distribution.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
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
  EXPECT_NEAR(fat_share_of_mass_index(24.5), usual_fat_share, 1e-3);
  for (double share = 0.03; share < 0.66; share += 0.01) {
    const double extra = extra_fat(share);
    double sum = 0;
    for (std::size_t s = 0; s < segment_count; ++s) {
      EXPECT_GT(mass_fraction(s, extra), 0) << segment_name[s];
      sum += mass_fraction(s, extra);
    }
    EXPECT_NEAR(sum, 1, 1e-12);
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
  EXPECT_NEAR(thigh(usual), unit_body.mass_fraction[index(Segment::thigh_right)], 2e-4);
}

}  // namespace mobil::body_composition_test
