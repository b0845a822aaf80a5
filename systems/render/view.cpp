#include <mobil/view.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "systems/render/render_targets.h"

namespace mobil::inline v0_3 {
using namespace capture_math;
using namespace geometry;
namespace {

constexpr float widest_shadow_m = 2000;

Matrix4 perspective(const Camera& camera, int width, int height, float near, float far) {
  const float y = 1 / std::tan(0.5F * radians(camera.vertical_fov_deg));
  const float x = y * static_cast<float>(height) / static_cast<float>(width);
  return {x,
          0,
          0,
          0,
          0,
          y,
          0,
          0,
          x * camera.window_shift,
          0,
          (far + near) / (near - far),
          -1,
          0,
          0,
          2 * far * near / (near - far),
          0};
}

/// Clip space of the lamp, and its size in x and y, m.
struct LampView {
  Matrix4 clip_from_world;
  float size_m;
};

/// Computes the lamp's view, with steps of size and a centre on whole texels, so that moving shadows do not shimmer.
LampView lamp_view(Vec3<float> light, const Box& casters) {
  const Vec3<float> side =
      normalised(cross(std::abs(light.y) < 0.99F ? Vec3<float>{0, 1, 0} : Vec3<float>{0, 0, 1}, light));
  const Vec3<float> up = cross(light, side);
  Box box;
  for (unsigned i = 0; i < 8; ++i) {
    const Vec3<float> p = casters.corner(i);
    box.add({dot(p, side), dot(p, up), dot(p, light)});
  }
  const float extent = std::max({box.high.x - box.low.x, box.high.y - box.low.y, 0.2F});
  const float size = std::ceil(extent * 1.06F / 0.25F) * 0.25F;
  const float texel = size / shadow_map_size;
  const auto snapped = [&](float low, float high) { return std::floor(0.5F * (low + high) / texel) * texel; };
  const float x = snapped(box.low.x, box.high.x), y = snapped(box.low.y, box.high.y);
  const float low = box.low.z - 0.05F, high = box.high.z + 0.05F;
  const float s = 2 / size, d = 2 / (high - low);
  const Matrix4 clip = {s, 0, 0, 0, 0, s, 0, 0, 0, 0, -d, 0, -x * s, -y * s, 0.5F * d * (high + low), 1};
  return {clip * into_frame(side, up, light, {0, 0, 0}), size};
}

std::array<float, 4> with(Vec3<float> v, float w) {
  return {v.x, v.y, v.z, w};
}

bool finite(Vec3<float> v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

Result<FrameBlocks> frame_blocks(const Scene& scene, int width, int height, const Box& casters) {
  const Camera& camera = scene.camera;
  const float distance = length(camera.eye - camera.target);
  if (!(camera.vertical_fov_deg >= 1 && camera.vertical_fov_deg <= 170) || !std::isfinite(camera.window_shift)) {
    return fail(fmt::format("the camera's vertical field of view is {} degrees; it must lie within 1-170",
                            camera.vertical_fov_deg));
  }
  if (!finite(camera.eye) || !finite(camera.target) || !(distance > 1e-6F)) {
    return fail(
        fmt::format("the camera stands at ({}, {}, {}) m and looks at ({}, {}, {}) m; give two different points",
                    camera.eye.x, camera.eye.y, camera.eye.z, camera.target.x, camera.target.y, camera.target.z));
  }
  if (!finite(scene.light) || !(scene.light.y > 0)) {
    return fail(fmt::format("the light comes from ({}, {}, {}); its y must be above 0", scene.light.x, scene.light.y,
                            scene.light.z));
  }
  const CameraAxes axes = camera_axes(camera);
  const Vec3<float> light = normalised(scene.light);
  const float near = std::max(0.005F, 0.02F * distance), far = 40 * distance + 200;
  const float pixel = 2 * std::tan(0.5F * radians(camera.vertical_fov_deg)) / static_cast<float>(height);

  FrameBlocks blocks;
  FrameBlock& block = blocks.camera;
  block.clip_from_world =
      perspective(camera, width, height, near, far) * into_frame(axes.right, axes.up, axes.back, camera.eye);
  block.shadow_from_world = {};
  block.eye = with(camera.eye, 12 + 4 * distance);
  block.facing = with(camera.eye, 1);
  block.light = with(light, 0);
  block.fill = with(normalised(Vec3<float>{-light.x, 0.25F, -light.z} + 0.6F * axes.back), 1.0F / shadow_map_size);
  block.picture = {static_cast<float>(width), static_cast<float>(height), pixel, 0};
  blocks.lamp = block;

  const Vec3<float> span = casters.high - casters.low;
  blocks.shadows = scene.shadows && !casters.empty() && span.x + span.y + span.z < widest_shadow_m;
  if (blocks.shadows) {
    const LampView lamp = lamp_view(light, casters);
    blocks.lamp.clip_from_world = lamp.clip_from_world;
    blocks.lamp.facing = with(light, 0);
    constexpr Matrix4 to_unit = {0.5F, 0, 0, 0, 0, 0.5F, 0, 0, 0, 0, 0.5F, 0, 0.5F, 0.5F, 0.5F, 1};
    block.shadow_from_world = to_unit * lamp.clip_from_world;
    block.light[3] = lamp.size_m / shadow_map_size;
  }
  return blocks;
}

}  // namespace mobil::inline v0_3
