// Steps from one heel strike to the next, solved for sixteen walkers at once.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include <cmath>
#include <utility>

#include "engine/exact_math.h"
#include "systems/gait/balance-inl.h"
#include "systems/gait/forward_swing-inl.h"
#include "systems/gait/gait.h"
#include "systems/gait/heading-inl.h"
#include "systems/gait/step_limits.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

using namespace step_limits;

/// Phases: toe-off of a first step, landing of a last step, and both for a step on the spot.
constexpr float first_double_support = 0.45F, last_landing = 0.85F;
constexpr float spot_double_support = 0.05F, spot_landing = 0.95F;
/// Depth to which the hips sink between the two parts of a step aside, over that needed by straight legs.
constexpr float sinks_apart = 2.0F;
/// Distance of the centre of pressure outside the soles from which a step is marked, of the height.
constexpr float max_astray = 0.04F;

HWY_INLINE WideMask either(const WideMask& m, const Wide& yes, const Wide& no) {
  return select(m, yes, no) > 0.5F;
}

/// Returns the usual step length at a speed.
HWY_NOINLINE Wide usual_length(const Wide& height, const Wide& speed) {
  const Wide leg = ratio(fraction::hip_height, height);
  Lanes<float> of;
  store(speed / sqrt(gravity_f * leg), of);
  for (float& lane : of.lane) lane = static_cast<float>(usual_step_length(lane));
  return load(of) * leg;
}

/// Returns true if a person has put one foot aside but not the other, which has priority over all requests.
HWY_INLINE WideMask half_aside(const HeelStrike<Lanes<float>>& from) {
  return stands(from) & (load(from.length_m) > 0.0F);
}

/// Parts of a step to solve: all of it, or only times and footholds.
enum class Solve { whole, times };

/// Turn from which a strike has only the usual style (up to own_turn_rad it has its own), and the two limits for
/// changes of speed, m/s for a leg of leg_m. A continuing walk changes speed by at most 0.6 per step, which keeps a
/// third of the own style.
constexpr float calm_turn_rad = 0.5F, calm_change = 0.9F, own_change = 0.05F;

/// Mixes a style with the usual one, so that joints have room for a step that turns or changes speed. `own` is the
/// weight of the own style, 0 to 1. Returns `own`, or 1 if the own style is the usual one.
HWY_NOINLINE Wide calm_style(const Wide& own, const GaitStyleOf<Lanes<float>>& style, GaitStyleOf<Lanes<float>>& calm) {
  constexpr GaitStyle usual;
  const auto* const from = reinterpret_cast<const float*>(&style);
  const auto* const there = reinterpret_cast<const float*>(&usual);
  auto* const to = reinterpret_cast<float*>(&calm);
  for (std::size_t p = 0; p < style_numbers; ++p) {
    const Wide number = load(from + p * lane_count);
    store(select(own < 1.0F, fma(own, number - there[p], wide(there[p])), number), to + p * lane_count);
  }
  return select(off_usual(style) > 0.0F, own, wide(1.0F));
}

