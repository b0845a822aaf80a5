#pragma once
// What is done to any surface of triangles, generated or read.

#include <cstdint>
#include <vector>

#include <mobil/components/surface.h>

namespace mobil::inline v0_3 {

/// Puts `part` beside what `mesh` holds already.
void append(SurfaceMesh& mesh, const SurfaceMesh& part);

/// Without the vertices that no triangle has; the others keep their order.
void drop_unused(SurfaceMesh& mesh);

/// Every position times `factor` (positive).
void scale(SurfaceMesh& mesh, double factor);

/// Winds every triangle (three indices each) the other way round.
void turn_over(std::vector<std::uint32_t>& triangle);

/// Reflected in the plane x = 0, the triangles turned so that they stay wound outwards.
SurfaceMesh mirror_image(const SurfaceMesh& mesh);

/// Volume enclosed by a closed surface, in the cube of the mesh's unit: negative where it is wound inwards. Overlapping
/// parts count twice.
double enclosed_volume(const SurfaceMesh& mesh);

}  // namespace mobil::inline v0_3
