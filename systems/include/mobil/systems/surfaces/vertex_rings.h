#pragma once
// The neighbours from which a vertex' normal is computed.
//
// The triangles around a vertex are bounded by a closed polygon. The area-weighted sum of their normals is that of any
// other triangles with the same boundary. So six neighbours a … f need two cross products instead of six: (c − a)×(d −
// b) + (e − a)×(f − d) is twice the area vector of the hexagon.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <mobil/components/surface.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Maximum number of places: twice an index must fit into 16 bits.
inline constexpr std::size_t max_places = 32768;

/// Twice the place of each of six neighbours, for computing addresses. Rings with fewer neighbours repeat some of them.
using VertexRing = std::array<std::uint16_t, 6>;

/// Twice a vertex' own place, and its ring. Stored in the order of vertices.
struct PlacedRing {
  std::uint16_t twice_place;
  VertexRing ring;
  std::uint16_t unused;
};

/// A further ring of a vertex with more than six neighbours, to be added to its normal.
struct MoreRing {
  std::uint32_t vertex;
  VertexRing ring;
};

/// Stencil of the direction along a surface (mobil/assets/surfaces/texture_places.h), with twice the places of four
/// neighbours.
struct PlacedAlong {
  std::array<std::uint16_t, 4> twice_place;
  std::array<float, 4> weight;
  float handed;
};

struct VertexRings {
  std::vector<PlacedRing> vertex;
  std::vector<MoreRing> more;  // ascending
};

/// Computes the rings of a triangle mesh of any topology. A vertex on a boundary is part of its own ring. `place` is
/// the place of each vertex, below max_places. Errors: an index out of range.
Result<VertexRings> vertex_rings(std::span<const std::uint32_t> triangle, std::span<const std::uint16_t> place);

}  // namespace mobil::inline v0_3