/// Computes the strike at the end of this step toward the wanted gait. `turn` is the turn left at its beginning.
HWY_NOINLINE void next_strike(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted, const Wide& turn,
                              const HeelStrike<Lanes<float>>& from, const WideMask& fresh, const WideMask& right_lands,
                              Solve solve, HeelStrike<Lanes<float>>& to) {
  const Wide height = load(size.leg_scale_m), leg = ratio(fraction::thigh + fraction::shank, height);
  const Wide scale = sqrt(leg / leg_m);
  const Wide now = load(from.speed_m_s), aim = select(half_aside(from), wide(0.0F), load(wanted.speed_m_s));
  const WideMask standing = now <= 0.0F, to_stand = aim <= 0.0F;
  const Wide slower = now - max_slower * scale, faster = now + max_faster * scale;
  const Wide stopping = select(now <= last_speed * scale, wide(0.0F), max(slower, last_speed * scale));
  const Wide walking = select(standing, min(aim, first_speed * scale), min(max(aim, slower), faster));
  StrikeRequest r;
  r.height = height;
  r.mass = load(size.mass_kg);
  r.stature = load(size.height_m);
  r.stoop = load(size.stoop_rad);
  r.woman = load(size.woman);
  r.child = load(size.child);
  r.speed = select(fresh, aim, select(to_stand, stopping, walking));
  const Wide length = load(wanted.step_length_m), usual = usual_length(height, r.speed);
  const Wide scaled = length * usual / usual_length(height, aim);
  r.step_length = select(to_stand, usual, select(abs(r.speed - aim) < 1e-6F, length, scaled));
  const Wide change = select(fresh | to_stand, wide(0.0F), abs(r.speed - now) / scale);
  const auto own_part = [](const Wide& of, float own, float calm) {
    return clamp((calm - of) * (1 / (calm - own)), 0.0F, 1.0F);
  };
  GaitStyleOf<Lanes<float>> style;
  const Wide own =
      calm_style(min(own_part(abs(turn), own_turn_rad, calm_turn_rad), own_part(change, own_change, calm_change)),
                 wanted.style, style);
  const Wide uneven = load(style.step_asymmetry), late = load(style.time_asymmetry);
  r.length = r.step_length * (1.0F + select(right_lands, uneven, -uneven));
  r.slower = select(right_lands, late, -late);
  solve == Solve::whole ? make_strike(r, style, to) : time_strike(r, style, to);
  store(own, to.own_style);
}

/// Returns the lanes in which all words of two components are equal.
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

/// Plans the path of the other foot through the air.
HWY_NOINLINE void plan_swing(const Wide& height, StepPlan<Lanes<float>>& plan) {
  const OneShape to{plan.to.shape};
  const LeavingShape from(plan);
  const Wide off = load(plan.double_support), part = 0.5F * (load(plan.landing) - off);  // of the cycle
  // Pitch at toe-off and at landing, as functions of the part of the swing.
  const Wide rising = 2.0F * part / max(off - from.begins(), 1e-3F);
  Moving leaving = {wide(0.0F), wide(0.0F), wide(0.0F)};
  for (std::size_t i = 0; i < step_shape::rise.count; ++i) {
    const auto k = static_cast<float>(i + 3);
    const Wide v = from(step_shape::rise, i);
    leaving = {leaving.value - v, leaving.rate - k * v, leaving.bend - (k * (k - 1)) * v};
  }
  leaving = {leaving.value, leaving.rate * rising, leaving.bend * rising * rising};
  auto start = [&](const ShapePart& p, const Wide& span) {
    const Wide per = part / span;
    return Moving{to(p, 0), to(p, 1) * per, (2.0F * to(p, 2) - 6.0F * to(p, 1)) * per * per};
  };
  const Moving landing = start(step_shape::strike, usual_flat + to(step_shape::times, 0));
  const Moving pad_up = start(step_shape::pad_up, wide(pad_part)),
               pad_on = start(step_shape::pad_forward, wide(pad_part));
  auto moved = [](const Moving& by_pitch, const Moving& pitch) {
    return Moving{by_pitch.value, by_pitch.rate * pitch.rate,
                  fma(by_pitch.bend, pitch.rate * pitch.rate, by_pitch.rate * pitch.bend)};
  };
  auto plus = [](const Moving& a, const Moving& b) {
    return Moving{a.value + b.value, a.rate + b.rate, a.bend + b.bend};
  };
  auto scaled = [](const Moving& a, const Wide& by, const Wide& from_there) {
    return Moving{fma(a.value, by, from_there), a.rate * by, a.bend * by};
  };
  const PlantedAnkle off_ankle = planted_ankle(height, leaving.value), on_ankle = planted_ankle(height, landing.value);
  const Moving off_along = moved(off_ankle.along, leaving);
  const Moving on_along = plus(moved(on_ankle.along, landing), pad_on);
  Wide off_s, off_c, on_s, on_c;
  sin_cos(load(plan.trailing_toe_out), off_s, off_c);
  sin_cos(load(plan.to.toe_out), on_s, on_c);
  store_quintic(leaving, landing, plan.swing_pitch);
  store_quintic(moved(off_ankle.up, leaving), plus(moved(on_ankle.up, landing), pad_up), plan.swing_up_m);
  store_quintic(scaled(off_along, off_c, -load(plan.length_before_m)), scaled(on_along, on_c, load(plan.step_length_m)),
                plan.swing_forward_m);
  store_quintic(scaled(off_along, off_s, load(plan.trailing_half_width_m)),
                scaled(on_along, on_s, load(plan.to.half_width_m)), plan.swing_out_m);
}

