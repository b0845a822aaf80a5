#pragma once
// Simplification and cleaning of surfaces, deterministic for the same input.

#include <cstddef>

#include <mobil/components/surface.h>

namespace mobil::inline v0_3 {

/// Removes the connected pieces with less than `share` (0–1) of the triangles, and unused vertices. The largest piece
/// always stays. Returns the number of removed pieces.
std::size_t remove_specks(SurfaceMesh& mesh, double share);

/// Returns the mesh after vertex clustering (Rossignac and Borrel 1993). The vertices of each cubic cell of edge
/// `cell_m` become one at their mean, weighted by the area of their triangles. Triangles that collapse or coincide are
/// left out. Vertices move by less than a cell's diagonal. Returns the mesh unchanged if `cell_m` is 0 or less.
SurfaceMesh clustered(const SurfaceMesh& mesh, double cell_m);

}  // namespace mobil::inline v0_3
