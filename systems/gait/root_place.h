#pragma once
// The root of a walker: the point of the ground that goes along with the body, without its sway.

#include <mobil/components/gait.h>
#include <mobil/components/lanes.h>

namespace mobil::inline v0_3 {

/// Beside the point of the walking line at the stance foothold (GaitState::line_x_m, line_z_m), in the world's axes,
/// and the heading there (rad about +Y, 0 toward +Z, positive to the left).
template <class F>
struct RootPlace {
  F x_m, z_m, heading_rad;
};

/// Under the middle of the hips on the walking line: they go on there at the speed of the walk, without the swaying and
/// the hurrying of each step; who has come to stand is between the feet. Twice continuously differentiable, from step
/// to step too.
void root_place(const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state, RootPlace<Lanes<float>>& out);

}  // namespace mobil::inline v0_3
