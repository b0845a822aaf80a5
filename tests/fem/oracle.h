#pragma once
// An independent finite-element model in double precision with dense matrices: Voigt strain-displacement matrices,
// assembled directly on the given mesh. Reference for the kernels.

#include <vector>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/components/muscle.h>
#include "assets/fem/critical_step.h"
#include "assets/fem/stiffness_terms.h"
#include "assets/reduction/symmetric_eigen.h"
#include "engine/eigen.h"

namespace mobil::oracle {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// Trilinear shape functions and their gradients in space at a reference point.
struct Shape {
  Eigen::Matrix<double, 8, 1> n;
  Eigen::Matrix<double, 8, 3> dn;
  double jacobian;
};

Shape shape_at(const HexahedralMesh& mesh, const Hexahedron& h, double x, double y, double z);

/// Unconstrained stiffness (N/m), consistent and lumped (row-sum) mass (kg, three rows a node).
struct Model {
  Matrix stiffness, mass;
  Vector lumped;
};

/// One element: stiffness of its 24 displacements, N/m, and consistent mass of its 8 corners, kg.
struct ElementMatrices {
  Matrix stiffness = Matrix::Zero(24, 24);
  Matrix mass = Matrix::Zero(8, 8);
};

ElementMatrices element_matrices(const HexahedralMesh& mesh, const Hexahedron& h, const Material& material,
                                 Element kind = Element::full);

Model assemble(const HexahedralMesh& mesh, const Material& material, Element kind = Element::full);

HexahedralMesh scaled(HexahedralMesh mesh, double across, double along);

/// Returns the indices of the displacements that move freely.
std::vector<Eigen::Index> free_components(const Cells& cells, FarEnd end);

/// Returns the exact largest angular frequency of the lumped-mass model, 1/s.
double highest_frequency(const Model& model, const std::vector<Eigen::Index>& moving);

/// Returns each node's share of the far face's area for a flat structured face of arbitrary cells: ∫N dA / ∫dA.
Vector far_shares(const HexahedralMesh& mesh);

/// Solves A·x = `right` for a symmetric A.
Vector solve(const Matrix& symmetric, const Vector& right);
/// Returns the eigenvalues of a symmetric matrix, ascending.
Vector eigenvalues(const Matrix& symmetric);
/// Solves K·x = λ·M·x. λ is ascending, xᵀ·M·x = 1.
SymmetricEigen modes(const Matrix& stiffness, const Matrix& mass);
/// Returns only the λ of that problem.
Vector eigenvalues(const Matrix& stiffness, const Matrix& mass);

}  // namespace mobil::oracle
