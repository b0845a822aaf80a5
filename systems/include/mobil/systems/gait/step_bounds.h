#pragma once
// What of a step the ground and the joints bound, at one instant.

#include <array>
#include <cstddef>
#include <cstdint>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>

namespace mobil::inline v0_3 {

/// What may go too far, each counted in the direction in which it does.
enum class WalkBound : std::uint8_t {
  under_ground,  // the lowest point of both soles, m
  hip_back,      // rad from here to the last but one: of the joint that goes furthest, from the anatomical position
  hip_forward,
  hip_outward,  // abduction
  hip_inward,
  hip_turned_out,  // the foot's heading beside the pelvis'
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
  trunk_forward,  // the chest beside the pelvis
  trunk_back,
  trunk_aside,
  neck_bent,      // the head beside the chest
  pelvis_shaken,  // up or down, m/s²; of more than one instant, so that `step_bounds` leaves it alone
};
inline constexpr std::size_t bound_count = static_cast<std::size_t>(WalkBound::pelvis_shaken) + 1;

template <class F>
struct StepBounds {
  F value[bound_count];  // by WalkBound: the furthest so far
  F pelvis_up_m;         // now
};

/// What bounds are before anything was noted: below all that is.
inline constexpr float min_bound = -10;
inline void clear_bounds(StepBounds<Lanes<float>>& bounds) {
  for (Lanes<float>& value : bounds.value) value = in_every_lane<Lanes<float>>(min_bound);
}

/// Notes in `bounds` what goes further than there in the pose that `pose_skeleton` makes of a step
/// (systems/gait/kinematics.h), without the pose.
void step_bounds(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                 const GaitState<Lanes<float>>& state, StepBounds<Lanes<float>>& bounds);

}  // namespace mobil::inline v0_3
