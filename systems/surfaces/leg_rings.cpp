#include "systems/surfaces/leg_rings.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <mobil/anthropometry.h>
#include <mobil/components/segments.h>
#include <mobil/engine/geometry.h>
#include <mobil/systems/surfaces/skin_table.h>

namespace mobil::inline v0_3 {
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

/// Returns how far each ring has turned from the segment below to the one above, 0 to 1.
std::array<float, bend_rings> turned_by() {
  std::array<float, bend_rings> share;
  for (std::size_t k = 0; k < bend_rings; ++k) share[k] = eased(static_cast<float>(k + 1) / bend_rings);
  return share;
}

/// Returns a joint's rings. `size` is relative to a body of 1.75 m. Quaternions are blended the short way round.
JointRings bend_of(Quat<float> above, Quat<float> below, const Vec3<float>& centre_m, const SkinBend& bend,
                   float size) {
  static const std::array<float, bend_rings> all_shares = turned_by();
  const float* const share = all_shares.data();
  JointRings rings;
  rings.centre_m = centre_m;
  rings.low_m = -size * static_cast<float>(bend.below_m);
  rings.high_m = size * static_cast<float>(bend.above_m);
  rings.below = columns(below);
  const float sign = below.x * above.x + below.y * above.y + below.z * above.z + below.w * above.w < 0 ? -1.0F : 1.0F;
  for (std::size_t k = 0; k < bend_rings; ++k)
    rings.height_m[k] = rings.low_m + (rings.high_m - rings.low_m) * (static_cast<float>(k + 1) / bend_rings);
  auto& [left, up, front] = rings.axis;
  for (std::size_t k = 0; k < bend_rings; ++k) {
    const float p = 1 - share[k], q = sign * share[k];
    const float x = p * below.x + q * above.x, y = p * below.y + q * above.y, z = p * below.z + q * above.z,
                w = p * below.w + q * above.w;
    const float twice = 2 / (x * x + y * y + z * z + w * w);  // the quaternion can have another length than 1
    left[0][k] = 1 - twice * (y * y + z * z);
    left[1][k] = twice * (x * y + w * z);
    left[2][k] = twice * (x * z - w * y);
    up[0][k] = twice * (x * y - w * z);
    up[1][k] = 1 - twice * (x * x + z * z);
    up[2][k] = twice * (y * z + w * x);
    front[0][k] = twice * (x * z + w * y);
    front[1][k] = twice * (y * z - w * x);
    front[2][k] = 1 - twice * (x * x + y * y);
  }
  return rings;
}

/// Returns the bend of the line at a height over a joint that is bent by `angle`, rad/m.
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

}  // namespace mobil::inline v0_3
