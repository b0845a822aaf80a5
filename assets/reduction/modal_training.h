#pragma once
// Components of one body's motions, as columns in proportion to their importance. They are the static response to each
// load times that load in walking, and the position controllability Gramian of its vibrations. Kicks of each load's
// rate excite these, as a walk's polygonal inputs do once a tick.

#include <cstdint>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include "assets/fem/stiffness_terms.h"
#include "assets/reduction/modal_basis.h"
#include "assets/reduction/modal_operators.h"
#include "engine/eigen.h"

namespace mobil::inline v0_3 {

/// Data of all training bodies.
struct Training {
  const HexahedralMesh& mesh;
  const StiffnessTerms& terms;
  const ModalBasisOptions& options;
  double foundation_1_s2 = 0;
  Eigen::Index max_columns = 0;  // from a body's kicks
};

struct TrainedBody {
  Columns lift;     // of a held far face (else 0 columns)
  Columns statics;  // of all other loads
  Columns kicks;
};

/// Trains a body scaled by `across` and `along`. Fails if its stiffness is not positive definite.
Result<TrainedBody> train(const Training& training, double across, double along);

/// Root mean square of a held far face's displacement in walking, m.
inline constexpr double walk_stretch_m = 0.0158;

/// Makes `fields` orthonormal in M₁ to `basis` (with M₁·basis) and among each other, from the first on; dependent ones
/// are left out. Returns their M₁·fields.
Columns orthonormalise(const StiffnessTerms& terms, const Eigen::Ref<const Columns>& basis,
                       const Eigen::Ref<const Columns>& mass_basis, Columns& fields);

}  // namespace mobil::inline v0_3
