#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/gait/gait_advance.cpp"
#include <hwy/foreach_target.h>

#include "engine/wide-inl.h"
#include "systems/gait/gait.h"
#include "systems/gait/heading-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {

constexpr float most_turn = 30.0F * pi_f / 180.0F;  // a step
/// Sideways, m/s²: the most, and by how much more or less from one step to the next, which soles can make up for.
constexpr float most_sideways = 1.1F, most_change = 0.6F;
constexpr float centre_over_gravity = 0.56F / 9.81F;  // height of the centre of mass, of the height; s²/m
/// How near a foot may come to the other's line when it is put to the inside, of the distance in a straight walk; how
/// far it may go to the outside, of the height.
constexpr float nearest = 0.4F, farthest = 0.08F;

/// How much of the way to the wanted heading the line turns along a step: not more than the step after it can undo.
HWY_INLINE Wide next_turn(const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state,
                          const Wide& wanted) {
  const Wide before = load(state.turn_before_rad);
  const Wide way = shorter_way(load(state.heading_rad), wanted), far = abs(way);
  const Wide per_sideways = load(plan.duration_s) / max(load(plan.to.speed_m_s), 0.1F);
  const Wide most = min(most_sideways * per_sideways, most_turn), change = most_change * per_sideways;
  const Wide wished = copy_sign(min(select(far <= change, far, 0.5F * (far + change)), most), way);
  const Wide turn = min(max(wished, before - change), before + change);
  const WideMask on_spot = steps_on_spot(plan) & (far > off_heading);
  const Wide on_the_spot = select(on_spot, min(max(way, -most_turn), most_turn), wide(0.0F));
  return select(load(plan.step_length_m) > 0.0F, min(max(turn, -most), most), on_the_spot);
}

/// Where the next foot is put beside its place on the line, to the left.
HWY_INLINE Wide next_shift(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                           const GaitState<Lanes<float>>& state, const Wide& turn) {
  const Wide height = load(size.height_m);
  const Wide inward = load(plan.to.speed_m_s) * turn / load(plan.duration_s);
  const Wide apart = load(plan.from.half_width_m) + load(plan.to.half_width_m);
  const Wide lands_left = select(equal(state.stance_side, right), wide(1.0F), wide(-1.0F));
  // Seen outward from the stance foot to the one that lands.
  const Wide outward = lands_left * (-centre_over_gravity * height * inward - load(state.shift_m));
  const Wide kept = min(max(outward, (nearest - 1.0F) * apart), farthest * height);
  return fma(lands_left, kept, load(state.shift_m));
}

void advance_block(const StepPlan<Lanes<float>>& plan, GaitState<Lanes<float>>& state, float tick_s) {
  const Wide step = load(plan.duration_s), length = load(plan.step_length_m);
  const Wide time = load(state.time_s) + tick_s;
  const WideMask done = time >= step;
  const Wide zero = wide(0.0F), one = wide(1.0F);
  const WideMask walked = load(plan.landing) > 0.0F;
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

  const WideMask lands = done & walked;
  const Wide shift = load(state.shift_m);
  store(select(lands, shift, load(state.shift_before_m)), state.shift_before_m);
  store(select(lands, load(state.shift_next_m), shift), state.shift_m);
  Lanes<float> steps;
  store(select(lands, one, zero), steps);
  for (std::size_t l = 0; l < lane_count; ++l) {
    const auto n = static_cast<std::uint32_t>(steps[l]);
    state.steps[l] += n;
    state.stance_side[l] ^= n;
  }
}

std::uint32_t to_plan_block(const StepPlan<Lanes<float>>& plan, const Gait<Lanes<float>>& wanted,
                            const GaitState<Lanes<float>>& state, float tick_s) {
  Lanes<float> begun, turns;
  store(select(load(state.time_s) < tick_s, wide(1.0F), wide(0.0F)), begun);
  const Wide way = shorter_way(load(state.heading_rad), load(wanted.heading_rad));
  store(select(stands_still(plan) & (abs(way) > off_heading), wide(1.0F), wide(0.0F)), turns);
  std::uint32_t bits = 0;
  for (std::size_t l = 0; l < lane_count; ++l) {
    const bool changed = plan.settled[l] == 0 || plan.revision[l] != wanted.revision[l] || turns[l] > 0.0F;
    bits |= static_cast<std::uint32_t>(begun[l] > 0.0F && changed) << l;
  }
  return bits;
}

void turn_block(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                const Gait<Lanes<float>>& wanted, GaitState<Lanes<float>>& state, float tick_s) {
  const WideMask begun = load(state.time_s) < tick_s;
  const Wide turn = next_turn(plan, state, load(wanted.heading_rad));
  store(select(begun, turn, load(state.turn_rad)), state.turn_rad);
  const WideMask walks = load(plan.landing) > 0.0F;
  const Wide shift = select(walks, next_shift(size, plan, state, turn), load(state.shift_before_m));
  store(select(begun, shift, load(state.shift_next_m)), state.shift_next_m);
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

void turn_gait(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan, const Gait<Lanes<float>>& wanted,
               GaitState<Lanes<float>>& state, float tick_s) {
  HWY_DYNAMIC_DISPATCH(turn_block)(size, plan, wanted, state, tick_s);
}

}  // namespace mobil
#endif
