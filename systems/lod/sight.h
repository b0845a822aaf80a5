#pragma once
// How far somebody is from being seen.

#include <algorithm>
#include <cmath>

#include <mobil/components/lanes.h>
#include <mobil/lod.h>

namespace mobil::inline v0_3 {

/// People count as balls of this radius round the pelvis, m.
inline constexpr float person_radius_m = 1;
/// Height of a pelvis where no pose says better, m.
inline constexpr float pelvis_m = 0.95F;

/// How far people are from being seen.
class Gap {
 public:
  /// `cosine`, `sine`: of the camera's half angle, which take longer than all the rest.
  Gap(const Viewpoint& camera, float cosine, float sine) : camera_(camera), cos_(cosine), sin_(sine) {
    const Vec3<float>& f = camera.forward;
    const float length = std::sqrt(f.x * f.x + f.y * f.y + f.z * f.z);
    forward_ = {f.x / length, f.y / length, f.z / length};
  }

  /// How far, at least, a person and the camera must come together for the person to be seen, or near: 0 and less for
  /// who is. Of the cone and the ball of what is in reach each is a bound.
  float operator()(const Vec3<float>& at) const {
    const Vec3<float> v = from_camera(at);
    const float distance = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    const float along = v.x * forward_.x + v.y * forward_.y + v.z * forward_.z;
    const float aside = std::sqrt(std::max(distance * distance - along * along, 0.0F));
    const float unseen = std::max(aside * cos_ - along * sin_ - person_radius_m, distance - camera_.reach_m);
    return std::min(unseen, distance - camera_.near_m);
  }
  /// The square of a distance; of who is further than reach_m + gap and near_m + gap the gap is larger.
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
