#pragma once
// Surfaces with fewer triangles, for the middle distance.

#include <mobil/components/surface.h>

namespace mobil::inline v0_3 {

/// Returns the mesh with about `share` (0–1) of its triangles. It removes those whose loss moves it least (by quadrics,
/// Garland and Heckbert 1997); the remaining vertices do not move. Closed surfaces stay closed, and no triangle turns
/// over; a mesh that would allow neither has more triangles. Returns the mesh unchanged if `share` is 1. The result has
/// the same bits on every machine.
SurfaceMesh coarser(const SurfaceMesh& mesh, double share);

}  // namespace mobil::inline v0_3