/// Minimum height of a foot in the air, of the height, times 64 u³ (1 − u)³ of the swing; maximum lift for it.
constexpr float least_clearance = 0.003F, max_lift = 0.01F;

/// Lifts the swing where curves mixed of two strikes would lead the foot too near to the ground.
HWY_NOINLINE void clear_ground(const Wide& height, StepPlan<Lanes<float>>& plan) {
  const Wide off = load(plan.double_support), landing = load(plan.landing);
  Wide lift = wide(0.0F);
  for (const float u : {0.2F, 0.3F, 0.4F, 0.5F, 0.6F, 0.7F, 0.8F}) {
    const float high = 64 * (u * (1 - u)) * (u * (1 - u)) * (u * (1 - u));
    const Wide phase = fma(landing - off, wide(u), off);
    const MixedShape of{plan.from.shape, plan.to.shape, mixed_part(plan, phase)};
    const Wide lowest = lowest_point(other_foot_planned(plan, of, height, phase), height);
    lift = max(lift, fnma(lowest, wide(1 / high), least_clearance * height));
  }
  const WideMask walks = (load(plan.step_length_m) + load(plan.length_before_m)) > 0.0F;
  store(load(plan.swing_by_up_m[0]) + select(walks, min(lift, max_lift * height), wide(0.0F)), plan.swing_by_up_m[0]);
}

/// Standing people who keep both feet in place (stays) or move one (spot).
struct Standing {
  WideMask stays, spot;
};

HWY_INLINE Standing standing(const StepPlan<Lanes<float>>& plan, const WideMask& on_spot) {
  const WideMask still = stands_still(plan), spot = still & on_spot;
  return {either(spot, wide(0.0F), select(still, wide(1.0F), wide(0.0F))), spot};
}

/// Computes the times and lengths of the step from plan.from to plan.to.
HWY_NOINLINE void time_step(const Gait<Lanes<float>>& wanted, const WideMask& right_lands, const WideMask& on_spot,
                            StepPlan<Lanes<float>>& plan) {
  const HeelStrike<Lanes<float>>&from = plan.from, &to = plan.to;
  const Wide zero = wide(0.0F), one = wide(1.0F);
  const WideMask from_stands = stands(from), to_stands = stands(to), still = from_stands & to_stands;
  const auto [stays, spot] = standing(plan, on_spot);
  const Wide pace_from = load(from.pace_hz), pace_to = load(to.pace_hz);
  const WideMask displaced = load(from.length_m) + load(to.length_m) > 0.0F;
  const Wide uneven = load(wanted.style.time_asymmetry) * load(to.own_style);
  const Wide even = select(from_stands, first_step / max(pace_to, 0.1F),
                           select(to_stands, last_step / max(pace_from, 0.1F), 2.0F / max(pace_from + pace_to, 0.1F)));
  const Wide at_rest =
      select(spot, select(displaced, 1.0F / max(pace_from + pace_to, 0.1F), wide(spot_step_s)), wide(stand_s));
  const Wide duration = select(still, at_rest, even * (1.0F + select(right_lands, uneven, -uneven)));
  store(duration, plan.duration_s);
  store(pace_from * duration, plan.phase_rate_from);
  store(pace_to * duration, plan.phase_rate_to);
  const Wide walking_off = select(from_stands, wide(first_double_support), 2.0F * load(from.double_support));
  const Wide off = select(stays, zero, select(spot, wide(spot_double_support), walking_off));
  store(off, plan.double_support);
  const Wide landing = select(stays, zero, select(spot, wide(spot_landing), wide(last_landing)));
  store(select(to_stands, landing, one), plan.landing);
  store(select(from_stands, zero, off), plan.mixed_from);
  store(load(to.length_m), plan.step_length_m);
  store(load(from.length_m), plan.length_before_m);
}

