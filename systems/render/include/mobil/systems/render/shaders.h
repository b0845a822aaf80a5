#pragma once
// Shaders of the renderer, in GLSL ES 3.00.

#include <array>
#include <cstddef>
#include <string>

#include <mobil/systems/render/matrix.h>

namespace mobil::inline v0_3 {

/// Uniform block "Frame" of all programs, std140.
struct FrameBlock {
  capture_math::Matrix4 clip_from_world;
  capture_math::Matrix4 shadow_from_world;  // to texture coordinates and depth, all 0–1
  std::array<float, 4> eye;                 // of the camera; w: distance at which the ground has faded, m
  std::array<float, 4> facing;              // point (w = 1) or direction (w = 0) that billboards face
  std::array<float, 4> light;               // direction to the key light; w: a shadow texel's size, m, or 0
  std::array<float, 4> fill;                // direction to the fill light; w: a shadow texel's size in the texture
  std::array<float, 4> picture;             // width and height in pixels; a pixel's size at 1 m, m; unused
};

/// Vertex attributes by location.
enum Attribute : unsigned {
  at_position = 0,
  at_normal = 1,
  at_placement = 2,
  at_line_from = 6,
  at_line_to = 7,
  at_centre = 8,
  at_tissue = 9
};

inline constexpr int line_vertices = 12;   // of the strip of one segment
inline constexpr int point_vertices = 20;  // of the fan of one ball

/// Return the sources, in GLSL ES 3.00.
std::string mesh_vertex_source();
std::string mesh_fragment_source();
std::string wireframe_fragment_source();
std::string line_vertex_source();
std::string line_fragment_source();
std::string point_vertex_source();
std::string point_fragment_source();
std::string depth_fragment_source();
std::string ground_vertex_source();
std::string ground_fragment_source();
std::string background_vertex_source();
std::string background_fragment_source();

}  // namespace mobil::inline v0_3
