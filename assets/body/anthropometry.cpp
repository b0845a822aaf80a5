#include <mobil/anthropometry.h>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <mobil/body_composition.h>
#include <mobil/engine/geometry.h>
#include "assets/body/body_scales.h"
#include "assets/body/growth.h"
#include "assets/body/segment_masses.h"

namespace mobil::inline v0_3 {

using namespace geometry;

namespace {

/// Returns an empty string if value is in [low, high]; NaN is not.
std::string out_of_range(const char* name, float value, const char* unit, float low, float high) {
  if (value >= low && value <= high) return {};
  return fmt::format("body: {} = {}{} is outside {}–{}{}; choose a value within that range", name, value, unit, low,
                     high, unit);
}

/// Returns an empty string if a person of that age can have that height.
std::string wrong_height(const BodyRequest& request) {
  const auto [low, high] = living_height_m(request.sex, request.age_y);
  const auto shortest = static_cast<float>(low), tallest = static_cast<float>(high);
  const float age = half_years(request.age_y);
  if (age >= static_cast<float>(adult_age_y)) return out_of_range("height", request.height_m, " m", shortest, tallest);
  if (request.height_m >= shortest && request.height_m <= tallest) return {};
  return fmt::format("body: nobody of {} years is {:.2f} m tall; choose {:.2f}–{:.2f} m or another age", age,
                     request.height_m, shortest, tallest);
}

/// Returns an empty string if a real body can have that height and mass.
std::string not_active(const BodyRequest& request) {
  const float age = half_years(request.age_y);
  const bool adult = age >= static_cast<float>(adult_age_y);
  if (std::string wrong = adult ? out_of_range("mass", request.mass_kg, " kg", 30.0F, 200.0F) : ""; !wrong.empty())
    return wrong;
  const auto [low, high] = living_mass_kg(static_cast<double>(request.height_m), age);
  const auto mass = static_cast<double>(request.mass_kg);
  // Limits are printed rounded inwards, so every value that a message names is accepted.
  if (mass >= low * (1 - 1e-6) && mass <= high * (1 + 1e-6)) return {};
  return fmt::format("body: nobody of {}{} m weighs {} kg and lives; choose a mass of {:.1f}–{:.1f} kg, or another {}",
                     adult ? "" : fmt::format("{} years and ", age), request.height_m, request.mass_kg,
                     std::ceil(10 * low) / 10, std::floor(10 * high) / 10, adult ? "height" : "height or age");
}

/// A long bone whose length can be set. Everything fixed at its far end moves with it, including the kneecap.
struct LongBone {
  const char* name;
  Segment segment;
  std::vector<Segment> at_its_end;
  double fraction;
  float BodySize<float>::*scale_m;
  float LimbLengths<float>::*length_m;

