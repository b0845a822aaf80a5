#pragma once
// A belly that is not finite at a tick's end begins anew. Usually a host's own system wrote NaN or infinity. Here are
// bellies whose displacements are the state; modal ones do so themselves (systems/deformation/modal.h).

#include <cstdint>

#include <mobil/components/lanes.h>
#include <mobil/components/muscle.h>
#include <mobil/engine/access.h>
#include "assets/fem/muscle_template.h"

namespace mobil::inline v0_3 {

/// After a block's tick: lanes whose report is not finite are drawn out evenly from their origin to the held end, as it
/// is and moves at the tick's end; to rest where the end slides or is not finite itself. They report that elongation,
/// the volume at rest, and neither energies nor a reaction. `displacement` and `velocity` are the block's (BellyBlock);
/// `velocity` is null where there is none. How many rows those were.
std::uint32_t restart_bellies(const MuscleTemplate& shape, const Rows& rows, const EndDrive<Lanes<float>>& end,
                              float tick_s, BellyReport<Lanes<float>>& report, float* displacement, float* velocity);

/// How many of those lanes, as bits, are rows.
std::uint32_t count_rows(std::uint32_t lanes, const Rows& rows);

}  // namespace mobil::inline v0_3
