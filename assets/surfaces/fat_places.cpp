#include <mobil/assets/surfaces/fat_places.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <mobil/engine/geometry.h>

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;

/// Returns 0 outside first and last, 1 between the two in the middle.
double within(double first, double full, double full_to, double last, double x) {
  return smoothstep(first, full, x) * (1 - smoothstep(full_to, last, x));
}

}  // namespace

FatPlace fat_place(const form::BodyForm& form, const Vec& rest, double arm) {
  const double size = form.size(), y = rest.y / size;
  const bool is_left = rest.x > 0;
  const auto on = [is_left](FatRegion right, FatRegion left) { return is_left ? left : right; };
  std::array<std::pair<double, FatRegion>, 5> parts{};
  if (arm > 0) {
    constexpr double upper_arm_m = 0.325;
    const double down = (form.arm().shoulder().y - rest.y) / (size * upper_arm_m);
    parts[0] = {arm * within(0.1, 0.45, 0.6, 0.95, down), on(FatRegion::upper_arm_right, FatRegion::upper_arm_left)};
  }
  const double rest_of = 1 - arm;
  const Vec hip = form.leg().hip();
  const double s = form.leg().s(rest.y), x = -std::abs(rest.x) - hip.x, z = rest.z - hip.z;
  const double front = z / std::max(std::hypot(x, z), 1e-3);
  parts[1] = {rest_of * within(0.12, 0.42, 0.62, 0.93, s), on(FatRegion::thigh_right, FatRegion::thigh_left)};
  parts[2] = {rest_of * within(1.06, 1.28, 1.42, 1.75, s) * (1 - 0.85 * smoothstep(0.1, 0.8, front)),
              on(FatRegion::shank_right, FatRegion::shank_left)};
  parts[3] = {rest_of * within(0.90, 1.00, 1.12, 1.25, y) * smoothstep(-0.02, 0.08, z / size), FatRegion::belly};
  parts[4] = {rest_of * within(0.76, 0.84, 0.93, 1.04, y) * smoothstep(0.02, 0.09, -z / size), FatRegion::seat};
  std::ranges::sort(parts, [](const auto& a, const auto& b) { return a.first > b.first; });
  FatPlace place;
  for (std::size_t i = 0; i < place.part.size() && parts[i].first > 0.01; ++i) {
    place.region[i] = static_cast<std::uint8_t>(parts[i].second);
    place.part[i] = static_cast<float>(parts[i].first);
  }
  return place;
}

}  // namespace mobil::inline v0_3
