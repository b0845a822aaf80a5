#pragma once
// Shoulders that turn, so that somebody fits through a gap.

#include <mobil/components/avoidance.h>
#include <mobil/components/pose.h>

namespace mobil::inline v0_3 {

/// How far shoulders turn either way beside the pelvis, rad: half of what a thoracic column can (White and Panjabi
/// 1990).
inline constexpr float max_shoulder_turn = 40 * 3.14159265F / 180;

/// Of the spring by which they turn, 1/s: in half a second nine tenths of the way.
inline constexpr float shoulder_spring_per_s = 8;

/// `turn_rad` a tick nearer to `turn_to_rad`, without a jump of its rate.
void ease_shoulders(AvoidanceState<Lanes<float>>& course, float tick_s);

/// Turns the upper body of a pose about the vertical, so far against the pelvis (rad, positive to the left). The joints
/// of the column take parts of it as they can turn; the arms go with the shoulders; the head looks where it did.
void turn_shoulders(const Lanes<float>& turn_rad, Pose<Lanes<float>>& pose);

}  // namespace mobil::inline v0_3
