// From one heel strike to the next: sixteen steps solved side by side.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/gait/step_plan.cpp"
#include <hwy/foreach_target.h>

#include "systems/gait/feet-inl.h"
#include "systems/gait/gait.h"
#include "systems/gait/hips-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {

/// How far speed may change from step to step, and what a walk starts with and stops from, m/s at a leg of 0.90 m.
constexpr float most_faster = 0.45F, most_slower = 0.55F, first_speed = 0.80F, last_speed = 0.70F;

HWY_INLINE WideMask either(const WideMask& m, const Wide& yes, const Wide& no) {
  return select(m, yes, no) > 0.5F;
}

/// The steps toward the wanted gait: the strike at the end of this one.
HWY_NOINLINE void next_strike(const Wide& height, const Wide& mass, const Gait<Lanes<float>>& wanted,
                              const Strike<Lanes<float>>& from, const WideMask& fresh, const WideMask& right_lands,
                              Strike<Lanes<float>>& to) {
  const Wide leg = ratio(fraction::thigh + fraction::shank, height);
  const Wide scale = sqrt(leg / 0.90F);
  const Wide aim = load(wanted.speed_m_s), now = load(from.speed_m_s);
  const WideMask standing = now <= 0.0F, to_stand = aim <= 0.0F;
  const Wide slower = now - most_slower * scale, faster = now + most_faster * scale;
  const Wide stopping = select(now <= last_speed * scale, wide(0.0F), max(slower, last_speed * scale));
  const Wide walking = select(standing, min(aim, first_speed * scale), min(max(aim, slower), faster));
  StrikeRequest r;
  r.height = height;
  r.mass = mass;
  r.speed = select(fresh, aim, select(to_stand, stopping, walking));
  const Wide law = sqrt(0.24F * height * r.speed);
  const Wide length = load(wanted.step_length_m);
  const Wide scaled = length * sqrt(r.speed / max(aim, 1e-3F));
  r.step_length = select(to_stand, law, select(abs(r.speed - aim) < 1e-6F, length, scaled));
  const Wide uneven = load(wanted.style.step_asymmetry);
  r.length = r.step_length * (1.0F + select(right_lands, uneven, -uneven));
  const Wide cadence = 60.0F * r.speed / max(r.step_length, 1e-3F) * sqrt(height / 1.8F);
  r.double_support_cycle = double_support_of(cadence, load(wanted.style.double_support_scale));
  make_strike(r, wanted.style, to);
}

/// Whether all words of two components are the same, lane by lane.
template <class C>
HWY_INLINE WideMask same_words(const C& a, const C& b) {
  constexpr std::size_t words = sizeof(C) / sizeof(Lanes<float>);
  const auto* x = reinterpret_cast<const float*>(&a);
  const auto* y = reinterpret_cast<const float*>(&b);
  Wide off = wide(0.0F);
  for (std::size_t i = 0; i < words; ++i) off = max(off, abs(load(x + i * lane_count) - load(y + i * lane_count)));
  return off <= 0.0F;
}

HWY_INLINE void store_flags(const WideMask& mask, Lanes<std::uint32_t>& words) {
  Lanes<float> one;
  store(select(mask, wide(1.0F), wide(0.0F)), one);
  for (std::size_t l = 0; l < lane_count; ++l) words[l] = static_cast<std::uint32_t>(one[l]);
}

