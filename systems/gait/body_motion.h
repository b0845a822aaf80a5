#pragma once
// Accelerations of all 48 segments from the solved step.

#include <mobil/components/body.h>
#include <mobil/components/footing.h>
#include <mobil/components/gait.h>
#include <mobil/components/pose.h>
#include <mobil/components/step_plan.h>
#include <mobil/forces.h>

namespace mobil::inline v0_3 {

/// Computes the motion of bodies from three poses `apart_s` seconds apart, in a frame of their own, by central
/// differences of positions and Euler's equations in each segment's axes (inertias: assets/body/segment_inertia.h).
void motion_of_poses(const BodySize<Lanes<float>>& size, const Pose<Lanes<float>>& before,
                     const Pose<Lanes<float>>& now, const Pose<Lanes<float>>& after, float apart_s,
                     BodyMotion<Lanes<float>>& motion);

/// Computes the motion of walkers at this instant from the step alone, without memory or lag. Near the step's ends its
/// curves are continued by `motion_difference_s`. `footing` is the ground under the feet, null on level ground.
void walker_motion(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                   const GaitState<Lanes<float>>& state, const Footing<Lanes<float>>* footing,
                   BodyMotion<Lanes<float>>& motion);

}  // namespace mobil::inline v0_3
