#include <mobil/assets/surfaces/leg_grid.h>

#include <algorithm>
#include <cmath>

#include <mobil/assets/surfaces/body_form.h>

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;

using form::tau;
constexpr double step_s = (last_leg_s - first_leg_s) / (leg_stations - 1);

/// Returns the distance of the skin from the leg's line: the profile's on thigh and shank; above and below, the form's,
/// on the inner side at most to the body's middle.
double skin_radius(const form::BodyForm& form, double s, double turn) {
  const form::LegForm& leg = form.leg();
  constexpr double thigh_s = 0.20, longest_m = 0.20;
  if (s >= thigh_s && s <= LegProfile::last_s) return leg.radius(s, turn);
  const double inward = std::sin(turn), to_middle_m = -leg.hip().x / std::max(inward, 1e-3);
  return form.armless_radius({leg.hip().x, leg.y(s), leg.hip().z}, {inward, 0, std::cos(turn)},
                             std::min(longest_m, to_middle_m));
}

}  // namespace

LegGrid leg_grid(const form::BodyForm& form, const BodyComposition& composition) {
  const form::LegForm& leg = form.leg();
  const LegProfile& profile = leg.profile();
  LegGrid grid{};
  double area = 0;
  for (std::size_t i = 0; i < leg_stations; ++i) {
    const double s = first_leg_s + step_s * static_cast<double>(i);
    if (s >= LegProfile::first_s && s <= LegProfile::last_s)
      area += 2 * profile.girth(s) * (leg.y(s) - leg.y(s + step_s));
    for (std::size_t j = 0; j < leg_angles; ++j)
      grid.base[i * leg_angles + j] =
          static_cast<float>(skin_radius(form, s, tau * static_cast<double>(j) / leg_angles));
  }
  constexpr double share = 0.145, density = 900, min_m = 0.0015;
  const double mean = share * static_cast<double>(composition.fat_kg) / (density * area);
  for (std::size_t i = 0; i < leg_stations; ++i) {
    const double s = first_leg_s + step_s * static_cast<double>(i);
    const double along = 1.3 - 0.7 * smoothstep(0.85, 1.15, s);
    for (std::size_t j = 0; j < leg_angles; ++j) {
      const double front = std::cos(tau * static_cast<double>(j) / leg_angles - 0.5);
      const double bony = smoothstep(0.75, 1, s) * smoothstep(0.2, 0.9, front);
      grid.fat[i * leg_angles + j] = static_cast<float>(std::max(min_m, mean * along * (1 - 0.75 * bony)));
    }
  }
  return grid;
}

LegPlace leg_place(const form::LegForm& leg, const Vec& rest, double share) {
  const double s = leg.s(rest.y);
  const double amount = share * smoothstep(first_leg_s, first_leg_s + 0.07, s) * (1 - smoothstep(1.99, 2.045, s));
  if (amount <= 0) return {};
  double round = std::atan2(rest.x - leg.hip().x, rest.z - leg.hip().z) / tau;
  if (round < 0) round += 1;
  const double along = (s - first_leg_s) / step_s;
  return {static_cast<float>(std::clamp(along, 0.0, leg_stations - 1.001)), static_cast<float>(round * leg_angles),
          static_cast<float>(amount)};
}

}  // namespace mobil::inline v0_3
