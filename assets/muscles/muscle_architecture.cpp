#include "assets/muscles/muscle_architecture.h"

#include <cmath>
#include <numbers>

#include <mobil/assets/muscles/muscle_path.h>
#include <mobil/assets/muscles/muscle_plan.h>
#include <mobil/engine/geometry.h>
#include "engine/exact_math.h"

namespace mobil::inline v0_3 {
namespace {

double cosine_deg(double angle) {
  return exact::cos(angle * std::numbers::pi / 180);
}

}  // namespace

MuscleParameters member_parameters(const Body& body, const MemberMuscle& member) {
  MuscleParameters made;
  made.muscle_tendon_m = member_length(member, leg_scale(body), anatomical_leg(body));
  const MemberPlan plan = plan_member(body, member, made.muscle_tendon_m);
  made.volume_m3 = plan.volume_m3;
  made.mass_kg = muscle_density_kg_m3 * made.volume_m3;
  const double taller = static_cast<double>(body.request.height_m) / cadaver_stature_m;
  made.belly_m = taller * member.belly_m;
  made.fibre_m = taller * member.fibre_m;
  made.pennation_deg = member.pennation_deg;
  made.model_fibre_m = plan.fibre_m;
  made.tendon_m = plan.tendon_m;
  made.section_m2 = made.volume_m3 / made.belly_m;
  made.physiological_section_m2 = made.volume_m3 * cosine_deg(made.pennation_deg) / made.fibre_m;
  return made;
}

MuscleParameters muscle_parameters(const Body& body, Muscle muscle) {
  MuscleParameters sum;
  for (const MemberMuscle& member : members_of(muscle)) {
    const MuscleParameters one = member_parameters(body, member);
    sum.volume_m3 += one.volume_m3;
    sum.mass_kg += one.mass_kg;
    sum.section_m2 += one.section_m2;
    sum.physiological_section_m2 += one.physiological_section_m2;
    const double share = member_weight(members_of(muscle), member);
    for (auto part :
         {&MuscleParameters::muscle_tendon_m, &MuscleParameters::belly_m, &MuscleParameters::fibre_m,
          &MuscleParameters::pennation_deg, &MuscleParameters::model_fibre_m, &MuscleParameters::tendon_m}) {
      sum.*part += share * one.*part;
    }
  }
  return sum;
}

std::vector<PathPlace> member_places(const Body& body, const MemberMuscle& member) {
  using namespace geometry;
  const LegFrames<double> leg = anatomical_leg(body);
  std::vector<PathPlace> places;
  for (const PathCorner& corner : member_path(member, leg_scale(body), leg)) {
    places.push_back({corner.bone, corner.at - bone_origin(corner.bone, leg), corner.at});
  }
  return places;
}

}  // namespace mobil::inline v0_3