/// Returns 0 where both feet are equally far out and equally toed out.
HWY_INLINE Wide feet_differ(const StepPlan<Lanes<float>>& plan) {
  return abs(load(plan.trailing_half_width_m) - load(plan.from.half_width_m)) +
         abs(load(plan.trailing_toe_out) - load(plan.from.toe_out));
}

/// Marks steps that are followed by their mirror images. `alike` is true where both strikes of the step are equal.
HWY_NOINLINE void settle_step(const Gait<Lanes<float>>& wanted, const WideMask& alike, const WideMask& on_spot,
                              StepPlan<Lanes<float>>& plan) {
  const HeelStrike<Lanes<float>>& to = plan.to;
  const Wide zero = wide(0.0F), one = wide(1.0F);
  const Wide uneven = abs(load(wanted.style.step_asymmetry)) + abs(load(wanted.style.time_asymmetry));
  const WideMask even_steps = uneven <= 0.0F;
  const WideMask there = abs(load(to.speed_m_s) - load(wanted.speed_m_s)) <= 0.0F;
  const WideMask goes_on = alike & even_steps & (there & (feet_differ(plan) <= 0.0F)) & (load(to.own_style) >= 1.0F);
  store_flags(either(standing(plan, on_spot).spot, zero, select(goes_on, one, zero)), plan.settled);
  plan.revision = wanted.revision;
}

/// Solves the step from plan.from to plan.to.
HWY_NOINLINE void solve_step(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted,
                             const WideMask& right_lands, const WideMask& on_spot, StepPlan<Lanes<float>>& plan) {
  time_step(wanted, right_lands, on_spot, plan);
  const HeelStrike<Lanes<float>>&from = plan.from, &to = plan.to;
  const LegSize legs = leg_size(size);
  const Wide height = legs.leg, zero = wide(0.0F), one = wide(1.0F);
  const WideMask from_stands = stands(from), to_stands = stands(to);
  const auto [stays, spot] = standing(plan, on_spot);
  const Wide off = load(plan.double_support), duration = load(plan.duration_s);

  const Wide length = load(to.length_m);
  const Wide usual_from = load(from.advance_m), usual_to = load(to.advance_m);
  const std::size_t middle = step_shape::hips_forward.first;
  store_quintic({load(from.shape[middle]), usual_from, zero}, {length + load(to.shape[middle]), usual_to, zero},
                plan.even_m);
  const Wide usual = select(from_stands | to_stands, 2.0F * max(usual_from, usual_to), usual_from + usual_to);
  store(clamp((load(from.length_m) + length) / max(usual, 1e-3F), 0.0F, 1.5F), plan.stride_part);
  store(select(stays, zero, time_of_phase(plan, off) * duration), plan.double_support_s);
  plan_swing(height, plan);
  const Wide share = select(to_stands, zero, load(wanted.style.forward_swing) * load(to.own_style));
  for (std::size_t k = 0; k < other_way_count; ++k) {
    store(zero, plan.swing_by_forward_m[k]);
    store(zero, plan.swing_by_up_m[k]);
  }
  if (any(share > 0.0F)) integrate_swing(legs, share, plan);
  clear_ground(height, plan);
  const WideMask alike = same_words(from, to);
  const Wide astray = balance_step(legs, select(right_lands, -one, one), alike | stays, spot, plan);
  store_flags(astray > max_astray * height, plan.clamped);
  settle_step(wanted, alike, on_spot, plan);
}

