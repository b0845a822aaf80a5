#pragma once
// Shapes of each row of the muscle table at finite strain: the committed ones, and their computation.

#include <mobil/components/muscle.h>
#include <mobil/engine/error.h>
#include "assets/finite/shape_table.h"

namespace mobil::inline v0_3 {

/// Returns the committed table of assets/finite/tables, which `mobil fit-shapes --out assets/finite/tables` writes.
ShapeTable shape_table(Muscle muscle);

/// Return the muscle's mesh at the template's size, and the belly on which its shapes are solved.
HexahedralMesh finite_mesh(Muscle muscle, const Cells& cells);
SampledBelly sampled_belly(Muscle muscle);

/// Solves over the whole grid, in about 13 s on a core of 2023 (EPYC 9004). Fails if a shape is not found.
Result<ShapeTable> make_shape_table(Muscle muscle);

}  // namespace mobil::inline v0_3
