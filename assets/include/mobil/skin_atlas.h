#pragma once
// A skin laid flat, for textures: cut along seams into charts, which lie beside each other in one square.

#include <array>
#include <cstdint>
#include <vector>

#include <mobil/assets/surfaces/body_skin.h>

namespace mobil::inline v0_3 {

/// A point of the texture, 0 to 1: to the right and down from its upper left corner.
struct AtlasPlace {
  float right, down;
};

/// The charts: of the left side and of the right each their own, so that one side may look otherwise.
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

/// Where a chart lies in the square, 0 to 1.
struct ChartBox {
  float left, top, right, bottom;
};
ChartBox chart_box(SkinChart chart);

/// The triangles of a SkinMesh over a texture. A vertex on a seam is there more than once: `vertex` is whose place,
/// normal and binding a point has.
struct SkinAtlas {
  std::vector<std::uint32_t> vertex;    // of each point
  std::vector<AtlasPlace> place;        // of each point
  std::vector<std::uint32_t> triangle;  // three points each, in the order of SkinMesh::triangle
  std::vector<SkinChart> chart;         // of each triangle
};

/// The same texture fits all details of men and women: a place follows from where on the body it is. One millimetre of
/// skin is as many pixels everywhere, on the head 1.4 times as many, but for what is bent twice. Made at its first use;
/// safe from any thread.
const SkinAtlas& skin_atlas(Sex sex, SkinDetail detail);

/// Of each point of its atlas, for maps of normals: which way on a body's skin, in the anatomical position, is right in
/// the texture, perpendicular to the normal and of length 1; and 1 where normal × that is up in the texture, else −1.
std::vector<std::array<float, 4>> skin_tangents(const BodySkin& skin);

}  // namespace mobil::inline v0_3
