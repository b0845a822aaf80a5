#pragma once
// Surfaces made lighter and tidier, always with the same outcome for the same input.

#include <cstddef>

#include <mobil/components/surface.h>

namespace mobil::inline v0_3 {

/// Without the connected pieces that hold less than `share` (0–1) of the triangles, and without unused vertices. The
/// largest piece always stays. Returns how many pieces were taken away.
std::size_t remove_specks(SurfaceMesh& mesh, double share);

/// Vertex clustering (Rossignac and Borrel 1993): the vertices of each cubic cell of edge `cell_m` become one at their
/// mean, weighted by the area of their triangles; triangles that collapse, or come to lie on another, are left out.
/// Vertices move by less than a cell's diagonal. The mesh is returned as it is where `cell_m` is 0 or less.
SurfaceMesh clustered(const SurfaceMesh& mesh, double cell_m);

}  // namespace mobil::inline v0_3
