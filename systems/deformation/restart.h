#pragma once
// Restarts bellies that are not finite at a tick's end, usually because a host's own system wrote NaN or infinity. This
// covers bellies whose state is displacements. Modal bellies restart themselves (systems/deformation/modal.h).

#include <cstdint>

#include <mobil/components/lanes.h>
#include <mobil/components/muscle.h>
#include <mobil/engine/access.h>
#include "assets/fem/muscle_template.h"

namespace mobil::inline v0_3 {

/// Restarts the lanes of a block whose reports are not finite, after its tick. They are stretched evenly from the
/// origin to the held end at its position and speed at the tick's end. They are at rest if the end slides or is not
/// finite itself. They report that elongation, the volume at rest, and zero energies and reaction. `displacement` and
/// `velocity` are the block's (BellyBlock), the latter null for static. Returns the number of rows among them.
std::uint32_t restart_bellies(const MuscleTemplate& shape, const Rows& rows, const EndDrive<Lanes<float>>& end,
                              float tick_s, BellyReport<Lanes<float>>& report, float* displacement, float* velocity);

/// Returns the number of rows among those lanes, given as bits.
std::uint32_t count_rows(std::uint32_t lanes, const Rows& rows);

}  // namespace mobil::inline v0_3
