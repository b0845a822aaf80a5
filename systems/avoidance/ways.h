#pragma once
// Ways over the ground that a walker may take, sixteen side by side: the step under way and the quickest stop after it
// (a reservation), or a step that might be next and the quickest stop after that. Places are of the middle of the hips
// along the walking line, without their sway (25 mm at most). m, s, rad; headings about +Y, 0 toward +Z.

#include <cstddef>
#include <cstdint>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/systems/avoidance/obstacles.h>

namespace mobil::inline v0_3 {

/// Instants at which a way is known: so many of them in a row, about a tenth of a second apart. At the last one
/// everybody stands, but for walks of less than one step a second.
inline constexpr std::size_t way_samples = 26;
struct WayInstants {
  float first_s, every_s;
};

template <class F>
struct WaySamples {
  F x_m[way_samples], z_m[way_samples];
};

/// A walker at a heel strike, or standing: all that the steps from here on follow from. `hips_m`: how far ahead of the
/// stance foothold the hips are. The point of the line beside that foothold, and its heading there. `lands_left` is 1
/// where the left foot is the one to come down next, else −1. `usual`: how long this walker's steps are, of usual ones.
template <class F>
struct HeelStrikePlace {
  F height_m, usual;
  F speed_m_s, pace_hz, advance_m, hips_m;
  F length_before_m, half_width_m;
  F x_m, z_m, heading_rad;
  F chord_before_rad, bend_per_m, bend_before_per_m, shift_m, shift_before_m, lands_left;
};

/// A step to try: the speed that it leads to, the heading to ask for, beside the present one, and its length as a part
/// of the walker's own at that speed. Of who stands and is to stay there: how far to turn on the spot; or, with
/// `aside_m` above 0, a step aside so far toward `slant_rad`.
template <class F>
struct Trial {
  F speed_m_s, turn_rad, length_part;
  F slant_rad, aside_m;
};

/// How such a step ends: how long it takes, where the hips are then, their speed, and the heading that they come
/// to if nothing more is turned; its length, and how much the line bends over such a length from there on.
template <class F>
struct StepEnd {
  F duration_s, x_m, z_m, speed_m_s, heading_rad;
  F step_length_m, bend_rad;
};

/// How far ahead of the leading foot hips are at a heel strike (a negative number), of the step, in a usual walk at a
/// speed over √(g · leg).
float usual_hips(float speed);

/// At the heel strike to come, if nothing else is asked. `hips_m` of who stands is as in a usual walk.
void next_footing(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                  const GaitState<Lanes<float>>& state, HeelStrikePlace<Lanes<float>>& next);

/// The rest of the step and the quickest stop after it: in so many ticks for the first time, and every so many ticks.
/// The place at an instant is the same to the bit whenever within the step it is asked for.
void reservation_ways(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                      const GaitState<Lanes<float>>& state, std::uint32_t first_tick, std::uint32_t every_ticks,
                      float tick_s, WaySamples<Lanes<float>>& out);

/// A step from a footing to a speed that one step reaches, then the quickest stop, from the strike on; and how that
/// step ends.
void tried_ways(const HeelStrikePlace<Lanes<float>>& from, const Trial<Lanes<float>>& tried, const WayInstants& at,
                WaySamples<Lanes<float>>& out, StepEnd<Lanes<float>>& end);

/// Unit vectors of headings within ±10⁵ rad, of others that of 0: sines are the x, cosines the z. Much faster than
/// engine/exact_math.h, and the same on all machines.
void directions(const Lanes<float>& heading_rad, Lanes<float>& x, Lanes<float>& z);
GroundPoint direction(float heading_rad);

/// The least squared distance of each lane's way from one of somebody else, m²: `x_m` and `z_m` have way_samples.
void nearest_approach(const WaySamples<Lanes<float>>& ways, const float* x_m, const float* z_m, Lanes<float>& min_m2);
/// And from a wall from `a` to `b`.
void nearest_to_wall(const WaySamples<Lanes<float>>& ways, float a_x_m, float a_z_m, float b_x_m, float b_z_m,
                     Lanes<float>& min_m2);

}  // namespace mobil::inline v0_3
