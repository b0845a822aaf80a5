#pragma once
// Limits of a walk, and the extremes that a walk reaches.

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/systems/gait/step_bounds.h>

namespace mobil::inline v0_3 {

/// A limit of a walk. Joint limits are from assets/body/joint_limits.h. Those of the spine, from pelvis to chest and
/// from chest to head, are of the joint in between that reaches its limit first. Axial rotation is excluded, because
/// five lumbar vertebrae provide two thirds of it. The limit of ground penetration is 5 mm. The limit of the pelvis'
/// acceleration is 16 m/s²: usual walks of all bodies reach 6.3 upward, at 2.3 m/s, and 15.1 downward, when a leg
/// straightens fully at 0.3 m/s.
struct WalkLimit {
  WalkBound bound;
  double limit;           // maximum, m, rad or m/s²
  double shown;           // size of the displayed unit, m, rad or m/s²
  std::string_view says;  // description, with {} for the number
};
/// Returns all limits by WalkBound.
std::span<const WalkLimit, bound_count> walk_limits();

/// Time step of the second difference that gives the pelvis' acceleration, s.
inline constexpr float difference_s = 1.0F / 60;
/// Returns the magnitude of the pelvis' acceleration, m/s², from its heights now and one and two steps earlier, m.
inline float pelvis_acceleration(float now_m, float before_m, float first_m) {
  constexpr float per_s2 = 1 / (difference_s * difference_s);
  return std::fabs(now_m - 2 * before_m + first_m) * per_s2;
}

/// A part of a walk: steady at its speed, a stop from it, a turn, or a slowdown from it and back.
enum class WalkPart : std::uint8_t { steady, stop, turn, change_of_speed };

/// Returns the words of a message, for example "in stopping from".
std::string_view said_of(WalkPart part);

/// Extreme value of each bound, by WalkBound, and the part of the walk in which it occurs.
struct WalkReach {
  Lanes<float> value[bound_count];
  std::array<WalkPart, lane_count> part[bound_count];
};
/// Extremes of steady walk and stops, and of turns and changes of speed. Parts that are not checked have `min_bound`.
struct WalkExtremes {
  WalkReach steady, changing;
};
/// Parts and sampling of a check. Between samples at 60 a second a joint goes up to 1.5° further, and the pelvis'
/// acceleration is up to 4 m/s² higher. A walk too slow for 0.6 of its speed slows down to the minimum speed.
enum class Looking : std::uint8_t {
  roughly,         // the steady walk at 60 samples a second
  closely,         // the steady walk at 240
  at_stops_too,    // `closely`, and stops from either foot at 120
  at_changes,      // at 60: a first step, turns by 60° to either side, slowing down to 0.6 of the speed and back
  at_changes_too,  // the last two together
};
/// Returns the additional margin in steady walks and stops of styles far from the usual one, because turns and changes
/// of speed bend hips and ankles further by that amount.
double for_turns(WalkBound bound, Looking looking);
/// Returns the maximum accepted in such a check, by index of a WalkBound. It is below the limit, because a walk goes
/// slightly further between samples. The margin is smaller for the usual style with other steps, which moves smoothly.
float held_to(std::size_t bound, Looking looking, bool usual_style);

/// Computes the extremes of sixteen walkers. A lane's bits do not depend on other lanes.
void walk_extremes(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& gait, Looking looking,
                   WalkExtremes& extremes);

/// Returns true if the step length is within the table of steps: 0.76 to 1.12 of the usual length at that speed
/// (assets/gait/README.md).
bool has_usual_steps(float height_m, float speed_m_s, float step_length_m);

/// Return true if all numbers of two styles are equal; `same_walk` also compares speed and step length.
bool same_style(const GaitStyle& a, const GaitStyle& b);
bool same_walk(const Gait<float>& a, const Gait<float>& b);

}  // namespace mobil::inline v0_3
