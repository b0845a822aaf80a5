#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "assets/gait/walking_line-inl.h"
#include "engine/wide-inl.h"
#include "systems/gait/gait.h"
#include "systems/gait/heading-inl.h"
#include "systems/gait/next_foot-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

/// Moves the line of walkers who have come to rest by the lateral shift of their feet.
HWY_INLINE void come_to_rest(const StepPlan<Lanes<float>>& plan, const WideMask& done, GaitState<Lanes<float>>& state) {
  const Wide shift = load(state.shift_m), zero = wide(0.0F);
  const WideMask rests = done & stands(plan.to) & (abs(shift - load(state.shift_before_m)) <= 0.0F);
  Wide s, c;
  sin_cos(load(state.heading_rad), s, c);
  const Wide x = load(state.line_x_m), z = load(state.line_z_m);
  store(select(rests, fma(shift, c, x), x), state.line_x_m);
  store(select(rests, fnma(shift, s, z), z), state.line_z_m);
  for (Lanes<float>* moved : {&state.shift_m, &state.shift_before_m, &state.shift_next_m})
    store(select(rests, zero, load(*moved)), *moved);
}

/// Returns the walkers whose step ends. The rest of their tick is limited to less than one tick, from which later
/// systems recognise a step that has just begun.
HWY_INLINE WideMask advance_clock(const ClockUnits& units, const StepPlan<Lanes<float>>& plan,
                                  GaitState<Lanes<float>>& state) {
  Lanes<float> done;
  const std::int32_t most = std::max(units.per_tick - 1, 0);
  for (std::size_t l = 0; l < lane_count; ++l) {
    const std::int32_t time = units.of(state.time_s[l]) + units.per_tick;
    const std::int32_t over = time - units.step(plan.duration_s[l]);
    done[l] = over >= 0 ? 1.0F : 0.0F;
    state.time_s[l] = units.seconds(over >= 0 ? std::min(over, most) : time);
  }
  return load(done) > 0.0F;
}

HWY_INLINE WideMask without(const WideMask& mask) {
  return select(mask, wide(0.0F), wide(1.0F)) > 0.0F;
}

/// A straight walker's line point is anchor + steps × chord. Other walkers advance one chord and reset the anchor.
HWY_INLINE void move_line(const StepPlan<Lanes<float>>& plan, const WideMask& done, const WideMask& straight,
                          const Wide& ahead_x, const Wide& ahead_z, GaitState<Lanes<float>>& state) {
  Lanes<float> chords;
  for (std::size_t l = 0; l < lane_count; ++l) chords[l] = static_cast<float>(state.steps[l] - state.anchor_steps[l]);
  const WideMask bends = done & without(straight);
  auto move = [&](const Wide& ahead, Lanes<float>& line, Lanes<float>& anchor) {
    const Wide on = fma(load(chords), ahead, load(anchor));
    store(select(straight, on, select(bends, load(line) + ahead, load(line))), line);
  };
  move(ahead_x, state.line_x_m, state.anchor_x_m);
  move(ahead_z, state.line_z_m, state.anchor_z_m);
  come_to_rest(plan, done, state);
  store(select(bends, load(state.line_x_m), load(state.anchor_x_m)), state.anchor_x_m);
  store(select(bends, load(state.line_z_m), load(state.anchor_z_m)), state.anchor_z_m);
  Lanes<float> begins;
  store(select(bends, wide(1.0F), wide(0.0F)), begins);
  for (std::size_t l = 0; l < lane_count; ++l)
    state.anchor_steps[l] = begins[l] > 0.0F ? state.steps[l] : state.anchor_steps[l];
}

void advance_block(const StepPlan<Lanes<float>>& plan, GaitState<Lanes<float>>& state, float tick_s) {
  const WideMask done = advance_clock(clock_units(tick_s), plan, state);
  if (!any(done)) return;  // within a step only the time changes
  const Wide zero = wide(0.0F), one = wide(1.0F), length = load(plan.step_length_m);
  const WideMask walked = load(plan.landing) > 0.0F;

  const Wide turn = load(state.turn_rad), heading = load(state.heading_rad), chord = load(state.chord_rad);
  Wide s, c;
  sin_cos(heading + chord, s, c);
  const Wide bent = max(max(abs(turn), abs(chord)), abs(load(state.shift_m)));
  const WideMask straight = done & equal(plan.settled, 1) & (bent <= 0.0F);
  auto moves_on = [&](const Wide& value, Lanes<float>& to) { store(select(done, value, load(to)), to); };
  moves_on(heading + turn, state.heading_rad);
  moves_on(turn, state.turn_before_rad);
  moves_on(chord - turn, state.chord_before_rad);
  moves_on(zero, state.turn_rad);
  moves_on(zero, state.chord_rad);
  moves_on(load(state.bend_per_m), state.bend_before_per_m);
  moves_on(load(state.bend_next_per_m), state.bend_per_m);

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
  move_line(plan, done, straight, length * s, length * c, state);
}