/// Solves the step from plan.from to plan.to.
HWY_NOINLINE void solve_step(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted,
                             const WideMask& right_lands, StepPlan<Lanes<float>>& plan) {
  const Strike<Lanes<float>>&from = plan.from, &to = plan.to;
  Step step;
  step.height = load(size.height_m);
  step.mass = load(size.mass_kg);
  step.leg = leg_size(step.height);
  step.style = &wanted.style;
  step.plan = &plan;
  step.from_stands = load(from.speed_m_s) <= 0.0F;
  step.to_stands = load(to.speed_m_s) <= 0.0F;
  const WideMask stays = step.from_stands & step.to_stands;
  const Wide pace_from = load(from.pace_hz), pace_to = load(to.pace_hz);
  const Wide uneven = load(wanted.style.time_asymmetry);
  const Wide even = select(step.from_stands | step.to_stands, 1.3F / max(max(pace_from, pace_to), 0.1F),
                           2.0F / max(pace_from + pace_to, 0.1F));
  step.duration = select(stays, wide(0.25F), even * (1.0F + select(right_lands, uneven, -uneven)));
  step.rate_from = pace_from * step.duration;
  step.rate_to = pace_to * step.duration;
  const Wide part =
      select(step.from_stands, select(step.to_stands, wide(1.0F), wide(0.45F)), load(from.double_support));
  step.double_support = part * step.duration;
  step.flat = min(select(step.from_stands, wide(0.1F), load(from.flat) / max(pace_from, 0.1F)), 0.6F * step.duration);
  step.support = footing(load(from.half_width_m), load(from.toe_out));
  step.trailing = footing(load(plan.trailing_half_width_m), load(plan.trailing_toe_out));
  step.landing = footing(load(to.half_width_m), load(to.toe_out));
  store(step.duration, plan.duration_s);
  store(step.double_support, plan.double_support_s);
  store(step.flat, plan.flat_s);
  store(select(stays, wide(0.5F), wide(1.0F)), plan.load_to);
  store(load(to.length_m), plan.step_length_m);
  store(load(from.length_m), plan.length_before_m);
  store(step.rate_from, plan.phase_rate_from);
  store(step.rate_to, plan.phase_rate_to);

  WideMask held = plan_support(step);
  const Pitch toe_off = plan_standing_feet(step);
  held = held | plan_swing(step, toe_off);
  store_flags(held & either(stays, wide(0.0F), wide(1.0F)), plan.clamped);

  const Wide load_from = load(plan.load_from);
  const WideMask even_load = either(stays, select(load_from >= 0.5F, wide(1.0F), wide(0.0F)), wide(1.0F));
  const WideMask even_steps = (abs(load(wanted.style.step_asymmetry)) + abs(uneven)) <= 0.0F;
  const WideMask there = abs(load(to.speed_m_s) - load(wanted.speed_m_s)) <= 0.0F;
  const WideMask same_feet = (abs(load(plan.trailing_half_width_m) - load(from.half_width_m)) +
                              abs(load(plan.trailing_toe_out) - load(from.toe_out))) <= 0.0F;
  store_flags(same_words(from, to) & (even_load & even_steps) & (there & same_feet), plan.settled);
  plan.revision = wanted.revision;
}

void first_block(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted, StepPlan<Lanes<float>>& plan) {
  const Wide zero = wide(0.0F), one = wide(1.0F);
  const WideMask all = one > zero, left_lands = zero > one;
  store(load(wanted.speed_m_s), plan.from.speed_m_s);
  next_strike(load(size.height_m), load(size.mass_kg), wanted, plan.from, all, all, plan.from);
  next_strike(load(size.height_m), load(size.mass_kg), wanted, plan.from, all, left_lands, plan.to);
  plan.trailing_half_width_m = plan.from.half_width_m;
  plan.trailing_toe_out = plan.from.toe_out;
  store(select(load(wanted.speed_m_s) <= 0.0F, wide(0.5F), zero), plan.load_from);
  solve_step(size, wanted, left_lands, plan);
}

void next_block(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted,
                const GaitState<Lanes<float>>& state, StepPlan<Lanes<float>>& plan) {
  const Wide zero = wide(0.0F), one = wide(1.0F);
  const WideMask right_lands = equal(state.stance_side, left), fresh = zero > one;
  const WideMask stood = (load(plan.from.speed_m_s) <= 0.0F) & (load(plan.to.speed_m_s) <= 0.0F);
  store(select(stood, wide(0.5F), zero), plan.load_from);
  const WideMask sides_change =
      (load(plan.step_length_m) + load(plan.length_before_m)) > 0.0F;  // as advance_gait has it
  auto keep = [](const WideMask& where, const Lanes<float>& kept, Lanes<float>& value) {
    store(select(where, load(kept), load(value)), value);
  };
  keep(sides_change, plan.from.half_width_m, plan.trailing_half_width_m);
  keep(sides_change, plan.from.toe_out, plan.trailing_toe_out);
  plan.from = plan.to;
  next_strike(load(size.height_m), load(size.mass_kg), wanted, plan.from, fresh, right_lands, plan.to);
  const WideMask stays = (load(plan.from.speed_m_s) <= 0.0F) & (load(plan.to.speed_m_s) <= 0.0F);
  keep(stays, plan.from.half_width_m, plan.to.half_width_m);  // feet that stand stay where they are
  keep(stays, plan.from.toe_out, plan.to.toe_out);
  solve_step(size, wanted, right_lands, plan);
}

}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil {

HWY_EXPORT(first_block);
HWY_EXPORT(next_block);

void plan_first_step(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted,
                     StepPlan<Lanes<float>>& plan) {
  HWY_DYNAMIC_DISPATCH(first_block)(size, wanted, plan);
}

void plan_next_step(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted,
                    const GaitState<Lanes<float>>& state, StepPlan<Lanes<float>>& plan) {
  HWY_DYNAMIC_DISPATCH(next_block)(size, wanted, state, plan);
}

}  // namespace mobil
#endif
