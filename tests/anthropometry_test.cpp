// Bodies from height and mass: the parts add up to the whole.
#include "assets/anthropometry.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

namespace mobil {
namespace {

BodyRequest any_request() {
  BodyRequest r;
  r.height_m = static_cast<float>(*rc::gen::inRange(12000, 22001) * 1e-4);
  r.mass_kg = static_cast<float>(*rc::gen::inRange(30000, 200001) * 1e-3);
  return r;
}

RC_GTEST_PROP(Anthropometry, MassesAddUpWithoutRoundingInAnyOrder, ()) {
  const BodyRequest r = any_request();
  const auto body = make_body(r);
  RC_ASSERT(body.has_value());
  float up = 0, down = 0;
  for (std::size_t i = 0; i < segment_count; ++i) {
    RC_ASSERT(body->mass_kg[i] > 0.0F);
    up += body->mass_kg[i];
    down += body->mass_kg[segment_count - 1 - i];
  }
  RC_ASSERT(up == r.mass_kg);
  RC_ASSERT(down == r.mass_kg);
}

RC_GTEST_PROP(Anthropometry, TheColumnReachesTheStatureAndTheLegsTheGround, ()) {
  const BodyRequest r = any_request();
  const auto body = make_body(r);
  RC_ASSERT(body.has_value());
  double height = body->joint_offset_m[index(Segment::pelvis)].y;
  for (std::size_t i = index(Segment::L5); i <= index(Segment::head); ++i) height += body->joint_offset_m[i].y;
  height += body->tip_m[index(Segment::head)].y;
  RC_ASSERT(std::fabs(height - r.height_m) < 1e-6 * r.height_m);
  const double ankle = -body->heel_m.y;
  const double hip = body->thigh_length_m + body->shank_length_m + ankle;
  RC_ASSERT(std::fabs(hip - body->hip_height_m) < 1e-6);
  RC_ASSERT(std::fabs(hip - 0.530 * r.height_m) < 1e-6);
  RC_ASSERT(std::fabs(ankle + body->ball_m.y) < 1e-7);
}

RC_GTEST_PROP(Anthropometry, LeftMirrorsRight, ()) {
  const auto body = make_body(any_request());
  RC_ASSERT(body.has_value());
  for (Segment s : {Segment::thigh_right, Segment::patella_right, Segment::shank_right, Segment::foot_right,
                    Segment::toes_right, Segment::clavicle_right, Segment::upper_arm_right, Segment::forearm_right,
                    Segment::hand_right, Segment::fingers_right, Segment::thumb_right}) {
    const std::size_t a = index(s), b = index(on_side(s, left));
    for (const auto* field : {&body->joint_offset_m, &body->centre_of_mass_m, &body->tip_m}) {
      RC_ASSERT((*field)[a].x == -(*field)[b].x);
      RC_ASSERT((*field)[a].y == (*field)[b].y);
      RC_ASSERT((*field)[a].z == (*field)[b].z);
    }
    RC_ASSERT(body->mass_kg[a] == body->mass_kg[b]);
  }
}

TEST(Anthropometry, GroupsOfSegmentsCarryDempstersFractions) {
  auto sum = [](Segment from, Segment to) {
    double m = 0;
    for (std::size_t i = index(from); i <= index(to); ++i) m += unit_body.mass_fraction[i];
    return m;
  };
  using enum Segment;
  EXPECT_NEAR(sum(thigh_right, toes_right), 0.161, 1e-12);
  EXPECT_NEAR(sum(upper_arm_left, thumb_left), 0.050, 1e-12);
  EXPECT_NEAR(sum(foot_right, toes_right), 0.0145, 1e-12);
  EXPECT_NEAR(sum(C7, head), 0.081, 1e-12);
  EXPECT_NEAR(sum(pelvis, head) + 2 * unit_body.mass_fraction[index(clavicle_right)] + 2 * 0.050, 0.678, 1e-12);
  EXPECT_NEAR(sum(pelvis, thumb_left), 1.0, 1e-12);
}

TEST(Anthropometry, StandingCentreOfMassIsWhereItIsMeasured) {
  // Over the foot, a little over half the height: 0.54–0.57 is measured, Dempster's own segments give 0.58.
  std::array<Vec3<double>, segment_count> place{};
  double y = 0, z = 0, x = 0;
  for (std::size_t i = 0; i < segment_count; ++i) {
    const Vec3<double>& o = unit_body.joint_offset[i];
    const Vec3<double>& p = place[index(segment_parent[i])];
    place[i] = i == 0 ? o : Vec3<double>{p.x + o.x, p.y + o.y, p.z + o.z};
    y += unit_body.mass_fraction[i] * (place[i].y + unit_body.centre_of_mass[i].y);
    z += unit_body.mass_fraction[i] * (place[i].z + unit_body.centre_of_mass[i].z);
    x += unit_body.mass_fraction[i] * (place[i].x + unit_body.centre_of_mass[i].x);
  }
  EXPECT_NEAR(x, 0.0, 1e-12);
  EXPECT_GT(y, 0.54);
  EXPECT_LT(y, 0.582);
  EXPECT_GT(z, -fraction::heel_back);
  EXPECT_LT(z, fraction::ball_forward);
}

TEST(Anthropometry, RefusesBodiesOutsideTheRangeInOneLine) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  auto refused = [](BodyRequest r, const char* what) {
    const auto body = make_body(r);
    ASSERT_FALSE(body.has_value()) << what;
    EXPECT_NE(body.error().message.find(what), std::string::npos) << body.error().message;
    EXPECT_EQ(body.error().message.find('\n'), std::string::npos);
  };
  for (float height : {1.19F, 2.21F, 0.0F, -1.8F, nan, inf}) refused({.height_m = height}, "1.2–2.2 m");
  for (float mass : {29.9F, 200.1F, -70.0F, nan, inf}) refused({.mass_kg = mass}, "30–200 kg");
  for (float part : {0.0F, 12.1F, nan}) refused({.biotype = {3, part, 3}}, "mesomorphy");
}

}  // namespace
}  // namespace mobil
