#pragma once
// Positions and normals into a caller's vertex buffer, which is written in order and never read.

#include <cstddef>
#include <span>

#include <mobil/systems/surfaces/packed_surface.h>

namespace mobil::inline v0_3 {

/// Where three floats of vertex v go: at `position` + v · `position_stride`, in bytes, and likewise of its normal, and
/// four of its tangent; null: none wanted. Tangents need normals.
struct VertexTarget {
  std::byte* position = nullptr;
  std::byte* normal = nullptr;
  std::size_t position_stride = 0, normal_stride = 0;
  std::byte* tangent = nullptr;
  std::size_t tangent_stride = 0;
};

/// Positions from their places as place_vertices leaves them; unit normals, the mean of a vertex' triangles' normals
/// weighted by their areas, times `sense` (−1 turns them over, as of reflected surfaces); up (+Y) where there is no
/// triangle with area. The same bits on every instruction set. `along`: of each vertex; empty where no tangents are
/// wanted. A tangent is the unit direction along the surface at right angles to the normal, and ±1: on which side of
/// normal × tangent the back is.
void write_vertices(const VertexRings& rings, std::span<const PlacedAlong> along, const float* places, float sense,
                    const VertexTarget& out);

/// A rigid surface, made `scale` times as large and along y `stretch` times more, carried by `map`.
void write_rigid(const RigidSurface& surface, const AffineMap& map, const VertexTarget& out, float scale = 1,
                 float stretch = 1);

}  // namespace mobil::inline v0_3
