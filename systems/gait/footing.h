#pragma once
// Assignment of queried ground to the feet as steps advance.

#include <mobil/components/footing.h>
#include <mobil/components/gait.h>

namespace mobil::inline v0_3 {

/// Makes the ground under a landed foot the stance foot's ground. The next ground has the same height until it is
/// queried (systems/terrain). Call it after the walkers' clocks have advanced and feet side by side have swapped roles
/// (advance_gait, turn_gait).
void follow_feet(const GaitState<Lanes<float>>& state, Footing<Lanes<float>>& footing);

}  // namespace mobil::inline v0_3
