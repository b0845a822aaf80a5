// Contact forces in a leg's joints, and activations compared with electromyograms.
#include "demo/lab/compare/joint_contact.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <string_view>

#include <mobil/anthropometry.h>
#include <mobil/engine/geometry.h>
#include <mobil/systems/muscles/person.h>
#include "demo/lab/compare/compare_muscles.h"
#include "tests/lines/turned_leg.h"

namespace mobil::joint_contact_test {
namespace {

using namespace geometry;
using test::Angles;

bool crosses(const Pull& pull) {
  return dot(pull.direction, pull.direction) > 0.5;
}

/// Virtual work: the moment of a pull about a joint's axis is the change of the line's length with the angle.
TEST(JointContact, PullsHaveTheArmsOfTheirLines) {
  const Body body = make_body({1.80F, 80}).value();
  const LegScale<double> scale = leg_scale(body);
  const double thigh_m = static_cast<double>(body.thigh_length_m), shank_m = static_cast<double>(body.shank_length_m);
  std::mt19937 dice(3);
  const auto between = [&](double low, double high) {
    return test::degree * std::uniform_real_distribution<double>(low, high)(dice);
  };
  int hips = 0, ankles = 0;
  for (int pose = 0; pose < 20; ++pose) {
    const Angles q = {between(-20, 60), 0, 0, between(0, 90), between(-20, 20), 0, 0};
    const LegFrames<double> leg = test::turned_leg(q, thigh_m, shank_m), there = rolled(scale, leg);
    for (const MemberMuscle& line : member_muscles()) {
      const auto length = [&](const Angles& at) {
        return member_length(line, scale, test::turned_leg(at, thigh_m, shank_m));
      };
      const auto pulls = pulls_of(line, scale, leg);
      const auto turning = [&](std::size_t joint, const Vec& centre, const Vec& axis) {
        return dot(cross(pulls[joint].at_m - centre, pulls[joint].direction), axis);
      };
      const Vec left{1, 0, 0};  // flexion turns the leg about the axis to the right
      EXPECT_NEAR(-turning(at_hip, leg.hip_m, rotated(leg.pelvis, left)), test::arm(length, q, test::hip_flexion), 1e-6)
          << line.name;
      EXPECT_NEAR(-turning(at_ankle, there.ankle_m, rotated(leg.shank, left)), test::arm(length, q, test::ankle), 1e-6)
          << line.name;
      hips += crosses(pulls[at_hip]) ? 1 : 0;
      ankles += crosses(pulls[at_ankle]) ? 1 : 0;
    }
  }
  EXPECT_EQ(hips, 20 * 21);
  EXPECT_EQ(ankles, 20 * 13);
}

/// Each leg of a standing person carries half of the weight above it.
TEST(JointContact, StandingLegsCarryTheBodyAbove) {
  Simulation simulation;
  const Entity entity = simulation.spawn({.height_m = 1.8F, .mass_kg = 80}, {.speed_m_s = 0}).value();
  ASSERT_TRUE(simulation.enable(entity, Feature::forces));
  for (int tick = 0; tick < 120; ++tick) simulation.tick();
  const Pose<float> pose = *simulation.get<Pose>(entity);
  const Body body = simulation.person(entity)->body;
  const JointForces whole =
      intersegmental_forces(body, {pose, pose, pose}, *simulation.get<GroundReaction>(entity), 1.0 / 60);
  double leg_kg = 0, all_kg = 0;
  for (std::size_t s = 0; s < segment_count; ++s) all_kg += static_cast<double>(body.mass_kg[s]);
  for (std::size_t s = index(Segment::thigh_right); s <= index(Segment::toes_right); ++s)
    leg_kg += static_cast<double>(body.mass_kg[s]);
  EXPECT_NEAR(whole[at_hip].y, -9.81 * (all_kg / 2 - leg_kg), 0.03 * 9.81 * all_kg);
  EXPECT_LT(whole[at_ankle].y, whole[at_knee].y);
  EXPECT_LT(whole[at_knee].y, whole[at_hip].y);
}

TEST(MuscleComparison, GluteiVastiAndCalfAgreeWithElectromyograms) {
  const MuscleComparison comparison = compare_muscles({.height_m = 1.8F, .mass_kg = 80}, {});
  const MuscleStride& stride = comparison.at(emg_speed_m_s);
  const std::map<Muscle, double> least = {
      {Muscle::gluteus_maximus, 0.74}, {Muscle::gluteus_medius, 0.74},       {Muscle::vastus_medialis, 0.7},
      {Muscle::vastus_lateralis, 0.7}, {Muscle::gastrocnemius_medial, 0.74}, {Muscle::gastrocnemius_lateral, 0.74},
      {Muscle::soleus, 0.74},          {Muscle::peroneus_longus, 0.6},       {Muscle::biceps_femoris_long_head, 0.6}};
  std::size_t judged = 0;
  for (const Emg& emg : comparison.emg) {
    const auto found = least.find(emg.muscle);
    if (found == least.end()) continue;
    ++judged;
    EXPECT_GT(emg_correlation(stride, emg), found->second) << muscle_name(emg.muscle) << ", " << emg.source;
  }
  EXPECT_EQ(judged, 13U);
  // Forces in joints exceed the weight, which muscles add to, and grow with speed as on implants.
  double slower_hip = 1, slower_knee = 1;
  for (const MuscleStride& one : comparison.strides) {
    EXPECT_GT(one.peak(at_hip), slower_hip);
    EXPECT_GT(one.peak(at_knee), slower_knee);
    slower_hip = one.peak(at_hip), slower_knee = one.peak(at_knee);
    EXPECT_GT(one.peak(at_ankle), 3);
  }
  EXPECT_LT(slower_hip, 8);
  EXPECT_LT(slower_knee, 6);
}

}  // namespace
}  // namespace mobil::joint_contact_test
