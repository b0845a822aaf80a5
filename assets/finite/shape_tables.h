#pragma once
// The shapes of each row of the muscle table at finite strain: as they are committed, and made again.

#include <mobil/components/muscle.h>
#include <mobil/engine/error.h>
#include "assets/finite/shape_table.h"

namespace mobil::inline v0_3 {

/// The committed table: assets/finite/tables, which `mobil fit-shapes --out assets/finite/tables` writes.
ShapeTable shape_table(Muscle muscle);

/// The muscle's mesh at the template's size, and what its shapes are solved on.
HexahedralMesh finite_mesh(Muscle muscle, const Cells& cells);
SampledBelly sampled_belly(Muscle muscle);

/// Solved over the whole grid: some 13 s on a core of 2023 (EPYC 9004). Fails where a shape is not found.
Result<ShapeTable> make_shape_table(Muscle muscle);

}  // namespace mobil::inline v0_3
