#pragma once
// Ways over the ground, sixteen side by side. A way is the step under way and the quickest stop after it (a
// reservation), or a possible next step and the quickest stop after that. Places are of the hip centre along the
// walking line, without its sway (25 mm at most). m, s, rad; headings about +Y, 0 toward +Z.

#include <cstddef>
#include <cstdint>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/components/step_plan.h>
#include <mobil/systems/avoidance/obstacles.h>

namespace mobil::inline v0_3 {

/// Number of instants at which a way is sampled, about 0.1 s apart. At the last one all people stand, except in walks
/// of less than one step a second.
inline constexpr std::size_t way_samples = 26;
struct WayInstants {
  float first_s, every_s;
};

template <class F>
struct WaySamples {
  F x_m[way_samples], z_m[way_samples];
};

/// A walker at a heel strike, or standing: the state from which further steps follow. `hips_m` is how far the hips are
/// ahead of the stance foothold. Place and heading are of the line at that foothold. `lands_left` is 1 if the left foot
/// lands next, else −1. `usual` is the step length relative to the usual one.
template <class F>
struct HeelStrikePlace {
  F height_m, usual;
  F speed_m_s, pace_hz, advance_m, hips_m;
  F length_before_m, half_width_m;
  F x_m, z_m, heading_rad;
  F chord_before_rad, bend_per_m, bend_before_per_m, shift_m, shift_before_m, lands_left;
};

/// A step to try: its final speed, the requested heading relative to the present one, and its length relative to the
/// walker's own at that speed. For a standing walker who stays: the turn on the spot or, with `aside_m` above 0, a step
/// of that length toward `slant_rad`.
template <class F>
struct Trial {
  F speed_m_s, turn_rad, length_part;
  F slant_rad, aside_m;
};

/// End of such a step: duration; place and speed of the hips; heading without a further turn; length of the step.
/// `bend_rad` is the bend of the line over such a length from there on.
template <class F>
struct StepEnd {
  F duration_s, x_m, z_m, speed_m_s, heading_rad;
  F step_length_m, bend_rad;
};

/// Returns how far hips are ahead of the leading foot at a heel strike (a negative number), relative to the step, in a
/// usual walk. `speed` is relative to √(g · leg).
float usual_hips(float speed);

/// Writes the state at the coming heel strike, without further requests. Standing walkers have usual `hips_m`.
void next_footing(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                  const GaitState<Lanes<float>>& state, HeelStrikePlace<Lanes<float>>& next);

/// Samples the rest of the step and the quickest stop after it, first in `first_tick` ticks, then every `every_ticks`.
/// The place at an instant has the same bits, whenever within the step it is computed.
void reservation_ways(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                      const GaitState<Lanes<float>>& state, std::uint32_t first_tick, std::uint32_t every_ticks,
                      float tick_s, WaySamples<Lanes<float>>& out);

/// Samples a step from a footing to a speed that one step reaches, then the quickest stop, starting at the strike.
/// `end` receives the end of that step.
void tried_ways(const HeelStrikePlace<Lanes<float>>& from, const Trial<Lanes<float>>& tried, const WayInstants& at,
                WaySamples<Lanes<float>>& out, StepEnd<Lanes<float>>& end);

/// Writes unit vectors of headings within ±10⁵ rad: sines to `x`, cosines to `z`. Other headings count as 0. Much
/// faster than engine/exact_math.h, and the same on all machines.
void directions(const Lanes<float>& heading_rad, Lanes<float>& x, Lanes<float>& z);
GroundPoint direction(float heading_rad);

/// Writes the minimum squared distance of each lane's way from another person's, m². `x_m`, `z_m` have way_samples.
void nearest_approach(const WaySamples<Lanes<float>>& ways, const float* x_m, const float* z_m, Lanes<float>& min_m2);
/// Writes the minimum squared distance of each lane's way from a wall from `a` to `b`, m².
void nearest_to_wall(const WaySamples<Lanes<float>>& ways, float a_x_m, float a_z_m, float b_x_m, float b_z_m,
                     Lanes<float>& min_m2);

}  // namespace mobil::inline v0_3
