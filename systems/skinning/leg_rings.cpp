#include "systems/skinning/leg_rings.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "assets/body/anthropometry.h"
#include "components/segments.h"
#include "engine/geometry.h"

namespace mobil {
namespace {

using namespace geometry;

float eased(float t) {
  t = std::clamp(t, 0.0F, 1.0F);
  return t * t * (3 - 2 * t);
}

std::array<float, leg_angles> inner_side() {
  std::array<float, leg_angles> inner;
  for (std::size_t j = 0; j < leg_angles; ++j)
    inner[j] = -std::cos(2 * std::numbers::pi_v<float> * static_cast<float>(j) / leg_angles);
  return inner;
}

}  // namespace

LegRings leg_rings(const BodySkin& skin, const Pose<float>& pose, float lengths, Side side) {
  const std::size_t thigh = index(on_side(Segment::thigh_right, side)),
                    shank = index(on_side(Segment::shank_right, side)),
                    foot = index(on_side(Segment::foot_right, side));
  const auto& standing = skin.standing.position_m;
  LegRings rings;
  rings.knee_m = pose.position_m[shank];
  rings.thigh_m = lengths * (standing[thigh].y - standing[shank].y);
  rings.shank_m = lengths * (standing[shank].y - standing[foot].y);
  const float height_m = standing[index(Segment::pelvis)].y / static_cast<float>(fraction::hip_height);
  rings.bend_m = static_cast<float>(knee_bend_m / 1.75) * lengths * height_m;
  rings.out = side == Side::right ? 1.0F : -1.0F;
  for (std::size_t k = 0; k <= bend_rings; ++k) {
    const float part = eased(static_cast<float>(k) / bend_rings);
    const auto axes = columns(blended(pose.rotation[shank], pose.rotation[thigh], part));
    for (std::size_t a = 0; a < 3; ++a) {
      rings.axis[a][0][k] = axes[a].x;
      rings.axis[a][1][k] = axes[a].y;
      rings.axis[a][2][k] = axes[a].z;
    }
  }
  const Quat<float> knee = product(conjugate(pose.rotation[thigh]), pose.rotation[shank]);
  const float angle = std::max(0.0F, 2 * std::atan2(knee.w < 0 ? -knee.x : knee.x, std::abs(knee.w)));
  constexpr auto first = static_cast<float>(LegProfile::first_s), last = static_cast<float>(LegProfile::last_s);
  for (std::size_t i = 0; i < leg_stations; ++i) {
    const float s = first + (last - first) * static_cast<float>(i) / (leg_stations - 1);
    const float y = s < 1 ? (1 - s) * rings.thigh_m : (1 - s) * rings.shank_m, t = 0.5F * (y / rings.bend_m + 1);
    rings.curved[i] = t <= 0 || t >= 1 ? 0 : angle * 6 * t * (1 - t) / (2 * rings.bend_m);
  }
  static const std::array<float, leg_angles> inner = inner_side();
  rings.inner = inner;
  return rings;
}

}  // namespace mobil
