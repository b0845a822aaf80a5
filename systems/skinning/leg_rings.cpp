#include "systems/skinning/leg_rings.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "assets/body/anthropometry.h"
#include "components/segments.h"
#include "engine/geometry.h"
#include "systems/skinning/skin_table.h"

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

/// `size`: over that of a body of 1.75 m.
JointRings bend_of(const Quat<float>& above, const Quat<float>& below, const Vec3<float>& centre_m,
                   const SkinBend& bend, float size) {
  JointRings rings;
  rings.centre_m = centre_m;
  rings.low_m = -size * static_cast<float>(bend.below_m);
  rings.high_m = size * static_cast<float>(bend.above_m);
  for (std::size_t k = 0; k <= bend_rings; ++k) {
    const auto axes = columns(blended(below, above, eased(static_cast<float>(k) / bend_rings)));
    for (std::size_t a = 0; a < 3; ++a) {
      rings.axis[a][0][k] = axes[a].x;
      rings.axis[a][1][k] = axes[a].y;
      rings.axis[a][2][k] = axes[a].z;
    }
  }
  return rings;
}

/// By how much the line bends at a height over a joint that is bent by `angle`.
float curved_at(float y, float angle, const JointRings& bend) {
  const float wide = bend.high_m - bend.low_m, t = (y - bend.low_m) / wide;
  return t <= 0 || t >= 1 ? 0 : angle * 6 * t * (1 - t) / wide;
}

}  // namespace

LegRings leg_rings(const BodySkin& skin, const Pose<float>& pose, float lengths, Side side) {
  const std::size_t pelvis = index(Segment::pelvis), thigh = index(on_side(Segment::thigh_right, side)),
                    shank = index(on_side(Segment::shank_right, side)),
                    foot = index(on_side(Segment::foot_right, side));
  const auto& standing = skin.standing.position_m;
  const auto& turned = pose.rotation;
  const float size = lengths * standing[pelvis].y / static_cast<float>(1.75 * fraction::hip_height);
  LegRings rings;
  rings.thigh_m = lengths * (standing[thigh].y - standing[shank].y);
  rings.shank_m = lengths * (standing[shank].y - standing[foot].y);
  rings.hip = bend_of(turned[pelvis], turned[thigh], pose.position_m[thigh], hip_bend, size);
  rings.knee = bend_of(turned[thigh], turned[shank], pose.position_m[shank], knee_bend, size);
  rings.ankle = bend_of(turned[shank], turned[foot], pose.position_m[foot], ankle_bend, size);
  rings.out = side == Side::right ? 1.0F : -1.0F;
  const LegAngles angles = leg_angles_of(pose, side);
  constexpr auto first = static_cast<float>(first_leg_s), last = static_cast<float>(last_leg_s);
  for (std::size_t i = 0; i < leg_stations; ++i) {
    const float s = first + (last - first) * static_cast<float>(i) / (leg_stations - 1);
    const float over_knee = s < 1 ? (1 - s) * rings.thigh_m : (1 - s) * rings.shank_m;
    rings.curved[i] = curved_at(over_knee, std::max(0.0F, angles.knee), rings.knee) +
                      curved_at(-s * rings.thigh_m, -angles.hip, rings.hip);
  }
  static const std::array<float, leg_angles> inner = inner_side();
  rings.inner = inner;
  return rings;
}

}  // namespace mobil
