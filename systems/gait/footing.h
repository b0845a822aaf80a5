#pragma once
// Which ground is under which foot, as steps go by.

#include <mobil/components/footing.h>
#include <mobil/components/gait.h>

namespace mobil::inline v0_3 {

/// The ground that a foot reaches becomes the stance foot's once that has landed; what comes next is as high until it
/// is asked for (systems/terrain). After the walkers' clocks went on and feet that stand side by side changed roles
/// (advance_gait, turn_gait).
void follow_feet(const GaitState<Lanes<float>>& state, Footing<Lanes<float>>& footing);

}  // namespace mobil::inline v0_3
