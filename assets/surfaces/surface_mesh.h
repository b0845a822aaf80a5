#pragma once
// Operations on surfaces of triangles, generated or read.

#include <cstdint>
#include <vector>

#include <mobil/components/surface.h>

namespace mobil::inline v0_3 {

/// Appends `part` to the content of `mesh`.
void append(SurfaceMesh& mesh, const SurfaceMesh& part);

/// Removes the vertices that no triangle uses; the others keep their order.
void drop_unused(SurfaceMesh& mesh);

/// Removes pairs of triangles on the same three vertices that face each other's backs. The other triangles keep their
/// order.
void drop_fins(std::vector<std::uint32_t>& triangle);

/// Returns true if every edge belongs to two triangles, one on either side.
bool is_closed(const SurfaceMesh& mesh);

/// Multiplies every position by `factor` (positive).
void scale(SurfaceMesh& mesh, double factor);

/// Reverses the winding of every triangle (three indices each).
void turn_over(std::vector<std::uint32_t>& triangle);

/// Returns the mesh reflected in the plane x = 0, with its triangles turned so that they stay wound outwards.
SurfaceMesh mirror_image(const SurfaceMesh& mesh);

/// Returns the volume enclosed by a closed surface, in the cube of the mesh's unit; negative if it is wound inwards.
/// Overlapping parts count twice.
double enclosed_volume(const SurfaceMesh& mesh);

}  // namespace mobil::inline v0_3
