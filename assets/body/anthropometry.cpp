#include "assets/body/anthropometry.h"

#include <fmt/format.h>

#include <cmath>

#include "assets/body/body_composition.h"
#include "assets/body/fat_distribution.h"

namespace mobil {
namespace {

/// Empty if value lies in [low, high]; NaN does not.
std::string out_of_range(const char* name, float value, const char* unit, float low, float high) {
  if (value >= low && value <= high) return {};
  return fmt::format("body: {} = {}{} is outside {}–{}{}; choose a value within that range", name, value, unit, low,
                     high, unit);
}

/// Empty if a living body can have that height and mass.
std::string not_living(const BodyRequest& request) {
  const auto [low, high] = living_mass_kg(static_cast<double>(request.height_m));
  const auto mass = static_cast<double>(request.mass_kg);
  // Limits are written rounded inwards: what a message names is taken.
  if (mass >= low * (1 - 1e-6) && mass <= high * (1 + 1e-6)) return {};
  return fmt::format(
      "body: nobody of {} m weighs {} kg and lives; choose a mass of {:.1f}–{:.1f} kg, or another height",
      request.height_m, request.mass_kg, std::ceil(10 * low) / 10, std::floor(10 * high) / 10);
}

Vec3<float> scaled(const Vec3<double>& v, double by) {
  return {static_cast<float>(v.x * by), static_cast<float>(v.y * by), static_cast<float>(v.z * by)};
}

}  // namespace

Result<void> check_body(const BodyRequest& request) {
  std::string wrong = out_of_range("height", request.height_m, " m", 1.2F, 2.2F);
  if (wrong.empty()) wrong = out_of_range("mass", request.mass_kg, " kg", 30.0F, 200.0F);
  if (wrong.empty()) wrong = out_of_range("endomorphy", request.biotype.endo, "", 0.1F, 12.0F);
  if (wrong.empty()) wrong = out_of_range("mesomorphy", request.biotype.meso, "", 0.1F, 12.0F);
  if (wrong.empty()) wrong = out_of_range("ectomorphy", request.biotype.ecto, "", 0.1F, 12.0F);
  if (wrong.empty() && request.constitution > Constitution::heavy)
    wrong = "body: constitution is none of thin, average, athletic, heavy; choose one of them";
  if (wrong.empty()) wrong = not_living(request);
  if (!wrong.empty()) return fail(wrong);
  return {};
}

Result<Body> make_body(const BodyRequest& request) {
  if (auto ok = check_body(request); !ok) return tl::unexpected(ok.error());
  Body body{};
  body.request = request;
  body.composition = body_composition(request);
  const double height = request.height_m;
  // Masses are whole multiples of the body mass's last bit, so that they add up in any order without rounding.
  const double quantum = std::ldexp(1.0, std::ilogb(request.mass_kg) - 23);
  double rest = request.mass_kg;
  const double extra = extra_fat_of(body.composition);
  for (std::size_t s = 0; s < segment_count; ++s) {
    body.joint_offset_m[s] = scaled(unit_body.joint_offset[s], height);
    body.centre_of_mass_m[s] = scaled(unit_body.centre_of_mass[s], height);
    body.tip_m[s] = scaled(unit_body.tip[s], height);
    if (s == index(Segment::pelvis)) continue;
    const double mass = quantum * std::round(mass_fraction(s, extra) * request.mass_kg / quantum);
    body.mass_kg[s] = static_cast<float>(mass);
    rest -= mass;
  }
  body.mass_kg[index(Segment::pelvis)] = static_cast<float>(rest);
  body.heel_m = scaled({0, -fraction::ankle_height, -fraction::heel_back}, height);
  body.ball_m = scaled({0, -fraction::ankle_height, fraction::ball_forward}, height);
  body.thigh_length_m = static_cast<float>(fraction::thigh * height);
  body.shank_length_m = static_cast<float>(fraction::shank * height);
  body.hip_height_m = static_cast<float>(fraction::hip_height * height);
  return body;
}

}  // namespace mobil
