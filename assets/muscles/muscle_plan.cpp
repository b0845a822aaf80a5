#include <mobil/assets/muscles/muscle_plan.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <mobil/anthropometry.h>
#include <mobil/engine/geometry.h>
#include "assets/body/growth.h"
#include "engine/exact_math.h"

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;

/// Returns the muscle frame: z along the unit vector, y the bone's anterior axis carried from the bone's −y to z by the
/// smallest rotation.
Quat<double> muscle_rotation(const Quat<double>& bone, const Vec& z) {
  const Vec down = rotated(bone, {0, -1, 0});
  const Vec axis = cross(down, z);
  const double w = 1 + dot(down, z), length = std::sqrt(dot(axis, axis) + w * w);
  const Quat<double> swing{axis.x / length, axis.y / length, axis.z / length, w / length};
  const double half = std::numbers::sqrt2 / 2;
  return product(swing, product(bone, {half, 0, 0, half}));
}

double along_scale(const DrawnLine& line, const LegScale<double>& scale) {
  return line.along == LegBone::shank ? scale.shank : scale.thigh;
}

double reference_volume_m3(Muscle row) {
  double cm3 = 0;
  for (const auto& muscle : members_of(row)) {
    cm3 += handsfield_volume_cm3(muscle, reference_body_height_m, reference_body_mass_kg);
  }
  return 1e-6 * cm3;
}

}  // namespace

double reference_belly_m(Muscle muscle) {
  constexpr double height = reference_body_height_m;
  const DrawnLine& line = muscle_row(muscle).drawn;
  return line.belly_m * along_scale(line, leg_scale(fraction::thigh * height, fraction::shank * height));
}

double member_volume_m3(const Body& body, const MemberMuscle& member) {
  const double regressed = handsfield_volume_cm3(member, static_cast<double>(body.request.height_m),
                                                 static_cast<double>(body.request.mass_kg));
  const double limb_part = static_cast<double>(body.composition.muscle_factor) * (regressed - member.offset_cm3);
  const double reference = handsfield_volume_cm3(member, reference_body_height_m, reference_body_mass_kg);
  const double usual_part = reference - member.offset_cm3;
  // The regression is one of adults. Children have the reference body's shares of the limb, and in small adults psoas
  // would have no volume.
  const double young = child_part(static_cast<double>(body.request.age_y));
  const double offset = member.offset_cm3 * (1 + young * (limb_part / usual_part - 1));
  constexpr double least_share = 0.5;  // of the reference body's share in the limb
  const double least = least_share * limb_part * reference / usual_part;
  return 1e-6 * std::max(limb_part + offset, least);
}

MemberPlan plan_member(const Body& body, const MemberMuscle& member, double rest_length_m) {
  MemberPlan plan{rest_length_m, member_volume_m3(body, member), 0, 0};
  if (member.model_path_m > 0) {
    const double longer = rest_length_m / member.model_path_m;
    plan.fibre_m = longer * member.model_fibre_m;
    plan.tendon_m = longer * member.model_tendon_m;
    return plan;
  }
  const double pennation = member.pennation_deg * std::numbers::pi / 180;
  plan.fibre_m = static_cast<double>(body.request.height_m) / cadaver_stature_m * member.fibre_m;
  plan.tendon_m = rest_length_m - plan.fibre_m * exact::cos(pennation);
  return plan;
}

double bar_stiffness(const Material& material, double section_m2, double rest_length_m) {
  return material.young_pa * section_m2 / rest_length_m;
}

Result<MusclePlan> make_muscle_plan(const Body& body, Muscle muscle) {
  const BodyRequest& request = body.request;
  if (!(body.thigh_length_m > 0 && body.shank_length_m > 0 && request.height_m > 0 && request.mass_kg > 0)) {
    return fail(fmt::format(
        "muscles: a body with thigh {} m, shank {} m, height {} m and mass {} kg; all must be positive, use make_body",
        body.thigh_length_m, body.shank_length_m, request.height_m, request.mass_kg));
  }
  if (static_cast<std::size_t>(muscle) >= muscles().size() || request.constitution > Constitution::heavy) {
    return fail("muscles: no such muscle or constitution; choose a row of the table and one of the named values");
  }
  const MuscleRow& row = muscle_row(muscle);
  const DrawnLine& line = row.drawn;
  const LegScale<double> scale = leg_scale(body);
  const LegFrames<double> leg = anatomical_leg(body);
  const Vec anchor = path_point(line.anchor, scale, leg);
  const MemberMuscle& towards = row.members[line.towards];
  const Vec end =
      path_point(line.point < towards.path.size() ? towards.path[line.point] : path_end(towards, 0), scale, leg);
  const Vec z = normalised(end - anchor);

  MusclePlan plan;
  plan.muscle = muscle;
  const std::vector<double> member_m = member_lengths(muscle, scale, leg);
  plan.rest_length_m = muscle_length(muscle, member_m);
  plan.belly_length_m = line.belly_m * along_scale(line, scale);
  const double start = line.start_m * along_scale(line, scale);
  plan.tendon_length_m = std::max(0.0, length(end - anchor) - start - plan.belly_length_m);
  for (std::size_t i = 0; i < row.members.size(); ++i) {
    plan.member[i] = plan_member(body, row.members[i], member_m[i]);
    plan.volume_m3 += plan.member[i].volume_m3;
  }
  plan.section_m2 = plan.volume_m3 / plan.belly_length_m;
  plan.start_m = anchor + start * z;
  plan.rotation = muscle_rotation({0, 0, 0, 1}, z);
  plan.origin = line.origin;
  plan.insertion = line.insertion;

  const double belly = reference_belly_m(muscle);
  const double section = reference_volume_m3(muscle) / belly;
  plan.scale = {static_cast<float>(std::sqrt(plan.section_m2 / section)),
                static_cast<float>(plan.belly_length_m / belly)};
  plan.leg_scale = {static_cast<float>(scale.thigh), static_cast<float>(scale.shank), static_cast<float>(scale.across)};
  return plan;
}

}  // namespace mobil::inline v0_3