/// Computes only the times and footholds of a step and `settled`.
HWY_NOINLINE void time_step_alone(const Gait<Lanes<float>>& wanted, const WideMask& right_lands,
                                  const WideMask& on_spot, StepPlan<Lanes<float>>& plan) {
  time_step(wanted, right_lands, on_spot, plan);
  const HeelStrike<Lanes<float>>&from = plan.from, &to = plan.to;
  Wide off = wide(0.0F);
  // All other values of a strike follow from these.
  for (const auto word :
       {&HeelStrike<Lanes<float>>::speed_m_s, &HeelStrike<Lanes<float>>::length_m, &HeelStrike<Lanes<float>>::pace_hz,
        &HeelStrike<Lanes<float>>::advance_m, &HeelStrike<Lanes<float>>::half_width_m,
        &HeelStrike<Lanes<float>>::toe_out, &HeelStrike<Lanes<float>>::own_style})
    off = max(off, abs(load(from.*word) - load(to.*word)));
  settle_step(wanted, off <= 0.0F, on_spot, plan);
}

HWY_INLINE Wide load_whole(const Lanes<std::uint32_t>& words) {
  Lanes<float> out;
  for (std::size_t l = 0; l < lane_count; ++l) out[l] = static_cast<float>(words[l]);
  return load(out);
}

/// Plans a requested step aside of standing people: a strike midway, at which the hips are halfway, and then the other
/// foot. The foot on that side moves first. Returns the mask of these people.
HWY_NOINLINE WideMask displace(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted,
                               const GaitState<Lanes<float>>& state, StepPlan<Lanes<float>>& plan) {
  Lanes<float> begins{};
  for (std::size_t l = 0; l < lane_count; ++l) {
    const bool stood = plan.from.speed_m_s[l] <= 0.0F;
    plan.swaps[l] = 0;
    if (stood && plan.from.length_m[l] > 0.0F) {  // already moving aside
      begins[l] = 1.0F;
      continue;
    }
    plan.slant_rad[l] = 0.0F;
    if (!stood || plan.to.speed_m_s[l] > 0.0F || plan.displacement[l] == wanted.displacement[l]) continue;
    plan.displacement[l] = wanted.displacement[l];
    const float left_m = wanted.left_m[l], ahead_m = wanted.ahead_m[l],
                way = std::sqrt(left_m * left_m + ahead_m * ahead_m);
    if (!(way > 0.0F)) continue;
    begins[l] = 1.0F;
    plan.slant_rad[l] = exact::atan2(left_m, ahead_m);
    const std::uint32_t stance = left_m > 0.0F ? Side::right : left_m < 0.0F ? Side::left : state.stance_side[l];
    plan.swaps[l] = static_cast<std::uint32_t>(stance != state.stance_side[l]);
    if (plan.swaps[l] != 0) {
      std::swap(plan.trailing_half_width_m[l], plan.from.half_width_m[l]);
      std::swap(plan.trailing_toe_out[l], plan.from.toe_out[l]);
    }
    plan.to.length_m[l] = way;
    plan.to.advance_m[l] = way;
    plan.to.pace_hz[l] = 1.0F / (displacing_s + displacing_s_per_m * way);
    plan.to.shape[step_shape::hips_forward.first][l] = -0.5F * way;
    // Legs apart reach less high.
    const float apart =
        0.25F * way * way + way * std::abs(exact::sin(plan.slant_rad[l])) * ankle_outward * size.leg_scale_m[l];
    plan.to.shape[step_shape::hips_up.first][l] -=
        sinks_apart * 0.5F * apart / (static_cast<float>(fraction::hip_height) * size.leg_scale_m[l]);
  }
  return load(begins) > 0.0F;
}

void begin_step(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted, Solve solve,
                StepPlan<Lanes<float>>& plan) {
  const Wide zero = wide(0.0F), one = wide(1.0F);
  const WideMask all = one > zero, left_lands = zero > one;
  store(load(wanted.speed_m_s), plan.from.speed_m_s);
  next_strike(size, wanted, zero, plan.from, all, all, solve, plan.from);
  next_strike(size, wanted, zero, plan.from, all, left_lands, solve, plan.to);
  plan.trailing_half_width_m = plan.from.half_width_m;
  plan.trailing_toe_out = plan.from.toe_out;
  solve == Solve::whole ? solve_step(size, wanted, left_lands, left_lands, plan)
                        : time_step_alone(wanted, left_lands, left_lands, plan);
}

