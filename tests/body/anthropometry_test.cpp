// Bodies from height and mass: parts add up to the whole, and match published tables.
#include <mobil/anthropometry.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>
#include <vector>

#include <mobil/components/gait.h>
#include <mobil/simulation.h>
#include "assets/body/fat_distribution.h"
#include "assets/body/joint_limits.h"
#include "assets/body/segment_inertia.h"
#include "assets/body/segment_masses.h"
#include "tests/body/rigid_sum.h"
#include "tests/refused.h"
#include "tests/simulation/people.h"

namespace mobil::anthropometry_test {
/// Returns the limit of a joint and motion, or null.
const JointLimit* find_joint_limit(std::string_view joint, std::string_view motion) {
  for (const JointLimit& limit : limb_limits) {
    if (limit.joint == joint && limit.motion == motion) return &limit;
  }
  return nullptr;
}

BodyRequest any_request() {
  BodyRequest r;
  r.height_m = static_cast<float>(*rc::gen::inRange(12000, 22001) * 1e-4);
  r.mass_kg = living_mass(r.height_m, *rc::gen::inRange(0, 10001) * 1e-4);
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

RC_GTEST_PROP(Anthropometry, SpineReachesStatureAndLegsReachTheGround, ()) {
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
  RC_ASSERT(std::fabs(hip - 0.516 * r.height_m) < 0.065 * hip);  // ANSUR II: 0.513, 0.519; taller people's are longer
  RC_ASSERT(std::fabs(ankle + body->ball_m.y) < 1e-7);
}

RC_GTEST_PROP(Anthropometry, LeftMirrorsRight, ()) {
  const auto body = make_body(any_request());
  RC_ASSERT(body.has_value());
  for (Segment s : {Segment::thigh_right, Segment::patella_right, Segment::shank_right, Segment::foot_right,
                    Segment::toes_right, Segment::clavicle_right, Segment::upper_arm_right, Segment::forearm_right,
                    Segment::hand_right, Segment::fingers_right, Segment::thumb_right}) {
    const std::size_t a = index(s), b = index(on_side(s, Side::left));
    for (const auto* field : {&body->joint_offset_m, &body->centre_of_mass_m, &body->tip_m}) {
      RC_ASSERT((*field)[a].x == -(*field)[b].x);
      RC_ASSERT((*field)[a].y == (*field)[b].y);
      RC_ASSERT((*field)[a].z == (*field)[b].z);
    }
    RC_ASSERT(body->mass_kg[a] == body->mass_kg[b]);
  }
}

/// De Leva 1996, table 4; forearm with hand.
TEST(Anthropometry, AdultsHaveDeLevasMasses) {
  using enum Segment;
  struct Published {
    Sex sex;
    double head, trunk, upper_arm, forearm, thigh, shank, foot;
  };
  for (const Published& of : {Published{Sex::man, 0.0694, 0.4346, 0.0271, 0.0223, 0.1416, 0.0433, 0.0137},
                              Published{Sex::woman, 0.0668, 0.4257, 0.0255, 0.0194, 0.1478, 0.0481, 0.0129}}) {
    const GroupMasses masses = group_masses({.sex = of.sex}, usual_fat_share(of.sex, usual_age_y));
    const auto mass = [&](MassGroup group) { return masses[static_cast<std::size_t>(group)]; };
    using enum MassGroup;
    EXPECT_NEAR(mass(MassGroup::head), of.head, 5e-4);
    EXPECT_NEAR(mass(upper_trunk) + mass(middle_trunk) + mass(lower_trunk), of.trunk, 1e-3);
    EXPECT_NEAR(mass(upper_arm), of.upper_arm, 1e-4);
    EXPECT_NEAR(mass(forearm), of.forearm, 1e-4);
    EXPECT_NEAR(mass(thigh), of.thigh, 1e-4);
    EXPECT_NEAR(mass(shank), of.shank, 1e-4);
    EXPECT_NEAR(mass(foot), of.foot, 1e-4);
  }
}

/// Change of the masses of Jensen's boys (J. Biomech. 19, 1986) from 18 years to 6, 12 and 15.
TEST(Anthropometry, ChildrensMassesChangeAsJensens) {
  struct Change {
    MassGroup group;
    std::array<double, 3> of_18;
  };
  using enum MassGroup;
  const Change published[] = {{MassGroup::head, {2.600, 1.443, 0.960}},
                              {upper_arm, {0.667, 0.889, 0.975}},
                              {thigh, {0.746, 0.965, 1.065}},
                              {shank, {0.958, 1.104, 1.170}},
                              {foot, {1.117, 1.235, 1.239}}};
  constexpr std::array<float, 3> ages_y = {6, 12, 15};
  for (const Sex sex : {Sex::man, Sex::woman}) {
    const auto masses = [&](float age_y) {
      return group_masses({.sex = sex, .age_y = age_y}, usual_fat_share(sex, age_y));
    };
    for (const Change& of : published) {
      const auto g = static_cast<std::size_t>(of.group);
      for (std::size_t a = 0; a < ages_y.size(); ++a)
        EXPECT_NEAR(masses(ages_y[a])[g] / masses(18)[g], of.of_18[a], 0.01) << ages_y[a] << ", group " << g;
    }
  }
}

/// Measured 0.54–0.57 of the stature in adults; higher in children, whose heads are heavy.
TEST(Anthropometry, StandingCentreOfMassIsInTheMeasuredRange) {
  struct Range {
    float age_y;
    double low, high;
  };
  for (const Sex sex : {Sex::man, Sex::woman}) {
    for (const Range& of :
         {Range{7, 0.56, 0.62}, Range{12, 0.54, 0.60}, Range{25, 0.54, 0.575}, Range{70, 0.54, 0.58}}) {
      const Body body = *make_body(typical_body(sex, of.age_y));
      double x = 0, y = 0, z = 0;
      for (std::size_t i = 0; i < segment_count; ++i) {
        const Vec3<double> at = joint_centre_m(body, static_cast<Segment>(i));
        const double part = static_cast<double>(body.mass_kg[i] / body.request.mass_kg);
        x += part * (at.x + static_cast<double>(body.centre_of_mass_m[i].x));
        y += part * (at.y + static_cast<double>(body.centre_of_mass_m[i].y));
        z += part * (at.z + static_cast<double>(body.centre_of_mass_m[i].z));
      }
      const auto height = static_cast<double>(body.request.height_m);
      EXPECT_NEAR(x, 0, 1e-6);
      EXPECT_GT(y, of.low * height) << of.age_y;
      EXPECT_LT(y, of.high * height) << of.age_y;
      EXPECT_GT(z, static_cast<double>(body.heel_m.z));
      EXPECT_LT(z, static_cast<double>(body.ball_m.z));
    }
  }
}

TEST(Anthropometry, RefusesBodiesOutsideTheRangeInOneLine) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  auto refused = [](BodyRequest r, const char* what) { EXPECT_TRUE(is_refused(make_body(r), what)) << what; };
  for (float height : {1.19F, 2.21F, 0.0F, -1.8F, nan, inf}) refused({.height_m = height}, "1.2–2.2 m");
  for (float mass : {29.9F, 200.1F, -70.0F, nan, inf}) refused({.mass_kg = mass}, "30–200 kg");
  for (float part : {0.0F, 12.1F, nan}) refused({.biotype = {3, part, 3}}, "mesomorphy");
}

TEST(Anthropometry, RefusesImpossibleMassesAndNamesTheRange) {
  auto message = [](float height, float mass) {
    const auto body = make_body({.height_m = height, .mass_kg = mass});
    EXPECT_FALSE(body.has_value()) << height << " m, " << mass << " kg";
    return body ? std::string() : body.error().message;
  };
  EXPECT_NE(message(2.2F, 30).find("58.1–200.0 kg"), std::string::npos);
  EXPECT_NE(message(1.2F, 200).find("30.0–132.4 kg"), std::string::npos);
  for (const auto& [height, mass] : {std::array{2.2F, 58.1F}, {2.2F, 200.0F}, {1.2F, 30.0F}, {1.2F, 132.4F}}) {
    EXPECT_TRUE(make_body({.height_m = height, .mass_kg = mass}).has_value()) << height << " m, " << mass << " kg";
  }
}

// ----------------------------------------------------------------------------------------------- published tables

/// De Leva 1996, table 4, men of 1.741 m and 73 kg: radii of gyration across the segment, over the stature.
TEST(Anthropometry, LimbsHaveDeLevasInertias) {
  using enum Segment;
  const Body body = make_body({.height_m = 1.741F, .mass_kg = 73}).value();
  struct Published {
    std::vector<Segment> segments;
    double x, z;
  };
  for (const Published& of :
       {Published{{thigh_right, patella_right}, 0.0798, 0.0798}, Published{{shank_right}, 0.0613, 0.0626},
        Published{{upper_arm_right}, 0.0435, 0.0461}, Published{{forearm_right}, 0.0409, 0.0426}}) {
    SCOPED_TRACE(segment_name[index(of.segments.front())]);
    const RigidSum sum = rigid_sum(body, of.segments);
    EXPECT_NEAR(std::sqrt(sum.inertia_kg_m2.x / sum.mass_kg) / 1.741 / of.x, 1, 0.05);
    EXPECT_NEAR(std::sqrt(sum.inertia_kg_m2.z / sum.mass_kg) / 1.741 / of.z, 1, 0.05);
  }
  // The foot's length runs from the ankle to the second toe's head, forward and down (Winter).
  const RigidSum foot = rigid_sum(body, std::array{foot_right, toes_right});
  const double length = std::hypot(static_cast<double>(body.tip_m[index(foot_right)].y),
                                   static_cast<double>(body.tip_m[index(foot_right)].z));
  EXPECT_NEAR(std::sqrt(foot.inertia_kg_m2.x / foot.mass_kg) / length, 0.475, 0.01);
}

TEST(Anthropometry, TrunkHeadAndHandHavePublishedInertias) {
  using enum Segment;
  const Body body = make_body({.height_m = 1.80F, .mass_kg = 79.38F}).value();
  auto run = [](Segment from, Segment to, std::vector<Segment> more = {}) {
    for (std::size_t s = index(from); s <= index(to); ++s) more.push_back(static_cast<Segment>(s));
    return more;
  };
  auto close = [&](const std::vector<Segment>& segments, const de_leva::Part& part, double within) {
    const RigidSum sum = rigid_sum(body, segments);
    const double unit = 1.80 * part.length_m / de_leva::stature_m;
    EXPECT_NEAR(std::sqrt(sum.inertia_kg_m2.x / sum.mass_kg) / unit / part.x, 1, within);
    EXPECT_NEAR(std::sqrt(sum.inertia_kg_m2.z / sum.mass_kg) / unit / part.z, 1, within);
    return std::sqrt(sum.inertia_kg_m2.y / sum.mass_kg) / unit / part.y;
  };
  EXPECT_NEAR(close(run(pelvis, T1, {clavicle_right, clavicle_left}), de_leva::whole_trunk, 0.02), 1, 0.02);
  EXPECT_NEAR(close(run(C7, head), de_leva::head_and_neck, 0.1), 1, 0.1);
  close(run(hand_right, thumb_right), de_leva::hand, 0.15);
}

RC_GTEST_PROP(Anthropometry, InertiasAreThoseOfSolidsAndGrowWithTheBody, ()) {
  const BodyRequest r = any_request();
  const Body body = make_body(r).value();
  const Body taller = make_body({.height_m = r.height_m + 0.01F, .mass_kg = r.mass_kg}).value_or(body);
  for (std::size_t s = 0; s < segment_count; ++s) {
    const Vec3<double> i = segment_inertia_kg_m2(body, static_cast<Segment>(s));
    RC_ASSERT(i.x > 0 && i.y > 0 && i.z > 0);
    RC_ASSERT(i.x <= i.y + i.z && i.y <= i.x + i.z && i.z <= i.x + i.y);
    const double far = static_cast<double>(body.mass_kg[s]) * std::pow(0.15 * static_cast<double>(r.height_m), 2);
    RC_ASSERT(i.x < far && i.y < far && i.z < far);
    RC_ASSERT(segment_inertia_kg_m2(taller, static_cast<Segment>(s)).x >=
              0.97 * i.x);  // limbs of the less fat are lighter
  }
}

// --------------------------------------------------------------------------------------------------- joint limits

TEST(JointLimits, ContainEveryPostureOfGaitParameters) {
  const auto holds = [](std::string_view joint, std::string_view motion, std::string_view name, double sign = 1) {
    const JointLimit* limit = find_joint_limit(joint, motion);
    ASSERT_NE(limit, nullptr) << joint << ' ' << motion;
    for (const GaitParameter& p : gait_parameters) {
      if (p.name != name) continue;
      for (const float value : {p.low, p.high}) {
        EXPECT_GE(sign * static_cast<double>(value), limit->low_deg) << name;
        EXPECT_LE(sign * static_cast<double>(value), limit->high_deg) << name;
      }
      return;
    }
    FAIL() << name;
  };
  for (const char* knee : {"strike_knee_deg", "stance_knee_deg", "toe_off_knee_deg", "swing_knee_deg"}) {
    holds("knee", "flexion-extension", knee);
  }
  holds("ankle", "dorsiflexion-plantarflexion", "swing_ankle_deg");
  holds("hip", "internal-external rotation", "toe_out_deg", -1);
  holds("shoulder", "flexion-extension", "arm_forward_deg");
  holds("shoulder", "flexion-extension", "arm_back_deg", -1);
  holds("shoulder", "abduction-adduction", "arm_abduction_deg");
  holds("elbow", "flexion-extension", "elbow_back_deg");
  holds("elbow", "flexion-extension", "elbow_forward_deg");
  holds("forearm", "pronation", "forearm_pronation_deg");
  holds("metacarpophalangeal", "flexion-extension", "finger_flexion_deg");
}

TEST(JointLimits, ContainWalksAtEverySpeedOfEveryBody) {
  struct Angle {
    const JointLimit* limit;
    float (JointAngles<float>::*angle)[2];
    const char* name;
  };
  const Angle table[] = {
      {find_joint_limit("hip", "flexion-extension"), &JointAngles<float>::hip_flexion, "hip"},
      {find_joint_limit("knee", "flexion-extension"), &JointAngles<float>::knee_flexion, "knee"},
      {find_joint_limit("ankle", "dorsiflexion-plantarflexion"), &JointAngles<float>::ankle_dorsiflexion, "ankle"},
      {find_joint_limit("shoulder", "flexion-extension"), &JointAngles<float>::shoulder_flexion, "shoulder"},
      {find_joint_limit("elbow", "flexion-extension"), &JointAngles<float>::elbow_flexion, "elbow"}};
  Simulation simulation;
  std::vector<Entity> people;
  for (const float height : {1.2F, 1.75F, 2.2F}) {
    for (const float speed : {0.8F, 1.1F, 1.4F, 1.8F}) {
      const float froude = std::sqrt(height / 1.75F);
      people.push_back(
          *simulation.spawn({.height_m = height, .mass_kg = living_mass(height, 0.35)}, {.speed_m_s = speed * froude}));
    }
  }
  for (int tick = 0; tick < 180; ++tick) {
    simulation.tick();
    for (const Entity person : people) {
      const auto angles = *simulation.get<JointAngles>(person);
      for (const Angle& joint : table) {
        for (std::size_t side = 0; side < 2; ++side) {
          const double deg = static_cast<double>((angles.*joint.angle)[side]) * 180 / std::numbers::pi;
          ASSERT_GE(deg, joint.limit->low_deg) << joint.name << " at tick " << tick;
          ASSERT_LE(deg, joint.limit->high_deg) << joint.name << " at tick " << tick;
        }
      }
    }
  }
}

TEST(JointLimits, SpinalRegionsMatchPublishedRanges) {
  // Regions of White & Panjabi: neck, chest, loins. Flexion includes extension; rotation is one-sided.
  auto sum = [](Segment from, Segment to, double VertebraLimit::*part) {
    double all = 0;
    for (std::size_t s = index(from); s <= index(to); ++s) all += vertebra_limits[s - index(Segment::L5)].*part;
    return all;
  };
  using enum Segment;
  EXPECT_NEAR(sum(L5, L1, &VertebraLimit::flexion_extension), 75, 15);
  EXPECT_NEAR(sum(T12, T1, &VertebraLimit::flexion_extension), 76, 10);
  EXPECT_NEAR(sum(C7, C1, &VertebraLimit::flexion_extension), 110, 15);
  EXPECT_LT(sum(L5, L1, &VertebraLimit::rotation), 13);
  EXPECT_NEAR(sum(C7, C1, &VertebraLimit::rotation), 80, 15);
  for (const JointLimit& limit : limb_limits) EXPECT_LT(limit.low_deg, limit.high_deg) << limit.joint;
}

}  // namespace mobil::anthropometry_test
