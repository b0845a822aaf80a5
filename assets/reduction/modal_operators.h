#pragma once
// Products of a belly's stiffness and mass with a few fields at once. Rows of Columns are all displacements of a mesh,
// three a node, also of the faces. Mass is half lumped, half consistent, whose errors in frequency have opposite signs.

#include <span>
#include <vector>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include "assets/fem/critical_step.h"
#include "assets/fem/stiffness_terms.h"
#include "assets/reduction/modal_cholesky.h"
#include "engine/eigen.h"

namespace mobil::inline v0_3 {

/// Sum of a, b and c times the terms A, B, C, and of M₁ in x and y, and in z: any part of a modal problem.
struct OperatorMix {
  double a = 0, b = 0, c = 0, mass_across = 0, mass_along = 0;
};

/// Returns one body's stiffness over its mass S²·l, with the foundation, which gives ω² on M₁.
OperatorMix stiffness_over_mass(double across, double along, double foundation_1_s2);

/// Returns the mix times `fields`, over all rows.
Columns applied(const StiffnessTerms& terms, const OperatorMix& mix, Eigen::Ref<const Columns> fields);

/// Returns M₁ times `fields`, as with a mix of only both masses, but several times faster.
Columns mass_times(const StiffnessTerms& terms, Eigen::Ref<const Columns> fields);

/// Returns leftᵀ·right, summed in pieces that are the same on every machine.
Eigen::MatrixXd inner(Eigen::Ref<const Columns> left, Eigen::Ref<const Columns> right);

/// A mix over the displacements that move, factorised.
class MovingOperator {
 public:
  MovingOperator(const StiffnessTerms& terms, FarEnd end, const OperatorMix& mix);
  bool positive_definite() const { return definite_; }

  /// Replaces `loads` by the displacements under them; 0 where nothing moves.
  void solve(Eigen::Ref<Columns> loads) const;

 private:
  Eigen::Index first_, rows_;
  std::vector<Eigen::Index> still_;  // of those rows
  BandCholesky factor_;
  bool definite_ = false;
};

/// Sets the fields to 0 where nothing moves.
void hold(const Cells& cells, FarEnd end, Eigen::Ref<Columns> fields);

/// Returns the far face one metre out, with nothing else moved: 1 column.
Columns far_step(const Cells& cells);
/// Returns a uniform traction of 1 N on the far face along z, or x, y and z.
Columns far_traction(const HexahedralMesh& mesh, bool all_axes);
/// Returns accelerations of FrameLoad's twelve numbers, 1 each, over the rest positions scaled by `across` and `along`.
Columns frame_fields(const HexahedralMesh& mesh, double across, double along);

/// Return the mesh of every other node, and those nodes' rows of fields.
HexahedralMesh every_other(const HexahedralMesh& mesh);
Columns every_other(const Cells& cells, const Columns& fields);

/// Returns the node of a mesh of `cells` that is (i, j, k) of one of `coarse`, all of whose nodes it has.
constexpr std::uint32_t nested_node(const Cells& cells, const Cells& coarse, std::uint32_t i, std::uint32_t j,
                                    std::uint32_t k) {
  return node_index(cells, i * (cells[0] / coarse[0]), j * (cells[1] / coarse[1]), k * (cells[2] / coarse[2]));
}

}  // namespace mobil::inline v0_3
