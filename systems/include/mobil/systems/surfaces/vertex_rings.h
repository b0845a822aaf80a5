#pragma once
// Which neighbours a vertex' normal is made of.
//
// The triangles round a vertex are bounded by a closed polygon, and the sum of their normals weighted by their areas is
// that of any other triangles with the same boundary. So six neighbours a … f take two products instead of six:
// (c − a)×(d − b) + (e − a)×(f − d) is twice the area of the hexagon as a vector.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <mobil/components/surface.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Places are numbered by 16 bits, doubled.
inline constexpr std::size_t max_places = 32768;

/// Twice the place of each of six vertices (what addresses are made of); fewer neighbours repeat some of them.
using VertexRing = std::array<std::uint16_t, 6>;

/// Of every vertex, in their order, twice its own place, and its ring.
struct PlacedRing {
  std::uint16_t twice_place;
  VertexRing ring;
  std::uint16_t unused;
};

/// What is to be added to a vertex' normal where six neighbours are not all.
struct MoreRing {
  std::uint32_t vertex;
  VertexRing ring;
};

/// How the direction along a surface follows from four neighbours (mobil/assets/surfaces/texture_places.h), by twice
/// their places.
struct PlacedAlong {
  std::array<std::uint16_t, 4> twice_place;
  std::array<float, 4> weight;
  float handed;
};

struct VertexRings {
  std::vector<PlacedRing> vertex;
  std::vector<MoreRing> more;  // ascending
};

/// Rings of a mesh of triangles, whatever its topology (a vertex on a boundary counts itself). `place`: where each
/// vertex is looked up, below max_places. Errors: an index out of range.
Result<VertexRings> vertex_rings(std::span<const std::uint32_t> triangle, std::span<const std::uint16_t> place);

}  // namespace mobil::inline v0_3
