#pragma once
// How far a walk may go, and how far one goes.

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/systems/gait/step_bounds.h>

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

/// "in stopping from", and so on.
std::string_view said_of(WalkPart part);

/// How far each bound goes, by WalkBound, and in which part of the walk.
struct WalkReach {
  Lanes<float> value[bound_count];
  std::array<WalkPart, lane_count> part[bound_count];
};
/// Of the steady walk and of stops; of turns and changes of speed, `min_bound` where those are not looked at.
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
/// What else is kept free in steady walks and stops of styles far from the usual one: turns and changes of speed bend
/// hips and ankles so much further.
double for_turns(WalkBound bound, Looking looking);
/// How far a walk may go as far as it is looked at so, by number of a WalkBound. What is kept free below the limits,
/// for a walk goes a little further between the instants that are looked at. The usual style with other steps moves
/// smoothly.
float held_to(std::size_t bound, Looking looking, bool usual_style);

/// Of sixteen walkers. A lane's bits depend on no other lane.
void walk_extremes(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& gait, Looking looking,
                   WalkExtremes& extremes);

/// Whether each number of a style is within that part of the usual one, or as near as rounding makes it (`snapped`).
bool is_within_usual(const GaitStyle& style, float part);
/// Whether each number is within a tenth of the usual one, and all are off by 7 % in the root mean square. Numbers
/// drawn evenly within a tenth are off by 5.8 %: 299 of 300 such styles are near.
bool is_near_usual(const GaitStyle& style);

/// Whether a walk has steps of the lengths that the table of steps has, 0.76 to 1.12 of the usual one at that speed
/// (assets/gait/README.md).
bool has_usual_steps(float height_m, float speed_m_s, float step_length_m);

/// True if the walk certainly keeps the limits; false says nothing. It requires steps of the usual length and each
/// number of the style within a tenth of the usual one. It estimates the walk's extremes from the usual walk of that
/// height and speed, by the first-order effect of each number, plus a quarter of all effects as a margin. 180 000
/// random styles were tried, every number up to a tenth off, a third of the numbers at that end. 4000 of them broke a
/// limit. For two thirds the answer was true, and all of those kept the limits, the nearest by 0.9°. The first call
/// computes the numbers, in some tens of milliseconds.
bool surely_keeps_limits(const BodySize<float>& size, const Gait<float>& gait);

/// Whether all numbers of two styles are equal; and the speed and the step length too.
bool same_style(const GaitStyle& a, const GaitStyle& b);
bool same_walk(const Gait<float>& a, const Gait<float>& b);

}  // namespace mobil::inline v0_3
