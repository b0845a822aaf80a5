#pragma once
// What one body's motions are made of, as columns that matter in proportion to their size: the static answer to each
// load times what the load is in walking, and the position controllability Gramian of its vibrations under kicks of
// each load's rate, as a walk's polygonal inputs give once a tick.

#include <cstdint>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include "assets/fem/stiffness_terms.h"
#include "assets/reduction/modal_basis.h"
#include "assets/reduction/modal_operators.h"
#include "engine/eigen.h"

namespace mobil::inline v0_3 {

/// What bodies are trained on.
struct Training {
  const HexahedralMesh& mesh;
  const StiffnessTerms& terms;
  const ModalBasisOptions& options;
  double foundation_1_s2 = 0;
  Eigen::Index max_columns = 0;  // that a body's kicks give
};

struct TrainedBody {
  Columns lift;     // of a held far face (else 0 columns)
  Columns statics;  // of all other loads
  Columns kicks;
};

/// A body scaled by `across` and `along`. Fails where its stiffness is not positive definite.
Result<TrainedBody> train(const Training& training, double across, double along);

/// Root mean square of a held far face's displacement in walking, m.
inline constexpr double walk_stretch_m = 0.0158;

/// Makes `fields` orthonormal in M₁ to `basis` (with M₁·basis) and in themselves, from the first on; those that depend
/// on others are left out. Their M₁·fields.
Columns orthonormalise(const StiffnessTerms& terms, const Eigen::Ref<const Columns>& basis,
                       const Eigen::Ref<const Columns>& mass_basis, Columns& fields);

}  // namespace mobil::inline v0_3
