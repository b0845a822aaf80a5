#pragma once
// Writes positions and normals to a caller's vertex buffer, in order and without reading it.

#include <cstddef>
#include <span>

#include <mobil/systems/surfaces/packed_surface.h>

namespace mobil::inline v0_3 {

/// Destination of vertices. Three floats of vertex v go to `position` + v · `position_stride`, in bytes. Normals and
/// tangents (four floats) have pointers and strides of their own; null skips them. Tangents need normals.
struct VertexTarget {
  std::byte* position = nullptr;
  std::byte* normal = nullptr;
  std::size_t position_stride = 0, normal_stride = 0;
  std::byte* tangent = nullptr;
  std::size_t tangent_stride = 0;
};

/// Writes positions from the places that place_vertices computed. A unit normal is the area-weighted mean of the
/// normals of a vertex' triangles times `sense` (−1 for mirrored surfaces), or +Y if no triangle has area. `along` has
/// one element for each vertex, or is empty without tangents. A tangent is the unit direction along the surface,
/// perpendicular to the normal, and ±1: the side of normal × tangent on which the back is. The bits are the same on
/// every instruction set.
void write_vertices(const VertexRings& rings, std::span<const PlacedAlong> along, const float* places, float sense,
                    const VertexTarget& out);

/// Writes a rigid surface, scaled along its axes and transformed by `map`.
void write_rigid(const RigidSurface& surface, const AffineMap& map, const VertexTarget& out,
                 const Vec3<float>& scale = {1, 1, 1});

}  // namespace mobil::inline v0_3