  double usual_m(const BodySize<float>& size) const { return fraction * static_cast<double>(size.*scale_m); }
};
const std::array<LongBone, 4>& long_bones() {
  using enum Segment;
  static const std::array<LongBone, 4> bones = {{
      {"thigh",
       thigh_right,
       {shank_right, patella_right},
       fraction::thigh,
       &BodySize<float>::leg_scale_m,
       &LimbLengths<float>::thigh_m},
      {"shank",
       shank_right,
       {foot_right},
       fraction::shank,
       &BodySize<float>::leg_scale_m,
       &LimbLengths<float>::shank_m},
      {"upper arm",
       upper_arm_right,
       {forearm_right},
       fraction::upper_arm,
       &BodySize<float>::arm_scale_m,
       &LimbLengths<float>::upper_arm_m},
      {"forearm",
       forearm_right,
       {hand_right},
       fraction::forearm,
       &BodySize<float>::arm_scale_m,
       &LimbLengths<float>::forearm_m},
  }};
  return bones;
}

std::string wrong_limb(const BodyRequest& request) {
  if (!has_own_limbs(request)) return {};
  const BodySize<float> size = make_size(request, 0.2F);
  constexpr double least = 0.6, most = 1.6;
  for (const LongBone& bone : long_bones()) {
    const auto asked = static_cast<double>(request.limbs.*bone.length_m);
    if (asked == 0) continue;
    const double usual = bone.usual_m(size);
    if (asked >= least * usual && asked <= most * usual) continue;
    return fmt::format("body: {} = {:.3f} m is outside {:.3f}–{:.3f} m at that height; choose one within, or 0",
                       bone.name, asked, least * usual, most * usual);
  }
  return {};
}

void lengthen(const LongBone& bone, Body& body) {
  const float asked = body.request.limbs.*bone.length_m;
  if (asked == 0) return;
  const auto usual = static_cast<float>(bone.usual_m(body.size));
  for (const std::size_t side : {std::size_t{Side::right}, std::size_t{Side::left}}) {
    const std::size_t own = index(on_side(bone.segment, side));
    body.centre_of_mass_m[own].y *= asked / usual;
    body.tip_m[own].y = -asked;
    for (const Segment s : bone.at_its_end) body.joint_offset_m[index(on_side(s, side))].y += usual - asked;
  }
}

}  // namespace

Result<void> check_body(const BodyRequest& request) {
  std::string wrong = out_of_range("age", request.age_y, " years", 6.0F, 95.0F);
  if (wrong.empty() && request.sex > Sex::woman) wrong = "body: sex is neither man nor woman; choose one of them";
  if (wrong.empty()) wrong = wrong_height(request);
  if (wrong.empty()) wrong = not_active(request);
  if (wrong.empty()) wrong = out_of_range("endomorphy", request.biotype.endo, "", 0.1F, 12.0F);
  if (wrong.empty()) wrong = out_of_range("mesomorphy", request.biotype.meso, "", 0.1F, 12.0F);
  if (wrong.empty()) wrong = out_of_range("ectomorphy", request.biotype.ecto, "", 0.1F, 12.0F);
  if (wrong.empty() && request.constitution > Constitution::heavy)
    wrong = "body: constitution is none of thin, average, athletic, heavy; choose one of them";
  if (wrong.empty()) wrong = wrong_limb(request);
  if (!wrong.empty()) return fail(wrong);
  return {};
}

Result<Body> make_body(const BodyRequest& request) {
  if (auto ok = check_body(request); !ok) return tl::unexpected(ok.error());
  Body body{};
  body.request = request;
  body.request.age_y = half_years(request.age_y);
  body.composition = body_composition(body.request);
  const auto fat_share = static_cast<float>(fat_share_of(body.composition));
  body.size = make_size(body.request, fat_share);
  // Masses are whole multiples of the body mass's last bit, so that they add up in any order without rounding.
  const double quantum = std::ldexp(1.0, std::ilogb(request.mass_kg) - 23);
  double rest = request.mass_kg;
  const auto scales = group_scales(body.size);
  for (std::size_t s = 0; s < segment_count; ++s) {
    body.joint_offset_m[s] = to_float(scaled(unit_body.joint_offset[s], scales, joint_groups[s]));
    body.centre_of_mass_m[s] = to_float(scaled(unit_body.centre_of_mass[s], scales, segment_groups[s]));
    body.tip_m[s] = to_float(scaled(unit_body.tip[s], scales, segment_groups[s]));
    if (s == index(Segment::pelvis)) continue;
    const double mass = quantum * std::round(mass_fraction(body.size, s) * request.mass_kg / quantum);
    body.mass_kg[s] = static_cast<float>(mass);
    rest -= mass;
  }
  body.mass_kg[index(Segment::pelvis)] = static_cast<float>(rest);
  const double leg = body.size.leg_scale_m;
  body.heel_m = to_float(leg * Vec3<double>{0, -fraction::ankle_height, -fraction::heel_back});
  body.ball_m = to_float(leg * Vec3<double>{0, -fraction::ankle_height, fraction::ball_forward});
  body.thigh_length_m = static_cast<float>(fraction::thigh * leg);
  body.shank_length_m = static_cast<float>(fraction::shank * leg);
  body.hip_height_m = static_cast<float>(fraction::hip_height * leg);
  if (!has_own_limbs(request)) return body;
  for (const LongBone& bone : long_bones()) lengthen(bone, body);
  if (request.limbs.thigh_m != 0) body.thigh_length_m = request.limbs.thigh_m;
  if (request.limbs.shank_m != 0) body.shank_length_m = request.limbs.shank_m;
  body.hip_height_m = static_cast<float>(fraction::ankle_height * leg) + body.thigh_length_m + body.shank_length_m;
  body.joint_offset_m[index(Segment::pelvis)].y = body.hip_height_m;
  return body;
}

LimbLengths<float> limb_lengths(const Body& body) {
  LimbLengths<float> limbs{};
  for (const LongBone& bone : long_bones()) limbs.*bone.length_m = -body.tip_m[index(bone.segment)].y;
  return limbs;
}

Pose<float> standing_pose(const Body& body) {
  Pose<float> pose;
  for (std::size_t s = 0; s < segment_count; ++s) {
    const std::size_t parent = index(segment_parent[s]);
    const Vec3<float>& offset = body.joint_offset_m[s];
    pose.rotation[s] = {0, 0, 0, 1};
    if (s == parent) {
      pose.position_m[s] = offset;
      continue;
    }
    const Vec3<float>& at = pose.position_m[parent];
    pose.position_m[s] = {at.x + offset.x, at.y + offset.y, at.z + offset.z};
  }
  return pose;
}

}  // namespace mobil::inline v0_3
