#pragma once
// The root of a walker: the ground point that moves with the body, without its sway.

#include <mobil/components/gait.h>
#include <mobil/components/lanes.h>
#include <mobil/components/step_plan.h>

namespace mobil::inline v0_3 {

/// Position relative to the point of the walking line at the stance foothold (GaitState::line_x_m, line_z_m), in world
/// axes, and the heading there (rad about +Y, 0 toward +Z, positive to the left).
template <class F>
struct RootPlace {
  F x_m, z_m, heading_rad;
};

/// Computes the root, on the walking line under the middle of the hips. It moves at the speed of the walk, without the
/// sway and speed changes of each step. The root of a standing person is between the feet. It is twice continuously
/// differentiable, also across steps.
void root_place(const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state, RootPlace<Lanes<float>>& out);

}  // namespace mobil::inline v0_3
