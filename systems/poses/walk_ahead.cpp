#include "systems/poses/walk_ahead.h"

#include <mobil/rows.h>
#include "systems/gait/footing.h"
#include "systems/gait/gait.h"

namespace mobil::inline v0_3 {

WalkAhead::WalkAhead(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& gait,
                     const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state,
                     const Footing<Lanes<float>>* footing, float ahead_s)
    : state_(state), plan_(&plan), uneven_(footing != nullptr) {
  if (uneven_) footing_ = *footing;
  // Rounding residue of a frame that ends with a tick is ignored. The clock's unit is a fraction of `ahead_s`; a
  // shorter time would give too many units.
  constexpr float min_s = 1e-6F;
  if (!(ahead_s > min_s)) return;
  advance_gait(plan, state_, ahead_s);
  if (const std::uint32_t lanes = lanes_to_plan(plan, gait, state_, ahead_s); lanes != 0) {
    StepPlan<Lanes<float>> solved = next_ = plan;
    plan_next_step(size, gait, state_, solved);
    for (std::size_t l = 0; l < lane_count; ++l)
      if ((lanes >> l & 1U) != 0) put_row(row_of(solved, l), next_, l);
    plan_ = &next_;
  }
  turn_gait(size, *plan_, gait, state_, ahead_s);
  if (uneven_) follow_feet(state_, footing_);
}

}  // namespace mobil::inline v0_3
