// Lengths of bodies of both sexes and all ages: parts add up to the stature, and match measured people.

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include <mobil/anthropometry.h>
#include <mobil/engine/geometry.h>
#include "assets/body/body_scales.h"
#include "assets/body/segment_inertia.h"

namespace mobil::body_scales_test {
namespace {

using enum Segment;

BodyRequest person_of_any_age() {
  const Sex sex = *rc::gen::element(Sex::man, Sex::woman);
  const float age_y = 0.5F * static_cast<float>(*rc::gen::inRange(12, 191));
  const auto deviations = [] { return 0.01F * static_cast<float>(*rc::gen::inRange(-200, 201)); };
  const float height_z = deviations();
  return typical_body(sex, age_y, height_z, deviations());
}

double height_of(const Body& body, Segment segment) {
  return joint_centre_m(body, segment).y;
}

RC_GTEST_PROP(BodyScales, ColumnReachesTheStatureAndLegsTheGround, ()) {
  const BodyRequest request = person_of_any_age();
  const auto body = make_body(request);
  RC_ASSERT(body.has_value());
  const double crown = height_of(*body, head) + static_cast<double>(body->tip_m[index(head)].y);
  RC_ASSERT(std::fabs(crown - static_cast<double>(request.height_m)) < 1e-6);
  const double sole = height_of(*body, foot_right) + static_cast<double>(body->heel_m.y);
  RC_ASSERT(std::fabs(sole) < 1e-6);
  for (const float scale : group_scales(body->size))
    RC_ASSERT(scale > 0.7F * request.height_m && scale < 1.5F * request.height_m);
}

/// Means of people of one sex, m: classes about percentiles of stature and of mass index, of the odd-numbered subjects
/// of ANSUR II (2012 Anthropometric Survey of U.S. Army Personnel, NATICK/TR-15/007; public). The fit in
/// assets/body/body_scales.cpp saw the even-numbered ones.
struct Measured {
  Sex sex;
  double height, mass_kg, acromion, c7, biacromial, upper_arm, forearm, hand;
};
constexpr Measured ansur[] = {
    {Sex::man, 1.7562, 85.28, 1.4407, 1.5171, 0.4152, 0.3351, 0.2677, 0.1931},    // mean
    {Sex::man, 1.6494, 75.10, 1.3449, 1.4191, 0.4002, 0.3132, 0.2509, 0.1828},    // percentile 5
    {Sex::man, 1.7540, 85.06, 1.4379, 1.5149, 0.4136, 0.3344, 0.2674, 0.1929},    // percentile 50
    {Sex::man, 1.8681, 95.37, 1.5387, 1.6180, 0.4319, 0.3583, 0.2846, 0.2036},    // percentile 95
    {Sex::man, 1.7594, 70.04, 1.4386, 1.5159, 0.4050, 0.3352, 0.2673, 0.1919},    // mass index percentile 10
    {Sex::man, 1.7592, 102.12, 1.4510, 1.5238, 0.4241, 0.3353, 0.2690, 0.1948},   // mass index percentile 90
    {Sex::woman, 1.6300, 67.51, 1.3363, 1.3971, 0.3656, 0.3115, 0.2414, 0.1811},  // mean
    {Sex::woman, 1.5274, 58.69, 1.2453, 1.3050, 0.3517, 0.2866, 0.2266, 0.1710},  // percentile 5
    {Sex::woman, 1.6255, 66.49, 1.3315, 1.3919, 0.3664, 0.3107, 0.2413, 0.1809},  // percentile 50
    {Sex::woman, 1.7399, 77.75, 1.4348, 1.4978, 0.3801, 0.3329, 0.2557, 0.1910},  // percentile 95
    {Sex::woman, 1.6250, 56.54, 1.3310, 1.3938, 0.3607, 0.3080, 0.2396, 0.1798},  // mass index percentile 10
    {Sex::woman, 1.6239, 78.64, 1.3330, 1.3915, 0.3668, 0.3114, 0.2393, 0.1823},  // mass index percentile 90
};

TEST(BodyScales, MeetMeasuredAdults) {
  constexpr double joints_of_breadth = 0.845, percent = 0.01;
  for (const Measured& of : ansur) {
    BodyRequest request{.height_m = static_cast<float>(of.height), .mass_kg = static_cast<float>(of.mass_kg)};
    request.sex = of.sex;
    const Body body = *make_body(request);
    const auto along = [&](Segment s) { return -static_cast<double>(body.joint_offset_m[index(s)].y); };
    const auto meets = [&](double length, double measured, double within, const char* what) {
      EXPECT_NEAR(length / measured, 1, within * percent)
          << what << " of " << of.height << " m, " << of.mass_kg << " kg";
    };
    meets(height_of(body, upper_arm_right), of.acromion, 1.5, "shoulder height");
    meets(0.5 * (height_of(body, C7) + height_of(body, C6)), of.c7, 1, "height of C7");
    meets(-2 * joint_centre_m(body, upper_arm_right).x, joints_of_breadth * of.biacromial, 2, "shoulder joints apart");
    meets(along(forearm_right), of.upper_arm, 2.5, "upper arm");
    meets(along(hand_right), of.forearm, 2.5, "forearm");
    meets(2 * along(fingers_right), of.hand, 3, "hand");
  }
}

/// Leg over stature, over that of the same sex at 18 years: means of Berkeley's children (Tuddenham & Snyder 1954) and
/// of Pinzone and others' (2014).
TEST(BodyScales, ChildrensLegsAreShorterThenLonger) {
  for (const Sex sex : {Sex::man, Sex::woman}) {
    double before = 0;
    for (const float age_y : {6.0F, 8.0F, 10.0F, 12.0F}) {
      const Body body = *make_body(typical_body(sex, age_y));
      const double leg = static_cast<double>(body.hip_height_m) / static_cast<double>(body.request.height_m);
      EXPECT_GT(leg, before) << age_y;
      before = leg;
    }
    const Body adult = *make_body(typical_body(sex, 18));
    EXPECT_GT(before, static_cast<double>(adult.hip_height_m / adult.request.height_m));
  }
}

TEST(BodyScales, AreContinuousInAge) {
  for (const Sex sex : {Sex::man, Sex::woman}) {
    for (float age_y = 6; age_y < 94; age_y += 0.5F) {
      const auto now = group_scales(make_body(typical_body(sex, age_y))->size);
      const auto next = group_scales(make_body(typical_body(sex, age_y + 0.5F))->size);
      for (std::size_t g = 0; g < now.size(); ++g) EXPECT_NEAR(next[g] / now[g], 1, 0.04) << age_y << ", group " << g;
    }
  }
}

/// Old people lose height in the trunk alone.
TEST(BodyScales, OldPeopleKeepTheirLimbs) {
  for (const Sex sex : {Sex::man, Sex::woman}) {
    const Body young = *make_body(typical_body(sex, 30)), old = *make_body(typical_body(sex, 80));
    EXPECT_LT(old.request.height_m, young.request.height_m - 0.04F);
    EXPECT_NEAR(old.thigh_length_m, young.thigh_length_m, 1e-3);
    EXPECT_NEAR(limb_lengths(old).forearm_m, limb_lengths(young).forearm_m, 2e-3);
    EXPECT_LT(old.size.trunk_scale_m, 0.95F * young.size.trunk_scale_m);
  }
}

}  // namespace
}  // namespace mobil::body_scales_test
