#pragma once
// What a picture shows. A scene only looks at the caller's memory; it must live until render() returns.

#include <cstdint>
#include <span>

#include <mobil/components/lanes.h>
#include <mobil/systems/render/camera.h>

namespace mobil::inline v0_3 {

/// sRGB, each channel 0–1, as a colour picker shows it.
struct Colour {
  float red, green, blue;
};

/// Colours of the built-in pictures.
inline constexpr Colour bone_ivory{0.91F, 0.86F, 0.74F};
inline constexpr Colour muscle_red{0.53F, 0.17F, 0.14F};
inline constexpr Colour joint_steel{0.30F, 0.38F, 0.48F};

/// A vertex p of the mesh stands in the world at position + rotation · (scale ∘ p). A negative scale mirrors.
struct Placement {
  Vec3<float> position{0, 0, 0};  // m
  Quat<float> rotation{0, 0, 0, 1};
  Vec3<float> scale{1, 1, 1};
};

/// A lit surface, smooth over its vertices; its back is not drawn, except as wireframe.
struct DrawMesh {
  std::span<const Vec3<float>> position{};    // m
  std::span<const std::uint32_t> triangle{};  // three indices each, counter-clockwise seen from outside
  std::span<const Vec3<float>> normal{};      // of each position; none: the mean of its triangles'
  Colour colour = muscle_red;
  float wetness = 0;                       // 0 dry as bone, 1 wet as living muscle
  float opacity = 1;                       // below 1 what lies behind is seen through it, its own back not
  bool wireframe = false;                  // the triangles' edges only, front and back
  bool flip = false;                       // the triangles are wound clockwise, as those of a mirrored mesh
  std::span<const Placement> placement{};  // one copy each; none: one copy where the positions say
  std::uint64_t key = 0;  // 0: sent every frame. Else the mesh is sent once and known by this key; its positions and
                          // triangles are not read again until Renderer::forget(key)
};

/// What a line's width is measured in.
enum class LineUnit { metre, pixel };

/// Line segments with round ends that face the camera, shaded as tubes.
struct DrawLines {
  std::span<const Vec3<float>> position{};  // two ends each, m
  Colour colour = joint_steel;
  float width = 2;
  LineUnit unit = LineUnit::pixel;
};

/// Balls.
struct DrawPoints {
  std::span<const Vec3<float>> position{};  // centres, m
  Colour colour = joint_steel;
  float radius_m = 0.02F;
};

struct Scene {
  Camera camera{};
  std::span<const DrawMesh> meshes{};
  std::span<const DrawLines> lines{};
  std::span<const DrawPoints> points{};
  Vec3<float> light{0.45F, 0.80F, 0.55F};  // direction towards the key light, of any length, above the ground
  bool ground = true;                      // the plane y = 0 with its grid; never drawn from below
  bool shadows = true;
};

}  // namespace mobil::inline v0_3
