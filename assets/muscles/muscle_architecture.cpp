#include "assets/muscles/muscle_architecture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "assets/muscles/muscle_path.h"
#include "assets/muscles/muscle_plan.h"
#include "engine/geometry.h"

namespace mobil {
namespace {

// Name; fibre, pennation, belly; the model's fibre, tendon and path.
constexpr std::array<MuscleArchitecture, member_muscle_count> published = {{
    {"semimembranosus", 0.069, 15.1, 0.293, 0.080, 0.359, 0.41457},
    {"semitendinosus", 0.193, 12.9, 0.297, 0.201, 0.2555, 0.46323},
    {"biceps_femoris_long_head", 0.098, 11.6, 0.347, 0.109, 0.326, 0.42020},
    {"biceps_femoris_short_head", 0.110, 12.3, 0.224, 0.173, 0.089, 0.24625},
    {"rectus_femoris", 0.076, 13.9, 0.363, 0.114, 0.310, 0.41032},
    {"vastus_medialis", 0.097, 29.6, 0.439, 0.089, 0.126, 0.17226},
    {"vastus_intermedius", 0.099, 4.5, 0.412, 0.087, 0.136, 0.18205},
    {"vastus_lateralis", 0.099, 18.4, 0.273, 0.084, 0.157, 0.20018},
    {"gastrocnemius_medial", 0.051, 9.9, 0.269, 0.060, 0.390, 0.45071},
    {"gastrocnemius_lateral", 0.059, 12.0, 0.224, 0.064, 0.380, 0.44706},
    {"soleus", 0.044, 28.3, 0.405, 0.050, 0.250, 0.29140},
    {"plantaris", 0.039, 5.0, 0.085, 0, 0, 0},
    {"tibialis_anterior", 0.068, 9.6, 0.260, 0.098, 0.223, 0.30379},
}};

double cosine_deg(double angle) {
  return std::cos(angle * std::numbers::pi / 180);
}

Vec3<double> bone_origin(LegBone bone, const LegFrames<double>& leg) {
  return bone == LegBone::shank ? leg.knee_m : bone == LegBone::foot ? leg.ankle_m : leg.hip_m;
}

}  // namespace

const MuscleArchitecture& muscle_architecture(const MemberMuscle& member) {
  return *std::ranges::find(published, member.name, &MuscleArchitecture::name);
}

MuscleParameters member_parameters(const Body& body, const MemberMuscle& member) {
  const MuscleArchitecture& row = muscle_architecture(member);
  MuscleParameters made;
  made.volume_m3 = member_volume_m3(body, member);
  made.mass_kg = muscle_density_kg_m3 * made.volume_m3;
  made.muscle_tendon_m = member_length(member, leg_scale(body), anatomical_leg(body));
  const double taller = static_cast<double>(body.request.height_m) / cadaver_stature_m;
  made.belly_m = taller * row.belly_m;
  made.fibre_m = taller * row.fibre_m;
  made.pennation_deg = row.pennation_deg;
  const bool modelled = row.model_path_m > 0;
  const double longer = modelled ? made.muscle_tendon_m / row.model_path_m : 1;
  made.model_fibre_m = modelled ? longer * row.model_fibre_m : made.fibre_m;
  made.tendon_m =
      modelled ? longer * row.model_tendon_m : made.muscle_tendon_m - made.fibre_m * cosine_deg(made.pennation_deg);
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

}  // namespace mobil
