#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/gait/gait_advance.cpp"
#include <hwy/foreach_target.h>

#include "engine/wide-inl.h"
#include "systems/gait/gait.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {

constexpr float pi_f = 3.14159265F;
constexpr float most_turn = 20.0F * pi_f / 180.0F;  // a step

/// How much of the way to the wanted heading the line turns along a step of this length.
HWY_INLINE Wide next_turn(const Wide& heading, const Wide& wanted, const Wide& step_length) {
  const Wide off = wanted - heading;
  const Wide way = off - (2.0F * pi_f) * floor(off * (0.5F / pi_f) + 0.5F);
  return select(step_length > 0.0F, clamp(way, -most_turn, most_turn), wide(0.0F));
}

void advance_block(const StepPlan<Lanes<float>>& plan, GaitState<Lanes<float>>& state, float tick_s) {
  const Wide step = load(plan.duration_s), length = load(plan.step_length_m);
  const Wide time = load(state.time_s) + tick_s;
  const WideMask done = time >= step;
  const Wide zero = wide(0.0F), one = wide(1.0F);
  const WideMask walked = (length + load(plan.length_before_m)) > 0.0F;
  // Below a tick whatever the rounding: that is how the systems that follow know a step that has just begun.
  store(select(done, clamp(time - step, 0.0F, tick_s * 0.999999F), time), state.time_s);

  const Wide turn = load(state.turn_rad), before = load(state.turn_before_rad), heading = load(state.heading_rad);
  Wide s, c;
  sin_cos(heading + 0.5F * turn, s, c);
  const Wide along = select(done, length, zero);
  store(fma(along, s, load(state.line_x_m)), state.line_x_m);
  store(fma(along, c, load(state.line_z_m)), state.line_z_m);
  const Wide ahead = heading + turn;
  store(select(done, ahead, heading), state.heading_rad);
  store(select(done, turn, before), state.turn_before_rad);
  store(select(done, zero, turn), state.turn_rad);

  Lanes<float> steps;
  store(select(done & walked, one, zero), steps);
  for (std::size_t l = 0; l < lane_count; ++l) {
    const auto n = static_cast<std::uint32_t>(steps[l]);
    state.steps[l] += n;
    state.stance_side[l] ^= n;
  }
}

std::uint32_t to_plan_block(const StepPlan<Lanes<float>>& plan, const Gait<Lanes<float>>& wanted,
                            const GaitState<Lanes<float>>& state, float tick_s) {
  Lanes<float> begun;
  store(select(load(state.time_s) < tick_s, wide(1.0F), wide(0.0F)), begun);
  std::uint32_t bits = 0;
  for (std::size_t l = 0; l < lane_count; ++l) {
    const bool changed = plan.settled[l] == 0 || plan.revision[l] != wanted.revision[l];
    bits |= static_cast<std::uint32_t>(begun[l] > 0.0F && changed) << l;
  }
  return bits;
}

void turn_block(const StepPlan<Lanes<float>>& plan, const Gait<Lanes<float>>& wanted, GaitState<Lanes<float>>& state,
                float tick_s) {
  const WideMask begun = load(state.time_s) < tick_s;
  const Wide turn = next_turn(load(state.heading_rad), load(wanted.heading_rad), load(plan.step_length_m));
  store(select(begun, turn, load(state.turn_rad)), state.turn_rad);
}

}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil {

HWY_EXPORT(advance_block);
HWY_EXPORT(to_plan_block);
HWY_EXPORT(turn_block);

void advance_gait(const StepPlan<Lanes<float>>& plan, GaitState<Lanes<float>>& state, float tick_s) {
  HWY_DYNAMIC_DISPATCH(advance_block)(plan, state, tick_s);
}

std::uint32_t lanes_to_plan(const StepPlan<Lanes<float>>& plan, const Gait<Lanes<float>>& wanted,
                            const GaitState<Lanes<float>>& state, float tick_s) {
  return HWY_DYNAMIC_DISPATCH(to_plan_block)(plan, wanted, state, tick_s);
}

void turn_gait(const StepPlan<Lanes<float>>& plan, const Gait<Lanes<float>>& wanted, GaitState<Lanes<float>>& state,
               float tick_s) {
  HWY_DYNAMIC_DISPATCH(turn_block)(plan, wanted, state, tick_s);
}

}  // namespace mobil
#endif
