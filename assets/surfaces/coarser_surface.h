#pragma once
// Surfaces with fewer triangles, for the middle distance.

#include <mobil/components/surface.h>

namespace mobil::inline v0_3 {

/// Returns the mesh with about `share` (0–1) of its triangles. It removes those whose loss moves it least (by quadrics,
/// Garland and Heckbert 1997, through meshoptimizer); the remaining vertices do not move. Returns the mesh unchanged if
/// `share` is 1.
SurfaceMesh coarser(const SurfaceMesh& mesh, double share);

/// True if the library was built with meshoptimizer; if not, meshes stay as they are.
bool can_be_coarser();

}  // namespace mobil::inline v0_3
