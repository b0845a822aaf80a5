#pragma once
// Texture coordinates of long round surfaces: bones, muscles, tendons.

#include <array>
#include <span>
#include <vector>

#include <mobil/components/surface.h>

namespace mobil::inline v0_3 {

/// Texture coordinates of a vertex. `along` is 0 at one end of the surface and 1 at the other. `around` is 0 in front
/// and grows round the middle line to 1 at the back on one side, −1 on the other.
struct TexturePlace {
  float along, around;
};
/// Returns the coordinates mirrored to 0–1 on either side. Textures then have no seam and no duplicate vertices.
inline TexturePlace folded(const TexturePlace& place) {
  return {place.along, place.around < 0 ? -place.around : place.around};
}

/// Returns coordinates of points (m) along `axis`; `front` is the direction of the front. Both have length 1. The
/// middle line is the cubic nearest to the points.
std::vector<TexturePlace> texture_places(std::span<const Vec3<float>> position, const Vec3<float>& axis,
                                         const Vec3<float>& front);

/// Returns coordinates along the longest side of the points' box, from the end nearer to their frame's origin. The
/// front is forward (+z), for points along z up (+y).
std::vector<TexturePlace> texture_places(std::span<const Vec3<float>> position);

/// Returns these coordinates folded.
std::vector<TexturePlace> folded_places(std::span<const Vec3<float>> position);

/// Direction along a surface from four neighbours of a vertex: Σ weight · (neighbour − vertex), then made perpendicular
/// to the normal. Two triangles contribute, the one ahead and the one behind. `handed`, for folded places, is +1 where
/// normal × along points to the back and −1 where it points to the front.
struct AlongStencil {
  std::array<std::uint32_t, 4> neighbour;
  std::array<float, 4> weight;
  float handed;
};
/// Returns the stencil of each vertex from places that are not folded. The caller ensures that every index is valid.
/// Weights are 0 if no triangle gives a direction.
std::vector<AlongStencil> along_stencils(std::span<const std::uint32_t> triangle, std::span<const TexturePlace> place);

}  // namespace mobil::inline v0_3
