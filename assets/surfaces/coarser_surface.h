#pragma once
// Surfaces with fewer triangles, for the middle distance.

#include <mobil/components/surface.h>

namespace mobil::inline v0_3 {

/// The mesh with about `share` (0–1) of its triangles, those whose loss moves it least (by quadrics, Garland and
/// Heckbert 1997, through meshoptimizer), and the vertices that they need, which stay where they are. The mesh is
/// returned as it is where `share` is 1.
SurfaceMesh coarser(const SurfaceMesh& mesh, double share);

/// Whether the library was built with it; where not, meshes stay as they are.
bool can_be_coarser();

}  // namespace mobil::inline v0_3
