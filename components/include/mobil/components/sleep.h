#pragma once
// State of walkers who are asleep: unseen, without pose or muscles. Their position at any tick follows in closed form.

#include <cstddef>
#include <cstdint>

#include <mobil/components/gait.h>
#include <mobil/components/lanes.h>

namespace mobil::inline v0_3 {

/// A straight walk at one pace, or standing. GaitState of any later tick follows from it in closed form, to the bit.
/// `clock`: time at tick 0 since the start of a stride of two such steps, right stance first, in units of the walker's
/// clock (systems/gait/gait.h). Standing: since the start of a step, plus one step for left stance. `steps`: steps
/// taken at tick 0, modulo 2³². `anchor`: start of the straight line and its step. `requests`: Gait::revision and, from
/// bit 16 on, Gait::displacement.
template <class F>
struct SteadyWalk {
  UInt32<F> clock, step_units, steps, anchor_steps;
  F anchor_x_m, anchor_z_m, heading_rad;
  F asked_heading_rad, speed_m_s, step_length_m;  // the requested walk, with `requests`
  UInt32<F> requests;
};

/// A sleeper's walk and body. A walker's row is computed from it and SleepingStyle or OwnStyle.
template <class F>
struct Asleep {
  SteadyWalk<F> walk;
  F height_m, mass_kg, fat_share;  // BodySize
  F endo, meso, ecto;              // Physique
  UInt32<F> build;
};

/// A style on the grid (`snapped`), one byte a parameter, four to a word.
template <class F>
struct SleepingStyle {
  UInt32<F> bytes[(gait_parameters.size() + 3) / 4];
};
/// A style that is not on the grid, 4 times as large.
template <class F>
struct OwnStyle {
  GaitStyleOf<F> style;
};

/// Stored with Asleep while a sleeper turns, stops or changes speed: the previous walk, the tick of the request, and
/// the first tick at which Asleep::walk holds. `until_tick` is 0 until the next tick computes it.
template <class F>
struct Unsettled {
  SteadyWalk<F> before;
  UInt32<F> asked_tick, until_tick;
};
/// Unsettled::until_tick of a sleeper that reaches no steady walk within some steps, and must be woken.
inline constexpr std::uint32_t never_settles = 0xFFFFFFFF;

/// Tags of a sleeper's table. On waking, the person regains ground reaction and joint moments, level of detail, step
/// events, or wobbling fat (from rest).
struct SleepsWithForces {};
struct SleepsManaged {};
struct SleepsWithStepEvents {
  static constexpr std::uint64_t stable_id = 0xf10c8cc55fc2d74e;
};
struct SleepsWithFat {};

/// Returns the nearest style of those that need minimal memory asleep. Each parameter is an integer multiple of 1/254
/// of its range away from its default (systems/gait/asleep.cpp).
GaitStyle snapped(const GaitStyle& style);

}  // namespace mobil::inline v0_3
