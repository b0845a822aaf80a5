#pragma once
// Stiffness that active fibres add to a belly. They hold the tissue along them like a taut string, more tightly the
// farther they are stretched.

#include <mobil/assets/fem/hexahedral_mesh.h>
#include "assets/reduction/modal_cholesky.h"
#include "engine/eigen.h"

namespace mobil::inline v0_3 {

/// Returns fieldsᵀ·G·fields of a mesh in its own size, N/m. G is the tangent at rest of the active stress of full
/// activation (assets/fem/finite_tissue.h, its ratio to the shear modulus kept), along the mesh's lines,
///   G_ab = ∫ T·(a·∇N_a)·(a·∇N_b)·(1 + (slope − 1)·a⊗a) dV.
/// Rows of `fields` are displacements, three a node. The mesh's elements must not be inverted.
Eigen::MatrixXd tension_stiffness(const HexahedralMesh& mesh, double shear_pa, const Columns& fields);

}  // namespace mobil::inline v0_3
