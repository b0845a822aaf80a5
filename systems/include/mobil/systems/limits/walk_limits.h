#pragma once
// How far a walk may go, and how far one goes.

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/systems/kinematics/step_bounds.h>

namespace mobil::inline v0_3 {

/// Limits of a walk. Of joints: assets/body/joint_limits.h; the column's from pelvis to chest and from chest to head,
/// of the joint between that comes to its end first (its turns are left out: five lumbar vertebrae take two thirds of
/// them). Under the ground: 5 mm. The pelvis up and down: 16 m/s²; usual walks of all bodies have up to 6.3 up, at 2.3
/// m/s, and up to 15.1 down, where at 0.3 m/s a leg comes to its end.
struct WalkLimit {
  WalkBound bound;
  double limit;           // m, rad or m/s²: what is more is too far
  double shown;           // of these one of the unit in which people read it
  std::string_view says;  // what would be, {} for the number
};
/// By WalkBound.
std::span<const WalkLimit, bound_count> walk_limits();

/// The pelvis' acceleration is the second difference of its height over that time, s.
inline constexpr float difference_s = 1.0F / 60;
/// m/s², of the height now, that time ago and twice that time ago, m.
inline float pelvis_acceleration(float now_m, float before_m, float first_m) {
  constexpr float per_s2 = 1 / (difference_s * difference_s);
  return std::fabs(now_m - 2 * before_m + first_m) * per_s2;
}

/// A part of a walk: at its speed; in stopping from it; in turning; in slowing down from it and coming back to it.
enum class WalkPart : std::uint8_t { steady, stop, turn, change_of_speed };

/// How far each bound goes, by WalkBound, and in which part of the walk.
struct WalkReach {
  Lanes<float> value[bound_count];
  std::array<WalkPart, lane_count> part[bound_count];
};
/// Of the steady walk and of stops; of turns and changes of speed, `least_bound` where those are not looked at.
struct WalkExtremes {
  WalkReach steady, changing;
};
/// What of a walk is looked at. Between sixty instants a second a joint goes up to 1.5° further, and the pelvis is
/// shaken up to 4 m/s² more. Who is too slow to slow down to 0.6 of their speed slows down to the lowest that there is.
enum class Looking : std::uint8_t {
  roughly,       // the steady walk at 60 instants a second
  closely,       // the steady walk at 240
  at_stops_too,  // besides, stops from either foot at 120
  at_changes,    // at 60: a first step, turns by 60° to either side, slowing down to 0.6 of the speed and coming back
  at_changes_too,  // all of the last two
};
/// Of sixteen walkers. A lane's bits depend on no other lane.
void walk_extremes(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& gait, Looking looking,
                   WalkExtremes& extremes);

}  // namespace mobil::inline v0_3
