#pragma once
// Texture coordinates of what is long and round: bones, muscles, tendons.

#include <array>
#include <span>
#include <vector>

#include "components/surface.h"

namespace mobil {

/// Where a vertex lies on its surface, 0 to 1 each: from one end to the other, and round the middle line from the front
/// to the back, on either side alike. So there is no seam, and no vertex is there twice.
struct TexturePlace {
  float along, around;
};

/// Of places (m) that lie along `axis` more or less, the front being where `front` points; both of length 1. The middle
/// line is the cubic nearest to them.
std::vector<TexturePlace> texture_places(std::span<const Vec3<float>> position, const Vec3<float>& axis,
                                         const Vec3<float>& front);

/// The same along the longest side of the places' box, from the end nearer to their frame's origin; the front is ahead
/// (+z), of what lies along z above (+y).
std::vector<TexturePlace> texture_places(std::span<const Vec3<float>> position);

/// How the direction along a surface follows from where four of a vertex' neighbours are: Σ weight · (neighbour −
/// vertex), to be made perpendicular to the normal. Two triangles give it, the one ahead and the one behind. `handed`:
/// +1 where normal × along points to the back, −1 where it points to the front.
struct AlongStencil {
  std::array<std::uint32_t, 4> neighbour;
  std::array<float, 4> weight;
  float handed;
};
/// Of each vertex. Errors are none: `triangle` names vertices that are there. Weights are 0 where no triangle tells.
std::vector<AlongStencil> along_stencils(std::span<const std::uint32_t> triangle, std::span<const TexturePlace> place);

}  // namespace mobil
