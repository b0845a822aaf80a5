// The muscles' figures compared with publications, and plans for any body.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <map>
#include <set>

#include <mobil/anthropometry.h>
#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/assets/muscles/leg_sections.h>
#include <mobil/assets/muscles/muscle_plan.h>
#include <mobil/muscle_table.h>
#include "assets/surfaces/muscle_lattice.h"
#include "tests/lines/leg_pose.h"
#include "tests/refused.h"
#include "tests/simulation/people.h"

namespace mobil::muscle_table_test {
using namespace geometry;
using test::degree;
using test::LegAngles;
using test::posed;

constexpr std::array groups = {Muscle::hamstrings, Muscle::quadriceps, Muscle::triceps_surae,
                               Muscle::tibialis_anterior};

Body body_of(float height_m, float mass_kg, Constitution constitution = Constitution::average, float meso = 4) {
  return make_body({height_m, mass_kg, {3, meso, 3}, constitution}).value();
}
const Body reference = body_of(1.80F, 80);

MusclePlan plan_of(const Body& body, Muscle group) {
  return make_muscle_plan(body, group).value();
}

TEST(MuscleTable, EveryMemberRunsFromAFixedOriginToAFixedEnd) {
  std::set<std::string_view> names;
  std::size_t in_groups = 0;
  for (std::size_t m = 0; m < muscles().size(); ++m) {
    const auto muscle = static_cast<Muscle>(m);
    if (muscle_groups()[m]) in_groups += members_of(muscle).size();
    EXPECT_EQ(is_muscle_group(muscle), muscle_groups()[m]);
    EXPECT_EQ(find_muscle(muscle_name(muscle)), muscle);
  }
  constexpr std::size_t of_no_group = 8;
  EXPECT_EQ(in_groups + of_no_group, member_muscles().size());
  EXPECT_EQ(muscle_groups().count(), 12U);
  EXPECT_EQ(muscle_members().count(), 38U);
  EXPECT_EQ((muscle_groups() | muscle_members()).count(), muscle_count);
  MuscleSet with_lines;
  for (const MemberMuscle& line : member_muscles()) with_lines.set(static_cast<std::size_t>(muscle_of_line(line)));
  EXPECT_EQ(muscle_members(), with_lines);
  for (const auto& m : member_muscles()) {
    names.insert(m.name);
    EXPECT_GE(m.path.size() + (m.kneecap ? 1 : 0), 2U) << m.name;
    EXPECT_EQ(m.path.front().hold, PathHold::fixed) << m.name;
    EXPECT_TRUE(m.kneecap || m.path.back().hold == PathHold::fixed) << m.name;
    for (const PathPoint& p : m.path) {
      EXPECT_TRUE(p.hold == PathHold::fixed || p.bone != LegBone::foot) << m.name;
    }
    for (std::size_t i = 1; i < m.path.size(); ++i) EXPECT_GE(m.path[i].bone, m.path[i - 1].bone) << m.name;
    for (std::size_t i = 1; i < m.sections.size(); ++i) EXPECT_GT(m.sections[i].level, m.sections[i - 1].level);
  }
  EXPECT_EQ(names.size(), member_muscles().size());
}

// Handsfield et al. 2014, tabulated by the regression for 80 kg and 1.80 m, cm³.
TEST(MuscleTable, VolumesMatchPublishedOnes) {
  const std::map<std::string_view, double> published = {{"semimembranosus", 275.1},
                                                        {"semitendinosus", 212.7},
                                                        {"biceps_femoris_long_head", 230.5},
                                                        {"biceps_femoris_short_head", 115.0},
                                                        {"rectus_femoris", 303.7},
                                                        {"vastus_medialis", 491.8},
                                                        {"vastus_intermedius", 296.3},
                                                        {"vastus_lateralis", 950.9},
                                                        {"gastrocnemius_medial", 289.7},
                                                        {"gastrocnemius_lateral", 168.5},
                                                        {"soleus", 486.5},
                                                        {"tibialis_anterior", 149.9},
                                                        {"gluteus_maximus", 965.1},
                                                        {"gluteus_medius", 368.0},
                                                        {"gluteus_minimus", 116.5},
                                                        {"tensor_fasciae_latae", 78.0},
                                                        {"iliacus", 200.1},
                                                        {"psoas", 325.9},
                                                        {"sartorius", 188.0},
                                                        {"pectineus", 76.2},
                                                        {"adductor_longus", 186.7},
                                                        {"adductor_brevis", 116.5},
                                                        {"adductor_magnus", 633.9},
                                                        {"gracilis", 117.2},
                                                        {"piriformis", 46.2},
                                                        {"quadratus_femoris", 36.8},
                                                        {"obturator_externus", 56.4},
                                                        {"popliteus", 26.1},
                                                        {"tibialis_posterior", 114.6}};
  for (const auto& [name, cm3] : published) {
    double own = 0;
    for (const auto& line : members_of(find_muscle(name).value())) own += handsfield_volume_cm3(line, 1.80, 80);
    EXPECT_NEAR(own, cm3, 0.1) << name;
  }
  for (const auto group : groups) {
    double sum = 0, weights = 0;
    for (const auto& m : members_of(group)) {
      sum += handsfield_volume_cm3(m, 1.80, 80);
      weights += member_weight(members_of(group), m);
    }
    EXPECT_NEAR(1e6 * plan_of(reference, group).volume_m3 / sum, 1, 0.15) << muscle_name(group);
    EXPECT_NEAR(weights, 1, 1e-12);
  }
}

TEST(MusclePlan, SectionGrowsWithPhysique) {
  for (const auto group : groups) {
    const auto section = [group](Constitution c, float meso) {
      return plan_of(body_of(1.8F, 80, c, meso), group).section_m2;
    };
    const double average = section(Constitution::average, 4);
    EXPECT_LT(section(Constitution::thin, 4), average);
    EXPECT_LT(average, section(Constitution::heavy, 4));
    EXPECT_LT(section(Constitution::heavy, 4), section(Constitution::athletic, 4));
    EXPECT_LT(section(Constitution::average, 3), average);
    EXPECT_LT(average, section(Constitution::average, 6));
  }
}

RC_GTEST_PROP(MusclePlan, TallerBodyHasTheSameLegsLonger, ()) {
  const auto height = static_cast<float>(*rc::gen::inRange(1200, 2200)) / 1000;
  const float mass = living_mass(height, *rc::gen::inRange(0, 1001) / 1000.0);
  const Body body = body_of(height, mass);
  const double by = static_cast<double>(body.size.leg_scale_m / reference.size.leg_scale_m);
  for (const auto group : groups) {
    const MusclePlan own = plan_of(body, group), other = plan_of(reference, group);
    RC_ASSERT(std::abs(own.rest_length_m / (by * other.rest_length_m) - 1) < 1e-6);
    RC_ASSERT(std::abs(own.belly_length_m / (by * other.belly_length_m) - 1) < 1e-6);
    RC_ASSERT(std::abs(static_cast<double>(own.scale.along / other.scale.along) / by - 1) < 1e-6);
    // The scaled template has the plan's size.
    const double s = static_cast<double>(own.scale.across / other.scale.across);
    RC_ASSERT(std::abs(s * s * other.section_m2 / own.section_m2 - 1) < 1e-5);
  }
}

TEST(MusclePlan, BelliesAreAtTheirAnatomicalPlaces) {
  const std::map<Muscle, std::pair<double, double>> span = {{Muscle::hamstrings, {0.26, 0.30}},
                                                            {Muscle::quadriceps, {0.28, 0.33}},
                                                            {Muscle::triceps_surae, {0.22, 0.28}},
                                                            {Muscle::tibialis_anterior, {0.22, 0.30}}};
  const LegFrames<double> leg = anatomical_leg(reference);
  for (const auto group : groups) {
    const MusclePlan plan = plan_of(reference, group);
    EXPECT_GE(plan.belly_length_m, span.at(group).first);
    EXPECT_LE(plan.belly_length_m, span.at(group).second);
    EXPECT_NEAR(plan.belly_length_m, static_cast<double>(plan.scale.along) * reference_belly_m(group), 1e-7);
    EXPECT_GT(plan.tendon_length_m, 0);
    EXPECT_NEAR(plan.scale.across * plan.scale.across * plan.scale.along, 1, 1e-6) << "the volume of the reference";
    EXPECT_NEAR(plan.section_m2 * plan.belly_length_m, plan.volume_m3, 1e-12);
    const Vec z = rotated(plan.rotation, {0, 0, 1}), y = rotated(plan.rotation, {0, 1, 0});
    EXPECT_LT(z.y, -0.95);
    EXPECT_GT(y.z, 0.95);
    // Behind the thigh, in front of it, behind the shank; from the middle of the lattice.
    const LatticeStation& middle = muscle_lattice(group)[lattice_station_count / 2];
    const Vec centre =
        plan.start_m + rotated(plan.rotation, {static_cast<double>(middle.offset_x_m),
                                               static_cast<double>(middle.offset_y_m), plan.belly_length_m / 2});
    const bool on_shank = group == Muscle::triceps_surae || group == Muscle::tibialis_anterior;
    const double upper = on_shank ? leg.knee_m.y : leg.hip_m.y;
    const double lower = on_shank ? leg.ankle_m.y : leg.knee_m.y;
    EXPECT_LT(centre.y, upper);
    EXPECT_GT(centre.y, lower);
    if (group == Muscle::quadriceps || group == Muscle::tibialis_anterior) {
      EXPECT_GT(centre.z, 0.01);
    } else {
      EXPECT_LT(centre.z, -0.01);
    }
    EXPECT_LT(centre.x, 0);  // the right leg
  }
}

TEST(MusclePlan, StiffnessFollowsThePapersThirdEquation) {
  const Material material;
  EXPECT_DOUBLE_EQ(bar_stiffness(material, 0.003, 0.4), material.young_pa * 0.003 / 0.4);
}

TEST(MusclePlan, UnmadeBodyIsRefused) {
  EXPECT_TRUE(is_refused(make_muscle_plan(Body{}, Muscle::quadriceps), "must be positive"));
  EXPECT_FALSE(make_muscle_plan(reference, static_cast<Muscle>(99)));
}

}  // namespace mobil::muscle_table_test
