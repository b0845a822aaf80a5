#pragma once
// More vectors than a reduced belly moves along: the slow vibrations of three bodies of its range, in which what the
// few leave out is looked for first (tests/reduction/bound/reduction_bound.h). Nothing that is proven rests on how good
// they are.

#include <mobil/assets/fem/hexahedral_mesh.h>
#include "assets/reduction/reduced_basis.h"
#include "assets/reduction/reduced_operators.h"
#include "engine/eigen.h"

namespace mobil {

/// What a wider space is made for. Columns over all displacements of the mesh, as in reduced_operators.h.
struct SpaceCase {
  const HexahedralMesh& mesh;
  const StiffnessTerms& terms;
  const ReducedOptions& options;
  double foundation_1_s2 = 0;
};

/// What pulls a body scaled by `across` and `along` over its mass S²·l, by 1 of each input: of a held far face one
/// metre (less stiffness times that step), else 1 N; then the frame's accelerations.
Columns unit_pulls(const SpaceCase& given, double across, double along);

/// `vectors` (orthonormal in M₁, 0 where nothing moves) and as many more, orthonormal too, as make `count`, or as the
/// mesh has. Fails where a body's stiffness is not positive definite.
Result<Columns> wider_space(const SpaceCase& given, const Columns& vectors, Eigen::Index count);

}  // namespace mobil
