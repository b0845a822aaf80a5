#pragma once
// Converts a fine mesh's displacement to that of a few control points, whose trilinear cells are shown. It is the
// nearest in the mean over the belly's mass that keeps the volume enclosed by the cells.

#include <vector>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/engine/error.h>
#include "assets/finite/finite_belly.h"
#include "engine/eigen.h"

namespace mobil::inline v0_3 {

struct ControlMesh {
  HexahedralMesh mesh;     // of the control cells, at rest
  Eigen::MatrixXd moment;  // control points × fine nodes: ∫ρN of one times the other's, kg
  Eigen::MatrixXd mass;    // control points squared, kg
  Eigen::MatrixXd inner;   // Cholesky's factor of `mass` without both ends
};

/// Fails if the belly's mesh lacks nodes of the control cells, or if those have one layer.
Result<ControlMesh> make_control_mesh(const FiniteBelly& belly, const Cells& cells);

/// Returns the control points' displacement, three a point, m, nearest to `displacement_m`, that of all nodes of the
/// belly. Both ends are the same as there.
std::vector<double> nearest_points(const ControlMesh& points, const std::vector<double>& displacement_m);

/// Moves the points between the ends as little as possible, in the mean over mass, so that their cells enclose `ratio`
/// times the volume at rest. Fails if eight Newton steps do not suffice.
Result<void> keep_volume(const ControlMesh& points, std::vector<double>& displacement_m, double ratio = 1);

/// Returns the volume that the control points' cells enclose, over that at rest.
double enclosed_volume(const HexahedralMesh& mesh, const std::vector<double>& displacement_m);

/// Returns the displacements of a finer mesh's nodes that are control points, three each.
std::vector<double> sampled_points(const Cells& fine, const Cells& control, const std::vector<double>& displacement_m);

}  // namespace mobil::inline v0_3
