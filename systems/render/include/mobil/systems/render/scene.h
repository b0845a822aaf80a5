#pragma once
// Content of a picture. A scene refers to the caller's memory, which must stay valid until render() returns.

#include <cstdint>
#include <span>

#include <mobil/components/lanes.h>
#include <mobil/components/surface.h>
#include <mobil/systems/render/camera.h>

namespace mobil::inline v0_3 {

/// An sRGB colour, each channel 0–1.
struct Colour {
  float red, green, blue;
};

/// Colours of the built-in pictures.
inline constexpr Colour bone_ivory{0.91F, 0.86F, 0.74F};
inline constexpr Colour muscle_red{0.53F, 0.17F, 0.14F};
inline constexpr Colour tendon_ivory{0.88F, 0.82F, 0.72F};
inline constexpr Colour joint_steel{0.30F, 0.38F, 0.48F};

/// Placement of a mesh. A vertex p is in the world at position + rotation · (scale ∘ p). A negative scale mirrors.
struct Placement {
  Vec3<float> position{0, 0, 0};  // m
  Quat<float> rotation{0, 0, 0, 1};
  Vec3<float> scale{1, 1, 1};
};

/// A lit surface with smooth shading. Back faces are drawn only for wireframes.
struct DrawMesh {
  std::span<const Vec3<float>> position{};    // m
  std::span<const std::uint32_t> triangle{};  // three indices each, counter-clockwise seen from outside
  std::span<const Vec3<float>> normal{};      // of each position; empty: the mean of its triangles' normals
  Colour colour = muscle_red;
  std::span<const Tissue> tissue{};        // of each position; empty: `colour` alone
  FibreScale fibres{};                     // of the tissue's pattern; length 0: none
  Colour tendon_colour = tendon_ivory;     // of the tissue's tendons and aponeuroses
  float wetness = 0;                       // 0 dry as bone, 1 wet as living muscle
  float opacity = 1;                       // below 1 other objects behind it are visible, but not its own back
  bool wireframe = false;                  // the triangles' edges only, front and back
  bool flip = false;                       // true: triangles are wound clockwise, as in a mirrored mesh
  std::span<const Placement> placement{};  // one copy for each; empty: one copy, not transformed
  std::uint64_t key = 0;  // 0: sent every frame. Other keys: the mesh is sent once, and its positions and triangles are
                          // not read again until Renderer::forget(key)
};

/// Unit of a line's width.
enum class LineUnit { metre, pixel };

/// Line segments with round ends, facing the camera and shaded as tubes.
struct DrawLines {
  std::span<const Vec3<float>> position{};  // two ends for each segment, m
  Colour colour = joint_steel;
  float width = 2;
  LineUnit unit = LineUnit::pixel;
};

/// Points, drawn as balls.
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
