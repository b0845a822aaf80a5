#pragma once
// Requirements on the surfaces of an anatomy, and their repair.

#include <mobil/assets/import/surface_report.h>
#include <mobil/components/surface.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Checks edges and removes doubled triangles. Fails if more than two triangles use an edge. Errors lack the file.
Result<void> check_edges(SurfaceMesh& mesh, SurfaceReport& report);

/// Removes pieces wholly on the left from a mesh of the right side (m, mobil's axes). Fails if nothing remains, or if a
/// piece extends far beyond the middle plane.
Result<void> keep_right_side(SurfaceMesh& mesh, float middle_x, SurfaceReport& report);

/// Winds triangles alike and outwards, splits pinched vertices, and closes small holes of muscles and tendons. Fails on
/// surfaces with only one side. Muscles and tendons also fail if they stay open, are flat, have pieces that overlap,
/// cut themselves often, or are mostly specks. Specks, pieces with a smaller share of the triangles than `speck_share`,
/// are removed except from bones. Positions in m.
Result<void> mend_and_check(SurfaceMesh& mesh, AnatomyKind kind, double speck_share, SurfaceReport& report);

}  // namespace mobil::inline v0_3