std::uint32_t to_plan_block(const StepPlan<Lanes<float>>& plan, const Gait<Lanes<float>>& wanted,
                            const GaitState<Lanes<float>>& state, float tick_s) {
  Lanes<float> begun, turns;
  const WideMask begins = load(state.time_s) < tick_s;
  if (!any(begins)) return 0;
  store(select(begins, wide(1.0F), wide(0.0F)), begun);
  const Wide way = shorter_way(load(state.heading_rad), load(wanted.heading_rad));
  const Wide turns_from = select(stands_still(plan), wide(off_heading), wide(own_turn_rad));
  const WideMask is_off = begins & (abs(way) > turns_from);
  Wide otherwise = wide(0.0F);
  if (any(is_off)) otherwise = select(load(wanted.speed_m_s) <= 0.0F, wide(1.0F), off_usual(wanted.style));
  store(select(is_off, otherwise, wide(0.0F)), turns);
  std::uint32_t bits = 0;
  for (std::size_t l = 0; l < lane_count; ++l) {
    if (!(begun[l] > 0.0F)) continue;
    const bool changed = plan.settled[l] == 0 || plan.revision[l] != wanted.revision[l] || turns[l] > 0.0F;
    bits |= static_cast<std::uint32_t>(changed) << l;
  }
  return bits;
}

/// Swaps the stance foot of feet side by side, where either foot can be the stance foot.
void swap_feet(const StepPlan<Lanes<float>>& plan, GaitState<Lanes<float>>& state, float tick_s) {
  for (std::size_t l = 0; l < lane_count; ++l) {
    if (plan.swaps[l] == 0 || !(state.time_s[l] < tick_s)) continue;
    state.stance_side[l] ^= 1U;
    std::swap(state.shift_m[l], state.shift_before_m[l]);
  }
}

void turn_block(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                const Gait<Lanes<float>>& wanted, GaitState<Lanes<float>>& state, float tick_s) {
  const WideMask begun = load(state.time_s) < tick_s;
  if (!any(begun)) return;
  swap_feet(plan, state, tick_s);
  const WideMask steps = load(plan.landing) > 0.0F;
  const Wide way = shorter_way(load(state.heading_rad), load(wanted.heading_rad));
  const NextFoot next =
      next_foot({load(size.leg_scale_m), load(plan.step_length_m), load(plan.to.speed_m_s),
                 load(plan.from.half_width_m) + load(plan.to.half_width_m), load(state.bend_per_m), load(state.shift_m),
                 select(equal(state.stance_side, Side::right), wide(1.0F), wide(-1.0F))},
                way);
  const Wide length = load(plan.step_length_m), bend = load(state.bend_per_m);
  const Chord chord = {length, bend * length, (next.bend - bend) * length};
  const Wide moves = length + load(plan.length_before_m), slant = load(plan.slant_rad);
  const WideMask on_spot = steps_on_spot(plan) & (abs(way) > off_heading) & (moves <= 0.0F);
  const Wide on_the_spot = select(on_spot, min(max(way, -step_limits::max_turn), step_limits::max_turn), wide(0.0F));
  auto begin = [&](const Wide& value, Lanes<float>& to) { store(select(begun, value + 0.0F, load(to)), to); };  // no −0
  begin(select(length > 0.0F, chord_turn(chord), on_the_spot), state.turn_rad);
  begin(chord_heading(chord) + slant, state.chord_rad);
  // A person who stood has no previous chord.
  begin(select(load(plan.length_before_m) > 0.0F, load(state.chord_before_rad), load(state.chord_rad)),
        state.chord_before_rad);
  begin(next.bend, state.bend_next_per_m);
  begin(select(steps, next.shift, load(state.shift_before_m)), state.shift_next_m);
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {

ClockUnits clock_units(float tick_s) {
  constexpr int most = 15;
  constexpr float longest_step_s = 4;
  if (!(tick_s > 0)) return {0, 0x1p-20F, 0x1p20};
  const int fits = std::ilogb(0x1p23F * tick_s / longest_step_s), bits = std::clamp(fits, 0, most);
  const float unit_s = std::ldexp(tick_s, -bits);
  return {1 << bits, unit_s, 1.0 / static_cast<double>(unit_s)};
}

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

}  // namespace mobil::inline v0_3
#endif
