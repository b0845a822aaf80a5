#include "systems/people/walker_history.h"

#include <cmath>

#include "engine/exact_math.h"

namespace mobil::inline v0_3 {

std::optional<GaitState<float>> earlier(GaitState<float> state, const StepPlan<float>& plan, float seconds) {
  state.time_s -= seconds;
  if (state.time_s >= 0.0F) return state;
  const bool steady =
      plan.settled != 0 && plan.step_length_m > 0.0F && state.turn_before_rad == 0.0F && state.bend_per_m == 0.0F;
  if (!steady) return std::nullopt;
  state.time_s += plan.duration_s;
  state.stance_side ^= 1U;
  state.line_x_m -= plan.length_before_m * exact::sin(state.heading_rad);
  state.line_z_m -= plan.length_before_m * exact::cos(state.heading_rad);
  state.turn_rad = state.chord_rad = state.bend_next_per_m = 0.0F;
  state.shift_next_m = state.shift_m;
  state.shift_m = state.shift_before_m;  // the shift before that is too long ago to matter
  return state;
}

}  // namespace mobil::inline v0_3
