#pragma once
// Positions and normals into a caller's vertex buffer, which is written in order and never read.

#include <cstddef>

#include "systems/skinning/packed_surface.h"

namespace mobil {

/// Where three floats of vertex v go: at `position` + v · `position_stride`, in bytes, and likewise of its normal;
/// null: none wanted.
struct VertexTarget {
  std::byte* position = nullptr;
  std::byte* normal = nullptr;
  std::size_t position_stride = 0, normal_stride = 0;
};

/// Positions from their places as place_vertices leaves them; unit normals, the mean of a vertex' triangles' normals
/// weighted by their areas, times `sense` (−1 turns them over, as of reflected surfaces); up (+Y) where there is no
/// triangle with area. The same bits on every instruction set.
void write_vertices(const VertexRings& rings, const float* places, float sense, const VertexTarget& out);

/// A rigid surface, made `scale` times as large, carried by `map`.
void write_rigid(const RigidSurface& surface, const AffineMap& map, const VertexTarget& out, float scale = 1);

}  // namespace mobil
