#pragma once
// Texture coordinates of what is long and round: bones, muscles, tendons.

#include <array>
#include <span>
#include <vector>

#include <mobil/components/surface.h>

namespace mobil::inline v0_3 {

/// Where a vertex lies on its surface: from one end (0) to the other (1), and round the middle line from the front (0)
/// to the back, 1 on the one side and −1 on the other.
struct TexturePlace {
  float along, around;
};
/// The same on either side, 0 to 1: so textures have no seam, and no vertex is there twice.
inline TexturePlace folded(const TexturePlace& place) {
  return {place.along, place.around < 0 ? -place.around : place.around};
}

/// Of places (m) that lie along `axis` more or less, the front being where `front` points; both of length 1. The middle
/// line is the cubic nearest to them.
std::vector<TexturePlace> texture_places(std::span<const Vec3<float>> position, const Vec3<float>& axis,
                                         const Vec3<float>& front);

/// The same along the longest side of the places' box, from the end nearer to their frame's origin; the front is ahead
/// (+z), of what lies along z above (+y).
std::vector<TexturePlace> texture_places(std::span<const Vec3<float>> position);

/// The same, folded.
std::vector<TexturePlace> folded_places(std::span<const Vec3<float>> position);

/// How the direction along a surface follows from where four of a vertex' neighbours are: Σ weight · (neighbour −
/// vertex), to be made perpendicular to the normal. Two triangles give it, the one ahead and the one behind. `handed`:
/// +1 where normal × along points to the back, −1 where it points to the front; of folded places.
struct AlongStencil {
  std::array<std::uint32_t, 4> neighbour;
  std::array<float, 4> weight;
  float handed;
};
/// Of each vertex, from places that are not folded. The caller makes sure that every index is valid. Weights are 0
/// where no triangle tells.
std::vector<AlongStencil> along_stencils(std::span<const std::uint32_t> triangle, std::span<const TexturePlace> place);

}  // namespace mobil::inline v0_3
