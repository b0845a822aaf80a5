#include <mobil/systems/render/camera.h>

#include <cmath>

#include <mobil/systems/render/matrix.h>

namespace mobil::inline v0_3 {
using namespace capture_math;
using namespace geometry;

CameraAxes camera_axes(const Camera& camera) {
  Vec3<float> back = camera.eye - camera.target;
  back = length(back) > 0 ? normalised(back) : Vec3<float>{0, 0, 1};
  const Vec3<float> roughly_up = std::abs(back.y) < 0.9999F ? Vec3<float>{0, 1, 0} : Vec3<float>{0, 0, 1};
  const Vec3<float> right = normalised(cross(roughly_up, back));
  return {right, cross(back, right), back};
}

StereoPair stereo_pair(const Camera& camera, float separation_m) {
  const Vec3<float> half = 0.5F * separation_m * camera_axes(camera).right;
  const float distance = length(camera.eye - camera.target);
  const float shift = distance > 0 ? 0.5F * separation_m / distance : 0;
  StereoPair pair{camera, camera};
  pair.left.eye = camera.eye - half;
  pair.left.target = camera.target - half;
  pair.left.window_shift += shift;
  pair.right.eye = camera.eye + half;
  pair.right.target = camera.target + half;
  pair.right.window_shift -= shift;
  return pair;
}

Vec3<float> project(const Camera& camera, int width, int height, Vec3<float> point) {
  const CameraAxes axes = camera_axes(camera);
  const Vec3<float> d = point - camera.eye;
  const float depth = -dot(d, axes.back);
  const float pixels = 0.5F * static_cast<float>(height) / std::tan(0.5F * radians(camera.vertical_fov_deg));
  return {0.5F * static_cast<float>(width) + pixels * (dot(d, axes.right) / depth - camera.window_shift),
          0.5F * static_cast<float>(height) - pixels * dot(d, axes.up) / depth, depth};
}

}  // namespace mobil::inline v0_3
