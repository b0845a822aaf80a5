#include "assets/body/bent_legs.h"

#include <cmath>
#include <numbers>

#include <mobil/anthropometry.h>
#include <mobil/components/segments.h>
#include <mobil/engine/geometry.h>

namespace mobil::inline v0_3 {

Pose<float> with_bent_legs(const Body& body, const LegBend& bend) {
  using namespace geometry;
  using enum Segment;
  Pose<float> pose;
  const auto about_x = [](float degrees) {
    const float half = degrees * std::numbers::pi_v<float> / 360;
    return Quat<float>{std::sin(half), 0, 0, std::cos(half)};
  };
  for (std::size_t s = 0; s < segment_count; ++s) {
    const std::size_t parent = index(segment_parent[s]);
    const auto is = [s](Segment right) { return s == index(right) || s == index(on_side(right, Side::left)); };
    if (s == parent) {
      pose.rotation[s] = {0, 0, 0, 1};
      pose.position_m[s] = body.joint_offset_m[s];
      continue;
    }
    const float turn = is(thigh_right)   ? -bend.hip_flexion
                       : is(shank_right) ? bend.knee_flexion
                       : is(foot_right)  ? -bend.dorsiflexion
                                         : 0.0F;
    pose.rotation[s] = product(pose.rotation[parent], about_x(turn));
    pose.position_m[s] = pose.position_m[parent] + rotated(pose.rotation[parent], body.joint_offset_m[s]);
  }
  for (const Side side : {Side::right, Side::left}) {
    const std::size_t shank = index(on_side(shank_right, side)), cap = index(on_side(patella_right, side)),
                      thigh = index(on_side(thigh_right, side));
    pose.rotation[cap] = product(pose.rotation[thigh], about_x(kneecap_part * bend.knee_flexion));
    pose.position_m[cap] =
        pose.position_m[shank] + rotated(pose.rotation[cap], body.joint_offset_m[cap] - body.joint_offset_m[shank]);
  }
  return pose;
}

}  // namespace mobil::inline v0_3
