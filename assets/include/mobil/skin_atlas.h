#pragma once
// A skin unwrapped for textures: cut along seams into charts, which share one square.

#include <array>
#include <cstdint>
#include <vector>

#include <mobil/assets/surfaces/body_skin.h>

namespace mobil::inline v0_3 {

/// A texture coordinate, 0 to 1: to the right and down from the upper left corner.
struct AtlasPlace {
  float right, down;
};

/// Charts of the texture. Left and right sides have separate charts, so their textures can differ.
enum class SkinChart : std::uint8_t {
  trunk,
  head,
  arm_right,
  arm_left,
  palm_right,
  palm_left,
  hand_back_right,
  hand_back_left,
  leg_right,
  leg_left,
  foot_right,
  foot_left,
  sole_right,
  sole_left
};
inline constexpr std::size_t skin_charts = 14;

/// Bounds of a chart in the square, 0 to 1.
struct ChartBox {
  float left, top, right, bottom;
};
ChartBox chart_box(SkinChart chart);

/// Triangles of a SkinMesh over a texture. A vertex on a seam has several points; `vertex` is the vertex whose
/// position, normal and binding a point has.
struct SkinAtlas {
  std::vector<std::uint32_t> vertex;    // of each point
  std::vector<AtlasPlace> place;        // of each point
  std::vector<std::uint32_t> triangle;  // three points each, in the order of SkinMesh::triangle
  std::vector<SkinChart> chart;         // of each triangle
};

/// Returns the atlas of a skin. One texture fits all levels of detail of men and women, because coordinates follow from
/// the place on the body. Texel density is uniform, 1.4 times higher on the head, except in doubly curved regions.
/// Created at first use; safe from any thread.
const SkinAtlas& skin_atlas(Sex sex, SkinDetail detail);

/// Returns a tangent for normal maps per point of the atlas: the texture's right on a body's skin in the anatomical
/// position, of length 1, perpendicular to the normal; then 1 if normal × tangent is up in the texture, else −1.
std::vector<std::array<float, 4>> skin_tangents(const BodySkin& skin);

}  // namespace mobil::inline v0_3
