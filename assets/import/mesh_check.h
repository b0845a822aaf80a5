#pragma once
// What the surfaces of an anatomy must be, and what of it is mended.

#include <mobil/assets/import/surface_report.h>
#include <mobil/components/surface.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Edges and doubled triangles: fails where more than two different triangles use an edge. Errors lack the file.
Result<void> check_edges(SurfaceMesh& mesh, SurfaceReport& report);

/// Of a mesh of the right side (m, mobil's axes): takes away pieces that lie wholly on the left. Fails where nothing is
/// left, or a piece reaches far beyond the middle plane.
Result<void> keep_right_side(SurfaceMesh& mesh, float middle_x, SurfaceReport& report);

/// Winds alike and outwards, splits pinched vertices, and of muscles and tendons closes small holes. Fails for what has
/// one side only; for muscles and tendons also if they stay open, are flat, have pieces that overlap, cut themselves
/// often, or are mostly specks (pieces with a smaller share of the triangles than `speck_share`, which are taken away
/// from all but bones). Positions in m.
Result<void> mend_and_check(SurfaceMesh& mesh, AnatomyKind kind, double speck_share, SurfaceReport& report);

}  // namespace mobil::inline v0_3
