#pragma once
// From the solved step to how all 48 segments accelerate.

#include <mobil/components/body.h>
#include <mobil/components/footing.h>
#include <mobil/components/gait.h>
#include <mobil/components/pose.h>
#include <mobil/forces.h>

namespace mobil::inline v0_3 {

/// The motion of bodies of which three poses are known, `apart_s` seconds apart, in a frame of their own: central
/// differences of places, Euler's equations of each segment in its own axes (inertias: assets/body/segment_inertia.h).
void motion_of_poses(const BodySize<Lanes<float>>& size, const Pose<Lanes<float>>& before,
                     const Pose<Lanes<float>>& now, const Pose<Lanes<float>>& after, float apart_s,
                     BodyMotion<Lanes<float>>& motion);

/// The motion of walkers at this instant of their step, from the step alone: no memory, no lag. Near either end of the
/// step that of `motion_difference_s` within it. `footing`: the ground under the feet, null where it is level.
void walker_motion(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                   const GaitState<Lanes<float>>& state, const Footing<Lanes<float>>* footing,
                   BodyMotion<Lanes<float>>& motion);

}  // namespace mobil::inline v0_3
