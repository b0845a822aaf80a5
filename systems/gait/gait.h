#pragma once
// Walking: the gait of a request (at set-up), the solved steps (after each change) and the walker's clock (every tick).

#include <algorithm>
#include <cstdint>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/components/step_plan.h>
#include <mobil/engine/error.h>
#include <mobil/systems/gait/resolve_gait.h>

namespace mobil::inline v0_3 {

/// Returns the step table's usual length for legs of that scale (BodySize) at a speed, m (assets/gait/README.md). It
/// has no factor of age or shoes (usual_step_factor). 0 at a speed of 0.
float usual_length_m(float leg_scale_m, float speed_m_s);

/// Returns the lowest speed other than 0 that can be requested for a walker of that scale, m/s.
float lowest_speed_m_s(float leg_scale_m);

/// Returns the gait of a speed and a step length, without heading or displacement. All results of resolve_gait follow
/// from these two numbers. A speed of 0 stands.
Gait<float> complete_gait(float leg_scale_m, float speed_m_s, float step_length_m, const GaitStyle& style);

/// Plans the first step of sixteen walkers, as if they had walked before: right heel strike at the start, or standing.
void plan_first_step(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted,
                     StepPlan<Lanes<float>>& plan);

/// Plans the step after `plan`, on the foot that lands at its end (`state.stance_side`, already changed). It approaches
/// the wanted gait as far as one step can (systems/gait/step_plan.cpp). The step always continues the last one
/// smoothly. `clamped` marks steps that no bounded forces can produce.
void plan_next_step(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted,
                    const GaitState<Lanes<float>>& state, StepPlan<Lanes<float>>& plan);

/// Plan only the times and footholds of a step and `settled`, for an unseen walker whose style stays the same. All
/// other fields of `plan` are undefined afterwards.
void time_first_step(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted,
                     StepPlan<Lanes<float>>& plan);
void time_next_step(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted,
                    const GaitState<Lanes<float>>& state, StepPlan<Lanes<float>>& plan);

/// A walker's clock counts in whole units, so many ticks can be caught up at once. `time_s` is always an integer
/// multiple of `unit_s`, and so is a step's duration on the clock.
struct ClockUnits {
  std::int32_t per_tick;
  float unit_s;
  double per_s;

  /// Returns the nearest integer, clamped to a range that is safe for additions. No walker's clock exceeds it.
  std::int32_t of(float seconds) const {
    constexpr double most = 0x1p29;
    const double above = static_cast<double>(seconds) * per_s + 0.5;
    return static_cast<std::int32_t>(above < most ? (above > -most ? above : -most) : most);
  }
  float seconds(std::int32_t units) const { return static_cast<float>(units) * unit_s; }
  /// Returns a step's duration, at least one unit.
  std::int32_t step(float duration_s) const { return std::max(of(duration_s), 1); }
};
/// Returns 2¹⁵ units a tick, or fewer if a step of 4 s would exceed 2²³ units, the limit of a float's resolution.
ClockUnits clock_units(float tick_s);

/// Advances each walker's clock by tick_s, at most one step. At a heel strike the sides change and the line advances to
/// the next foothold. A straight walker's line point is the anchor plus a number of chords.
void advance_gait(const StepPlan<Lanes<float>>& plan, GaitState<Lanes<float>>& state, float tick_s);

/// Returns a mask with bit l set if lane l began a step in this tick that its plan does not describe yet.
std::uint32_t lanes_to_plan(const StepPlan<Lanes<float>>& plan, const Gait<Lanes<float>>& wanted,
                            const GaitState<Lanes<float>>& state, float tick_s);

/// Turns walkers who began a step in this tick toward the wanted heading, beginning with the next foot. A step turns by
/// at most 30° and 1.1 m/s² of sideways acceleration. The foot is put outward by z a / g, where z is the height of the
/// centre of mass and a its acceleration toward the inside (a pendulum's balance). Standing people turn by up to 30° a
/// step on the spot, or step aside as planned. Call it after the step is planned.
void turn_gait(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan, const Gait<Lanes<float>>& wanted,
               GaitState<Lanes<float>>& state, float tick_s);

}  // namespace mobil::inline v0_3
