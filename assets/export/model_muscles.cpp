#include "assets/export/model_muscles.h"

#include <numbers>

#include <mobil/engine/geometry.h>
#include "assets/muscles/muscle_architecture.h"
#include "engine/exact_math.h"

namespace mobil::inline v0_3 {
namespace {

constexpr double specific_force_pa = 30e4;  // the simulation's (systems/muscles/member_design.cpp)

Quat<double> about_left(double degrees) {
  const double half = degrees * std::numbers::pi / 360;
  return {exact::sin(half), 0, 0, exact::cos(half)};
}

}  // namespace

Segment bone_segment(LegBone bone, std::size_t side) {
  using enum Segment;
  constexpr Segment right[] = {pelvis, thigh_right, shank_right, foot_right};
  return bone == LegBone::pelvis ? pelvis : on_side(right[static_cast<std::size_t>(bone)], side);
}

Vec3<double> member_place(const Body& body, const PathPoint& point, std::size_t side) {
  using namespace geometry;
  const LegFrames<double> leg = anatomical_leg(body);
  Vec3<double> at = path_point(point, leg_scale(body), leg) - bone_origin(point.bone, leg);
  if (point.bone == LegBone::pelvis) at = at + to_double(body.joint_offset_m[index(Segment::thigh_right)]);
  return side == Side::right ? at : mirrored(at);
}

HillMuscle hill_muscle(const Body& body, const MemberMuscle& member) {
  const MuscleParameters parameters = member_parameters(body, member);
  const double pennation = member.model_path_m > 0 ? member.model_pennation_deg : member.pennation_deg;
  return {specific_force_pa * parameters.volume_m3 / parameters.model_fibre_m, parameters.model_fibre_m,
          parameters.tendon_m, pennation * std::numbers::pi / 180};
}

LegFrames<double> bent_leg(const Body& body, double hip_deg, double knee_deg, double ankle_deg) {
  using namespace geometry;
  const LegFrames<double> standing = anatomical_leg(body);
  LegFrames<double> leg = standing;
  leg.thigh = about_left(-hip_deg);
  leg.shank = product(leg.thigh, about_left(knee_deg));
  leg.foot = product(leg.shank, about_left(-ankle_deg));
  leg.knee_m = leg.hip_m + rotated(leg.thigh, standing.knee_m - standing.hip_m);
  leg.ankle_m = leg.knee_m + rotated(leg.shank, standing.ankle_m - standing.knee_m);
  return leg;
}

}  // namespace mobil::inline v0_3
