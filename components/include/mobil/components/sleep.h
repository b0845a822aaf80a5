#pragma once
// Walkers who are asleep: nobody is near enough to see them, and where they are follows at once from a few words.

#include <cstddef>
#include <cstdint>

#include <mobil/components/gait_style.h>
#include <mobil/components/lanes.h>

namespace mobil::inline v0_3 {

/// A walk straight on at one pace, or standing. GaitState of any later tick follows from it in closed form, to the bit.
/// `clock`, in units of the walker's clock (systems/gait/gait.h): how far into a stride of two such steps tick 0 was,
/// right stance first; who stands: into a step, plus a step's units where the left foot is the stance foot. `steps`:
/// taken at tick 0, modulo 2³². `anchor`: where the straight line began, and with which step. `requests`:
/// Gait::revision and, from bit 16 on, Gait::displacement.
template <class F>
struct SteadyWalk {
  UInt32<F> clock, step_units, steps, anchor_steps;
  F anchor_x_m, anchor_z_m, heading_rad;
  F asked_heading_rad, speed_m_s, step_length_m;  // what is asked, with the last word
  UInt32<F> requests;
};

/// A sleeper: the walk and the body. With SleepingStyle or OwnStyle it is all that a walker's row follows from.
template <class F>
struct Asleep {
  SteadyWalk<F> walk;
  F height_m, mass_kg, extra_fat;  // BodySize
  F endo, meso, ecto;              // Physique
  UInt32<F> build;
};

/// A style on the grid (`snapped`): a byte a parameter, four to a word.
template <class F>
struct SleepingStyle {
  UInt32<F> bytes[(gait_parameters.size() + 3) / 4];
};
/// One that is not: four times as large.
template <class F>
struct OwnStyle {
  GaitStyleOf<F> style;
};

/// Beside Asleep while a sleeper turns, stops or changes speed: the walk before, the tick at which that was asked, and
/// the tick from which on Asleep::walk holds; 0 until that is worked out, in the next tick.
template <class F>
struct Unsettled {
  SteadyWalk<F> before;
  UInt32<F> asked_tick, until_tick;
};
/// Of who does not walk steadily within some steps: they are to be woken.
inline constexpr std::uint32_t never_settles = 0xFFFFFFFF;

/// Tags of a sleeper's table: ground reaction and joint moments are there again on waking; level of detail still
/// chooses muscles then; steps are watched again; fat wobbles again, from rest.
struct SleepsWithForces {};
struct SleepsManaged {};
struct SleepsWithStepEvents {
  static constexpr std::uint64_t stable_id = 0xf10c8cc55fc2d74e;
};
struct SleepsWithFat {};

/// The nearest style of those that take least memory asleep: each parameter a whole number of 254ths of its range away
/// from its default (systems/gait/asleep.cpp).
GaitStyle snapped(const GaitStyle& style);

}  // namespace mobil::inline v0_3
