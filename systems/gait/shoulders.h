#pragma once
// Rotation of the shoulders, with which a person fits through a gap.

#include <mobil/components/avoidance.h>
#include <mobil/components/pose.h>

namespace mobil::inline v0_3 {

/// Maximum turn of the shoulders relative to the pelvis in either direction, rad: half the range of the thoracic column
/// (White and Panjabi 1990).
inline constexpr float max_shoulder_turn = 40 * 3.14159265F / 180;

/// Rate of the spring that turns the shoulders, 1/s: nine tenths of the turn in half a second.
inline constexpr float shoulder_spring_per_s = 8;

/// Moves `turn_rad` one tick toward `turn_to_rad`, without a jump of its rate.
void ease_shoulders(AvoidanceState<Lanes<float>>& course, float tick_s);

/// Turns the upper body of a pose about the vertical, relative to the pelvis (rad, positive to the left). The joints of
/// the column share the turn by their ranges. The arms move with the shoulders, and the head keeps its direction.
void turn_shoulders(const Lanes<float>& turn_rad, Pose<Lanes<float>>& pose);

}  // namespace mobil::inline v0_3
