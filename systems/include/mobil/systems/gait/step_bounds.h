#pragma once
// Quantities of a step that ground and joints limit, at one instant.

#include <array>
#include <cstddef>
#include <cstdint>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/components/step_plan.h>

namespace mobil::inline v0_3 {

/// Limited quantities. Each is positive in the direction of its limit.
enum class WalkBound : std::uint8_t {
  under_ground,  // depth of the lowest point of both soles, m
  hip_back,      // angles: rad from the anatomical position, of the joint that goes furthest
  hip_forward,
  hip_outward,  // abduction
  hip_inward,
  hip_turned_out,  // the foot's heading relative to the pelvis'
  hip_turned_in,
  knee_straight,
  knee_bent,
  ankle_down,
  ankle_up,
  foot_inverted,
  foot_everted,
  toes_down,
  toes_up,
  arm_back,
  arm_forward,
  elbow_straight,
  elbow_bent,
  trunk_forward,  // the chest relative to the pelvis
  trunk_back,
  trunk_aside,
  neck_bent,      // the head relative to the chest
  pelvis_shaken,  // vertical acceleration, m/s²; it needs several instants, so `step_bounds` does not set it
};
inline constexpr std::size_t bound_count = static_cast<std::size_t>(WalkBound::pelvis_shaken) + 1;

template <class F>
struct StepBounds {
  F value[bound_count];  // maximum so far, by WalkBound
  F pelvis_up_m;         // present height
};

/// Initial value of a bound, below all possible values.
inline constexpr float min_bound = -10;
inline void clear_bounds(StepBounds<Lanes<float>>& bounds) {
  for (Lanes<float>& value : bounds.value) value = in_every_lane<Lanes<float>>(min_bound);
}

/// Raises `bounds` to the values of the pose that `pose_skeleton` computes from a step (systems/gait/kinematics.h),
/// without computing the pose.
void step_bounds(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                 const GaitState<Lanes<float>>& state, StepBounds<Lanes<float>>& bounds);

}  // namespace mobil::inline v0_3
