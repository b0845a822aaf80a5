#pragma once
// Distance of people from being seen.

#include <algorithm>
#include <cmath>

#include <mobil/components/lanes.h>
#include <mobil/lod.h>

namespace mobil::inline v0_3 {

/// Radius of the ball around the pelvis that represents a person, m.
inline constexpr float person_radius_m = 1;
/// Height of a pelvis without a pose, m.
inline constexpr float pelvis_m = 0.95F;

/// Distance of people from being seen.
class Gap {
 public:
  /// `cosine` and `sine` are of the camera's half-angle; they cost more than all the rest.
  Gap(const Viewpoint& camera, float cosine, float sine) : camera_(camera), cos_(cosine), sin_(sine) {
    const Vec3<float>& f = camera.forward;
    const float length = std::sqrt(f.x * f.x + f.y * f.y + f.z * f.z);
    forward_ = {f.x / length, f.y / length, f.z / length};
  }

  /// Returns a lower bound of the distance, m, by which person and camera must approach for the person to be seen or
  /// near. It is at most 0 for a person who is. The cone and the ball of radius reach_m each give a bound.
  float operator()(const Vec3<float>& at) const {
    const Vec3<float> v = from_camera(at);
    const float distance = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    const float along = v.x * forward_.x + v.y * forward_.y + v.z * forward_.z;
    const float aside = std::sqrt(std::max(distance * distance - along * along, 0.0F));
    const float unseen = std::max(aside * cos_ - along * sin_ - person_radius_m, distance - camera_.reach_m);
    return std::min(unseen, distance - camera_.near_m);
  }
  /// Returns the squared distance from the camera, m². Beyond `farthest(gap_m)` the gap exceeds gap_m.
  float squared(const Vec3<float>& at) const {
    const Vec3<float> v = from_camera(at);
    return v.x * v.x + v.y * v.y + v.z * v.z;
  }
  float farthest(float gap_m) const { return std::max(camera_.reach_m, camera_.near_m) + gap_m; }

 private:
  Vec3<float> from_camera(const Vec3<float>& at) const {
    return {at.x - camera_.position_m.x, at.y - camera_.position_m.y, at.z - camera_.position_m.z};
  }

  Viewpoint camera_;
  float cos_, sin_;
  Vec3<float> forward_;
};

}  // namespace mobil::inline v0_3
