#pragma once
// Polygons cut into triangles by clipping of ears.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <mobil/components/lanes.h>

namespace mobil::inline v0_3 {

enum class PolygonCut : std::uint8_t {
  whole,    // the triangles cover the polygon: none lies outside it, and none is turned against it
  crossed,  // the polygon crosses itself, and no triangles do so
  endless,  // `work` is used up
};

/// Writes corners.size() − 2 triangles, three vertices each, that have the polygon's edges and winding. It can be
/// concave, touch itself, have collinear and equal corners, and lie in no plane: it is then cut as seen along its
/// normal. A fan about the first corner has precedence, and is the answer for a polygon that is not cut. `work` counts
/// down the corners that are compared.
PolygonCut cut_polygon(const std::vector<Vec3<float>>& position, std::span<const std::uint32_t> corner,
                       std::uint32_t* triangle, std::size_t& work);

}  // namespace mobil::inline v0_3
