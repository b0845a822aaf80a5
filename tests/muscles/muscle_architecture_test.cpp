// Architecture of the leg's muscles: published figures at the reference body, which grow with the body.
#include "assets/muscles/muscle_architecture.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>

#include <mobil/anthropometry.h>
#include <mobil/assets/muscles/muscle_path.h>
#include <mobil/assets/muscles/muscle_plan.h>
#include "tests/muscles/find_member.h"
#include "tests/simulation/people.h"

namespace mobil::muscle_architecture_test {
Body body_of(float height, float mass, float meso = 4, Constitution constitution = Constitution::average) {
  return make_body({height, mass, {3, meso, 3}, constitution}).value();
}

/// Published figures of each member: volume at 80 kg and 1.80 m (Handsfield 2014); volume of the Rajagopal 2016 model,
/// a man of 75 kg and 1.70 m; and the cadavers' mean (Ward 2009) belly, fibres and physiological section.
struct Published {
  std::string_view name;
  double volume_cm3, model_volume_cm3, belly_m, fibre_m, tendon_m, muscle_tendon_m;
};
constexpr Published published[] = {{"semimembranosus", 275.09, 253.11, 0.293, 0.069, 0.359, 0.41457},
                                   {"semitendinosus", 212.71, 190.19, 0.297, 0.193, 0.2555, 0.46323},
                                   {"biceps_femoris_long_head", 230.46, 213.61, 0.347, 0.098, 0.326, 0.4202},
                                   {"biceps_femoris_short_head", 115.05, 102.42, 0.224, 0.11, 0.089, 0.24625},
                                   {"rectus_femoris", 303.74, 277.26, 0.363, 0.076, 0.31, 0.41032},
                                   {"vastus_medialis", 491.84, 443.32, 0.439, 0.097, 0.126, 0.17226},
                                   {"vastus_intermedius", 296.35, 280.91, 0.412, 0.099, 0.136, 0.18205},
                                   {"vastus_lateralis", 950.93, 852.98, 0.273, 0.099, 0.157, 0.20018},
                                   {"gastrocnemius_medial", 289.66, 264.82, 0.269, 0.051, 0.39, 0.45071},
                                   {"gastrocnemius_lateral", 168.46, 154.36, 0.224, 0.059, 0.38, 0.44706},
                                   {"soleus", 486.49, 454.29, 0.405, 0.044, 0.25, 0.2914},
                                   {"tibialis_anterior", 149.95, 139.73, 0.26, 0.068, 0.223, 0.30379}};

TEST(MuscleArchitecture, ReferenceBodyHasThePublishedMuscles) {
  const Body body = body_of(1.80F, 80);
  const Body model = body_of(1.70F, 75);
  for (const Published& p : published) {
    SCOPED_TRACE(p.name);
    const MemberMuscle* member = find_member_muscle(p.name);
    ASSERT_NE(member, nullptr);
    const MuscleParameters made = member_parameters(body, *member);
    EXPECT_NEAR(1e6 * made.volume_m3 / p.volume_cm3, 1, 0.001);
    EXPECT_NEAR(1e6 * member_parameters(model, *member).volume_m3 / p.model_volume_cm3, 1, 0.15);
    EXPECT_NEAR(made.belly_m / p.belly_m, 1, 0.15);
    EXPECT_NEAR(made.fibre_m / p.fibre_m, 1, 0.15);
    EXPECT_NEAR(made.tendon_m / p.tendon_m, 1, 0.15);
    EXPECT_NEAR(made.muscle_tendon_m / p.muscle_tendon_m, 1, 0.15);
    EXPECT_NEAR(made.mass_kg, 1060 * made.volume_m3, 1e-9);
    // Fibres and tendon of the model span the path that it was published with. The fibres are there between half and
    // one and a half of their optimal length.
    const double span = made.muscle_tendon_m - made.tendon_m;
    EXPECT_GT(span, 0.5 * made.model_fibre_m);
    EXPECT_LT(span, 1.5 * made.model_fibre_m);
  }
}

TEST(MuscleArchitecture, FibresFitIntoTheirBellyAndTendonsOnTheirPath) {
  for (const MemberMuscle& member : member_muscles()) {
    const MuscleParameters made = member_parameters(body_of(1.80F, 80), member);
    EXPECT_LT(made.fibre_m, made.belly_m) << member.name;
    EXPECT_GT(made.tendon_m, 0) << member.name;
    EXPECT_LT(made.tendon_m, made.muscle_tendon_m) << member.name;
  }
  const double tendon = member_parameters(body_of(1.70F, 70), *find_member_muscle("plantaris")).tendon_m;
  EXPECT_GT(tendon, 0.30);  // the anatomists' measurement
  EXPECT_LT(tendon, 0.45);
}

RC_GTEST_PROP(MuscleArchitecture, VolumesRiseWithHeightMassAndMesomorphyLengthsWithHeight, ()) {
  const auto height = static_cast<float>(*rc::gen::inRange(1200, 2190)) / 1000;
  const float mass = living_mass(height + 0.01F, *rc::gen::inRange(0, 951) / 1000.0);
  const auto meso = static_cast<float>(*rc::gen::inRange(1, 115)) / 10;
  const auto build = static_cast<Constitution>(*rc::gen::inRange(0, 4));
  const Body body = body_of(height, mass, meso, build), taller = body_of(height + 0.01F, mass, meso, build),
             heavier = body_of(height, mass + 1, meso, build), stronger = body_of(height, mass, meso + 0.5F, build);
  for (std::size_t m = 0; m < muscles().size(); ++m) {
    const auto muscle = static_cast<Muscle>(m);
    const MuscleParameters made = muscle_parameters(body, muscle), tall = muscle_parameters(taller, muscle);
    RC_ASSERT(made.volume_m3 > 0);
    RC_ASSERT(tall.volume_m3 > made.volume_m3);
    RC_ASSERT(muscle_parameters(heavier, muscle).volume_m3 > made.volume_m3);
    RC_ASSERT(muscle_parameters(stronger, muscle).volume_m3 > made.volume_m3);
    RC_ASSERT(tall.belly_m > made.belly_m && tall.fibre_m > made.fibre_m);
    RC_ASSERT(tall.tendon_m > made.tendon_m && tall.muscle_tendon_m > made.muscle_tendon_m);
    RC_ASSERT(std::abs(make_muscle_plan(body, muscle)->volume_m3 / made.volume_m3 - 1) < 1e-9);
    RC_ASSERT(std::abs(make_muscle_plan(body, muscle)->rest_length_m / made.muscle_tendon_m - 1) < 1e-9);
  }
}

RC_GTEST_PROP(MuscleArchitecture, PlacesAreOnTheirPathAndInTheirBones, ()) {
  const auto height = static_cast<float>(*rc::gen::inRange(1200, 2200)) / 1000;
  const Body body = body_of(height, living_mass(height, 0.3));
  const LegFrames<double> leg = anatomical_leg(body);
  for (const MemberMuscle& member : member_muscles()) {
    const auto places = member_places(body, member);
    RC_ASSERT(places.size() >= 2U);
    double sum = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto& origin = places[i].bone == LegBone::foot    ? leg.ankle_m
                           : places[i].bone == LegBone::shank ? leg.knee_m
                                                              : leg.hip_m;
      RC_ASSERT(std::abs(places[i].in_bone_m.y + origin.y - places[i].world_m.y) < 1e-12);
      if (i == 0) continue;
      const auto &a = places[i - 1].world_m, &b = places[i].world_m;
      sum += std::hypot(b.x - a.x, b.y - a.y, b.z - a.z);
    }
    RC_ASSERT(std::abs(sum / member_length(member, leg_scale(body), leg) - 1) < 1e-9);
  }
}

TEST(MuscleArchitecture, GroupIsTheSumOfItsMembers) {
  const Body body = body_of(1.80F, 80);
  for (const Muscle group :
       {Muscle::hamstrings, Muscle::quadriceps, Muscle::triceps_surae, Muscle::tibialis_anterior}) {
    const MuscleParameters whole = muscle_parameters(body, group);
    double volume = 0, section = 0, shortest = 1, longest = 0;
    for (const MemberMuscle& member : members_of(group)) {
      const MuscleParameters part = member_parameters(body, member);
      volume += part.volume_m3;
      section += part.volume_m3 * std::cos(part.pennation_deg * std::numbers::pi / 180) / part.fibre_m;
      shortest = std::min(shortest, part.belly_m);
      longest = std::max(longest, part.belly_m);
    }
    EXPECT_NEAR(whole.volume_m3, volume, 1e-12);
    EXPECT_NEAR(whole.physiological_section_m2, section, 1e-12);
    EXPECT_GE(whole.belly_m, shortest - 1e-12);
    EXPECT_LE(whole.belly_m, longest + 1e-12);
  }
}

}  // namespace mobil::muscle_architecture_test
