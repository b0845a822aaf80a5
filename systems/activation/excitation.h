#pragma once
// Excitation of muscles from the phase of their legs in the walk.

#include <array>
#include <cstddef>
#include <cstdint>

#include <mobil/components/activation.h>
#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/components/lanes.h>
#include <mobil/components/leg_frames.h>
#include <mobil/components/step_plan.h>
#include "assets/muscles/excitation_curves.h"

namespace mobil::inline v0_3 {

/// Excitations of a row's members, in the order of the row.
struct RowExcitation {
  std::array<MemberExcitation, max_row_members> member;
  std::size_t members;
};
RowExcitation row_excitation(Muscle muscle);

/// Computes excitations of sixteen muscles' members, 0.01 to 1, from assets/muscles/excitation_curves.h. A NaN speed
/// counts as standing. A NaN phase gives the minimum excitation.
void excite(const RowExcitation& row, const LegClock<Lanes<float>>& clock, Lanes<float>* member);

/// Writes the clocks of both legs of sixteen walkers.
void set_clocks(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                const GaitState<Lanes<float>>& state, PublishedLeg* posts);

}  // namespace mobil::inline v0_3
