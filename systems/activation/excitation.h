#pragma once
// From where legs are in their walk to how hard their muscles are asked to pull.

#include <array>
#include <cstddef>
#include <cstdint>

#include <mobil/components/activation.h>
#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/components/lanes.h>
#include <mobil/components/leg_frames.h>
#include "assets/muscles/excitation_curves.h"

namespace mobil::inline v0_3 {

/// How the members of a row are excited, in its order.
struct RowExcitation {
  std::array<MemberExcitation, max_row_members> member;
  std::size_t members;
};
RowExcitation row_excitation(Muscle muscle);

/// Excitations of sixteen muscles' members, 0.01 to 1, as assets/muscles/excitation_curves.h has them. A
/// speed that is NaN counts as standing; where the phase is none, the least.
void excite(const RowExcitation& row, const LegClock<Lanes<float>>& clock, Lanes<float>* member);

/// Both legs' clocks of sixteen walkers.
void set_clocks(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                const GaitState<Lanes<float>>& state, PublishedLeg* posts);

}  // namespace mobil::inline v0_3
