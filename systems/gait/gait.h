#pragma once
// Walking: from a request to a gait (set-up), the solved steps (whenever something changes) and the walker's clock
// (every tick).

#include <algorithm>
#include <cstdint>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/engine/error.h>
#include <mobil/systems/gait/resolve_gait.h>

namespace mobil::inline v0_3 {

/// The step that people of that height take at a speed, m: measured ones (assets/gait/README.md). 0 at a speed of 0.
float usual_length_m(float height_m, float speed_m_s);

/// The lowest speed that a walker of that height may be asked for, but for 0, m/s.
float lowest_speed_m_s(float height_m);

/// The gait of a speed and a step length, no heading or way asked for: what resolve_gait answers follows from these two
/// of its numbers. A speed of 0 stands.
Gait<float> complete_gait(float height_m, float speed_m_s, float step_length_m, const GaitStyle& style);

/// The first step of sixteen walkers, as if they had walked so before: right heel strike at the start, or standing.
void plan_first_step(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted,
                     StepPlan<Lanes<float>>& plan);

/// The step that follows `plan` for the foot that lands at its end to stand on (`state.stance_side`, already changed),
/// toward the wanted gait as far as one step may go (systems/gait/step_plan.cpp). Always gives a step that goes on from
/// the last one smoothly; `clamped` tells where no bounded forces make it.
void plan_next_step(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted,
                    const GaitState<Lanes<float>>& state, StepPlan<Lanes<float>>& plan);

/// The same of a step's times, its footholds and whether it is settled alone: of a walker whom nobody sees, whose style
/// stays. The rest of `plan` means nothing then.
void time_first_step(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted,
                     StepPlan<Lanes<float>>& plan);
void time_next_step(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted,
                    const GaitState<Lanes<float>>& state, StepPlan<Lanes<float>>& plan);

/// A walker's clock counts in whole units, so that many ticks can be made up for at once: `time_s` is always a whole
/// number of them times `unit_s`, and so is a step's duration as the clock has it.
struct ClockUnits {
  std::int32_t per_tick;
  float unit_s;
  double per_s;

  /// The nearest whole number; of what no walker's clock shows, one that may be added to.
  std::int32_t of(float seconds) const {
    constexpr double most = 0x1p29;
    const double above = static_cast<double>(seconds) * per_s + 0.5;
    return static_cast<std::int32_t>(above < most ? (above > -most ? above : -most) : most);
  }
  float seconds(std::int32_t units) const { return static_cast<float>(units) * unit_s; }
  /// A step's duration, one unit at least.
  std::int32_t step(float duration_s) const { return std::max(of(duration_s), 1); }
};
/// 2¹⁵ a tick, or fewer where a step of 4 s would have more than 2²³, up to which a float tells units apart.
ClockUnits clock_units(float tick_s);

/// Moves each walker's clock on by tick_s, at most one step. At a heel strike the sides change and the line moves on to
/// the next foothold: of who goes straight on, to so many chords from the anchor.
void advance_gait(const StepPlan<Lanes<float>>& plan, GaitState<Lanes<float>>& state, float tick_s);

/// Bit l: lane l began a step in this tick that its plan does not describe yet.
std::uint32_t lanes_to_plan(const StepPlan<Lanes<float>>& plan, const Gait<Lanes<float>>& wanted,
                            const GaitState<Lanes<float>>& state, float tick_s);

/// Who began a step in this tick turns toward the wanted heading from the next foot on, by at most 30° a step and
/// 1.1 m/s² of acceleration sideways, for which that foot is put outward by z a / g: z the height of the centre of
/// mass, a its acceleration toward the inside (a pendulum's balance). Who stands turns by up to 30° a step on the spot,
/// or steps aside as planned. After the plan of the step.
void turn_gait(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan, const Gait<Lanes<float>>& wanted,
               GaitState<Lanes<float>>& state, float tick_s);

}  // namespace mobil::inline v0_3