void follow_step(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted,
                 const GaitState<Lanes<float>>& state, Solve solve, StepPlan<Lanes<float>>& plan) {
  const Wide zero = wide(0.0F), one = wide(1.0F);
  const WideMask right_lands = equal(state.stance_side, Side::left), fresh = zero > one;
  const WideMask sides_change = load(plan.landing) > 0.0F;  // as in advance_gait
  auto keep = [](const WideMask& where, const Lanes<float>& kept, Lanes<float>& value) {
    store(select(where, load(kept), load(value)), value);
  };
  keep(sides_change, plan.from.half_width_m, plan.trailing_half_width_m);
  keep(sides_change, plan.from.toe_out, plan.trailing_toe_out);
  plan.from = plan.to;
  const Wide way = shorter_way(load(state.heading_rad), load(wanted.heading_rad));
  next_strike(size, wanted, way, plan.from, fresh, right_lands, solve, plan.to);
  // Standing people step in place until both feet have the requested heading and stance of the style. One foot can come
  // from a calmed strike, or the style can have changed.
  const WideMask turns = (abs(way) > off_heading) | (abs(load(state.turn_before_rad)) > 0.0F);
  const WideMask displaces = displace(size, wanted, state, plan);
  const Wide from_style = abs(load(plan.from.half_width_m) - load(plan.to.half_width_m)) +
                          abs(load(plan.from.toe_out) - load(plan.to.toe_out));
  const WideMask on_spot = (turns | (feet_differ(plan) + from_style > 0.0F)) | displaces;
  const WideMask stays = either(on_spot, zero, select(stands_still(plan), one, zero));
  keep(stays, plan.from.half_width_m, plan.to.half_width_m);  // standing feet stay in place
  keep(stays, plan.from.toe_out, plan.to.toe_out);
  const WideMask swapped = load_whole(plan.swaps) > 0.0F;
  const WideMask lands_right = either(swapped, select(right_lands, zero, one), select(right_lands, one, zero));
  solve == Solve::whole ? solve_step(size, wanted, lands_right, on_spot, plan)
                        : time_step_alone(wanted, lands_right, on_spot, plan);
}

void first_block(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted, StepPlan<Lanes<float>>& plan) {
  begin_step(size, wanted, Solve::whole, plan);
}
void time_first_block(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted,
                      StepPlan<Lanes<float>>& plan) {
  begin_step(size, wanted, Solve::times, plan);
}
void next_block(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted,
                const GaitState<Lanes<float>>& state, StepPlan<Lanes<float>>& plan) {
  follow_step(size, wanted, state, Solve::whole, plan);
}
void time_next_block(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted,
                     const GaitState<Lanes<float>>& state, StepPlan<Lanes<float>>& plan) {
  follow_step(size, wanted, state, Solve::times, plan);
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {

HWY_EXPORT(first_block);
HWY_EXPORT(time_first_block);
HWY_EXPORT(next_block);
HWY_EXPORT(time_next_block);

void plan_first_step(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted,
                     StepPlan<Lanes<float>>& plan) {
  HWY_DYNAMIC_DISPATCH(first_block)(size, wanted, plan);
}

void plan_next_step(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted,
                    const GaitState<Lanes<float>>& state, StepPlan<Lanes<float>>& plan) {
  HWY_DYNAMIC_DISPATCH(next_block)(size, wanted, state, plan);
}

void time_first_step(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted,
                     StepPlan<Lanes<float>>& plan) {
  HWY_DYNAMIC_DISPATCH(time_first_block)(size, wanted, plan);
}

void time_next_step(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted,
                    const GaitState<Lanes<float>>& state, StepPlan<Lanes<float>>& plan) {
  HWY_DYNAMIC_DISPATCH(time_next_block)(size, wanted, state, plan);
}

}  // namespace mobil::inline v0_3
#endif
