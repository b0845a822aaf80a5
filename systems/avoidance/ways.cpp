#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <mobil/anthropometry.h>
#include "assets/gait/on_line-inl.h"
#include "assets/gait/step_lookup.h"
#include "engine/wide-inl.h"
#include "systems/avoidance/ways.h"
#include "systems/gait/gait.h"
#include "systems/gait/next_foot-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

constexpr float gravity = 9.81F;

/// One step of the hips: along the line, by the phase of the step.
struct Way {
  Line line;
  Wide duration, rate_from, rate_to;
  Quintic<Lanes<float>> along;
  Wide rest_from, rest_to;  // to the left of the line, standing before and after
  Wide x, z, sine, cosine;  // of the line at the stance foothold
};

HWY_INLINE Ground place_on(const Way& way, const Wide& part) {
  const Wide phase = step_phase(way.rate_from, way.rate_to, part), eased = smooth(part);
  const OnLine on = on_line(way.line, quintic_at(way.along, phase), phase, eased);
  Wide s, c;
  sin_cos(on.heading, s, c);
  const Ground aside = turned(mix(way.rest_from, way.rest_to, eased), wide(0.0F), s, c);
  const Ground at = turned(on.place.left + aside.left, on.place.forward + aside.forward, way.sine, way.cosine);
  return {way.x + at.left, way.z + at.forward};
}

HWY_INLINE Wide when(const WideMask& mask, const Wide& value) {
  return select(mask, value, wide(0.0F));
}

/// Instants since a heel strike, in integer clock units. Those of reservations then do not depend on the time of
/// computing.
struct Instants {
  Wide first;
  float every, unit_s;
};

/// Samples the way from `start` on in lanes that take the step. After its end they stay there.
HWY_NOINLINE void sample(const Way& way, const Instants& instants, const Wide& start, const WideMask& takes,
                         WaySamples<Lanes<float>>& out) {
  const Wide begins = select(takes, start, wide(1e9F)), per_s = 1.0F / way.duration;
  const Ground end = place_on(way, wide(1.0F));
  for (std::size_t s = 0; s < way_samples; ++s) {
    const Wide since = (instants.first + static_cast<float>(s) * instants.every) * instants.unit_s - begins;
    const WideMask begun = since >= 0.0F;
    if (!any(begun)) continue;
    const Wide part = since * per_s;
    Ground at = end;
    if (any(begun & (part < 1.0F))) {  // the dearest part by far, and half of the steps are over
      const Ground on = place_on(way, clamp(part, 0.0F, 1.0F));
      at = {select(part < 1.0F, on.left, end.left), select(part < 1.0F, on.forward, end.forward)};
    }
    store(select(begun, at.left, load(out.x_m[s])), out.x_m[s]);
    store(select(begun, at.forward, load(out.z_m[s])), out.z_m[s]);
  }
}

/// The heel strike at the end of a step.
struct StrikeAhead {
  Wide speed, pace, advance, hips, length;
};

/// A shortened step keeps at least a quarter of the leg, the shortest that a gait allows, with a margin for rounding.
/// It also keeps the rate below two steps a second; people in a dense file make 0.8 to 1.6 (Jelić et al. 2012).
constexpr float shortest_h = 0.2505F * static_cast<float>(fraction::thigh + fraction::shank), max_steps_hz = 2;

HWY_NOINLINE StrikeAhead strike_at(const HeelStrikePlace<Lanes<float>>& at, const Wide& speed,
                                   const Wide& length_part) {
  const Wide leg = static_cast<float>(fraction::hip_height) * load(at.height_m), to_unit = 1.0F / sqrt(gravity * leg);
  const Wide before = load(at.speed_m_s), advance = load(at.advance_m);
  const WideMask walks = speed > 0.0F, walked = (before > 0.0F) & (advance > 0.0F);
  Lanes<float> from, to, usual, hips;
  store(before * to_unit, from);
  store(speed * to_unit, to);
  for (std::size_t l = 0; l < lane_count; ++l) {
    const bool goes = to[l] > 0;
    usual[l] = goes ? static_cast<float>(usual_step_length(to[l])) : 0;
    hips[l] = goes ? usual_hips(to[l]) - (from[l] > 0 ? usual_hips(from[l]) : 0) : 0;
  }
  const Wide own_length = load(usual) * leg * load(at.usual);
  const Wide least = max(speed * (1 / max_steps_hz), shortest_h * load(at.height_m));
  const Wide length = max(own_length * length_part, min(own_length, least));
  const Wide own = load(hips) + when(walked, load(at.hips_m) / max(advance, 0.01F));
  return {speed, when(walks, speed / max(length, 0.01F)), length, own * length, length};
}

HWY_INLINE Line line_from(const HeelStrikePlace<Lanes<float>>& at, const Wide& length, const NextFoot& next,
                          const Wide& slant) {
  const Wide before = load(at.bend_before_per_m), now = load(at.bend_per_m), zero = wide(0.0F);
  const Wide length_before = load(at.length_before_m);
  Line line;
  line.from = {length_before, before * length_before, (now - before) * length_before};
  line.to = {length, now * length, (next.bend - now) * length};
  line.from_heading = load(at.chord_before_rad);
  line.to_heading = chord_heading(line.to) + slant;
  sin_cos(line.from_heading, line.from_s, line.from_c);
  sin_cos(line.to_heading, line.to_s, line.to_c);
  line.turned_before = line.turn = zero;
  line.shift_before = load(at.shift_before_m);
  line.shift = load(at.shift_m);
  line.shift_next = next.shift;
  line.slant = slant;
  return line;
}

/// Takes a step to that strike and returns its way. `at` becomes the state at the strike.
HWY_NOINLINE Way take_step(HeelStrikePlace<Lanes<float>>& at, const StrikeAhead& to, const Wide& turn,
                           const Wide& slant) {
  const Wide zero = wide(0.0F);
  const Wide speed = load(at.speed_m_s), pace = load(at.pace_hz), length_before = load(at.length_before_m);
  const WideMask from_stands = speed <= 0.0F, to_stands = to.speed <= 0.0F;
  const WideMask aside = from_stands & to_stands & (length_before + to.length > 0.0F);
  const Wide paces = pace + to.pace;
  const Wide alone = 1.0F / max(paces, 0.1F);
  const Wide part =
      select(from_stands | to_stands, select(from_stands, wide(step_limits::first_step), wide(step_limits::last_step)),
             wide(2.0F));
  Way way;
  way.duration = select(from_stands & to_stands, select(aside, alone, wide(step_limits::stand_s)), part * alone);
  way.rate_from = pace * way.duration;
  way.rate_to = to.pace * way.duration;
  const Wide bend = load(at.bend_per_m), shift = load(at.shift_m);
  const NextFoot next = next_foot(
      {load(at.height_m), to.length, to.speed, 2.0F * load(at.half_width_m), bend, shift, load(at.lands_left)}, turn);
  way.line = line_from(at, to.length, next, slant);
  store_quintic({load(at.hips_m), load(at.advance_m), zero}, {to.length + to.hips, to.advance, zero}, way.along);
  // A walker who stood has not moved along a chord.
  const Wide heading = load(at.heading_rad);
  way.rest_from = when(from_stands, 0.5F * (load(at.shift_before_m) + shift));
  way.rest_to = when(to_stands, 0.5F * (shift + next.shift));
  way.x = load(at.x_m);
  way.z = load(at.z_m);
  sin_cos(heading, way.sine, way.cosine);

  const WideMask steps = (speed > 0.0F) | (to.speed > 0.0F) | aside;
  const WideMask moves = to.length > 0.0F;
  const Wide turned_by = select(moves, chord_turn(way.line.to), when(from_stands & to_stands, turn));
  const Ground on = turned(zero, to.length, way.line.to_s, way.line.to_c);
  const Ground there = turned(on.left, on.forward, way.sine, way.cosine);
  store(way.x + there.left, at.x_m);
  store(way.z + there.forward, at.z_m);
  store(heading + turned_by, at.heading_rad);
  store(way.line.to_heading - turned_by, at.chord_before_rad);
  store(bend, at.bend_before_per_m);
  store(next.bend, at.bend_per_m);
  store(select(steps, shift, load(at.shift_before_m)), at.shift_before_m);
  store(select(steps, next.shift, shift), at.shift_m);
  store(select(steps, -load(at.lands_left), load(at.lands_left)), at.lands_left);
  store(to.length, at.length_before_m);
  store(to.speed, at.speed_m_s);
  store(to.pace, at.pace_hz);
  store(to.advance, at.advance_m);
  store(to.hips, at.hips_m);
  return way;
}

/// Samples the quickest stop from there on.
HWY_NOINLINE void stop(HeelStrikePlace<Lanes<float>>& at, const Instants& instants, Wide start,
                       WaySamples<Lanes<float>>& out) {
  const Wide zero = wide(0.0F);
  store(wide(1.0F), at.usual);
  const Wide leg = static_cast<float>(fraction::thigh + fraction::shank) * load(at.height_m);
  const Wide scale = sqrt(leg / step_limits::leg_m), last = step_limits::last_speed * scale;
  for (int step = 0; step < 4; ++step) {  // three from the greatest speed
    const Wide speed = load(at.speed_m_s);
    const WideMask goes = (speed > 0.0F) | (load(at.length_before_m) > 0.0F);
    if (!any(goes)) return;
    const Wide slower = when(speed > last, max(speed - step_limits::max_slower * scale, last));
    const StrikeAhead to =
        any(slower > 0.0F) ? strike_at(at, slower, wide(1.0F)) : StrikeAhead{zero, zero, zero, zero, zero};
    const Wide straight_on = (1.0F - slope_at_end) * to.length * load(at.bend_per_m);
    const Way way = take_step(at, to, straight_on, zero);
    sample(way, instants, start, goes, out);
    start = start + way.duration;
  }
}

void reservation_block(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                       const GaitState<Lanes<float>>& state, const Lanes<float>& first, float every, float unit_s,
                       WaySamples<Lanes<float>>& out) {
  const Instants instants = {load(first), every, unit_s};
  Way way;
  way.line = line_of(plan, state);
  way.duration = load(plan.duration_s);
  way.rate_from = load(plan.phase_rate_from);
  way.rate_to = load(plan.phase_rate_to);
  way.along = plan.even_m;
  const Wide shift = load(state.shift_m);
  way.rest_from = when(load(plan.from.speed_m_s) <= 0.0F, 0.5F * (load(state.shift_before_m) + shift));
  way.rest_to = when(load(plan.to.speed_m_s) <= 0.0F, 0.5F * (shift + load(state.shift_next_m)));
  way.x = load(state.line_x_m);
  way.z = load(state.line_z_m);
  sin_cos(load(state.heading_rad), way.sine, way.cosine);
  const Wide start = wide(0.0F);
  out = {};
  sample(way, instants, start, start <= 0.0F, out);
  HeelStrikePlace<Lanes<float>> next;
  next_footing(size, plan, state, next);
  stop(next, instants, way.duration, out);
}

void tried_block(const HeelStrikePlace<Lanes<float>>& from, const Trial<Lanes<float>>& tried, const WayInstants& ahead,
                 WaySamples<Lanes<float>>& out, StepEnd<Lanes<float>>& end) {
  const Instants instants = {wide(ahead.first_s), ahead.every_s, 1};
  HeelStrikePlace<Lanes<float>> at = from;
  const Wide zero = wide(0.0F), aside = load(tried.aside_m);
  StrikeAhead to = strike_at(at, load(tried.speed_m_s), load(tried.length_part));
  const WideMask slants = aside > 0.0F;
  to.length = select(slants, aside, to.length);
  to.advance = select(slants, aside, to.advance);
  to.hips = select(slants, -0.5F * aside, to.hips);
  to.pace = select(slants, 1.0F / (step_limits::displacing_s + step_limits::displacing_s_per_m * aside), to.pace);
  const Way way = take_step(at, to, load(tried.turn_rad), when(slants, load(tried.slant_rad)));
  out = {};
  sample(way, instants, zero, zero <= 0.0F, out);
  const Ground ends = place_on(way, wide(1.0F));
  store(way.duration, end.duration_s);
  store(ends.left, end.x_m);
  store(ends.forward, end.z_m);
  store(to.speed, end.speed_m_s);
  // The landing foot turns the line further while it bears.
  store(fma((1.0F - slope_at_end) * to.length, load(at.bend_per_m), load(at.heading_rad)), end.heading_rad);
  store(load(at.bend_per_m) * to.length, end.bend_rad);
  store(to.length, end.step_length_m);
  stop(at, instants, way.duration, out);
}

void directions_block(const Lanes<float>& heading, Lanes<float>& x, Lanes<float>& z) {
  Wide s, c;
  const Wide rad = load(heading);
  sin_cos(select(abs(rad) < 1e5F, rad, wide(0.0F)), s, c);
  store(s, x);
  store(c, z);
}

void approach_block(const WaySamples<Lanes<float>>& ways, const float* x_m, const float* z_m, Lanes<float>& min_m2) {
  Wide least = wide(1e9F);
  for (std::size_t s = 0; s < way_samples; ++s) {
    const Wide dx = load(ways.x_m[s]) - x_m[s], dz = load(ways.z_m[s]) - z_m[s];
    least = min(least, fma(dx, dx, dz * dz));
  }
  store(least, min_m2);
}

void wall_block(const WaySamples<Lanes<float>>& ways, float a_x, float a_z, float b_x, float b_z,
                Lanes<float>& min_m2) {
  const float along_x = b_x - a_x, along_z = b_z - a_z, squared = along_x * along_x + along_z * along_z;
  const float per = squared > 0 ? 1 / squared : 0;
  Wide least = wide(1e9F);
  for (std::size_t s = 0; s < way_samples; ++s) {
    const Wide x = load(ways.x_m[s]) - a_x, z = load(ways.z_m[s]) - a_z;
    const Wide part = clamp((x * along_x + z * along_z) * per, 0.0F, 1.0F);
    const Wide dx = x - part * along_x, dz = z - part * along_z;
    least = min(least, fma(dx, dx, dz * dz));
  }
  store(least, min_m2);
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {

float usual_hips(float speed) {
  constexpr float every = 0.02F;
  static const auto table = [] {
    std::array<float, 64> parts;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const float fast = every * static_cast<float>(std::max<std::size_t>(k, 1));
      const auto far = static_cast<float>(usual_step_length(fast));
      const float of_height = tabled_step(fast, far).shape[step_shape::hips_forward.first];
      parts[k] = of_height / (far * static_cast<float>(fraction::hip_height));
    }
    return parts;
  }();
  // Accepts any number, also NaN.
  const float at = std::fmin(std::fmax(speed * (1 / every), 0.0F), static_cast<float>(table.size() - 2));
  const auto k = static_cast<std::size_t>(at);
  const float part = at - static_cast<float>(k);
  return table[k] + part * (table[k + 1] - table[k]);
}

HWY_EXPORT(reservation_block);
HWY_EXPORT(tried_block);
HWY_EXPORT(directions_block);
HWY_EXPORT(approach_block);
HWY_EXPORT(wall_block);

void next_footing(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                  const GaitState<Lanes<float>>& state, HeelStrikePlace<Lanes<float>>& next) {
  GaitState<Lanes<float>> then = state;
  then.time_s = plan.duration_s;
  advance_gait(plan, then, 0);  // a tick of zero length: to the strike
  next.height_m = size.leg_scale_m;
  next.speed_m_s = plan.to.speed_m_s;
  next.pace_hz = plan.to.pace_hz;
  next.advance_m = plan.to.advance_m;
  next.hips_m = plan.to.shape[step_shape::hips_forward.first];
  next.length_before_m = plan.step_length_m;
  next.half_width_m = plan.to.half_width_m;
  next.x_m = then.line_x_m;
  next.z_m = then.line_z_m;
  next.heading_rad = then.heading_rad;
  next.chord_before_rad = then.chord_before_rad;
  next.bend_per_m = then.bend_per_m;
  next.bend_before_per_m = then.bend_before_per_m;
  next.shift_m = then.shift_m;
  next.shift_before_m = then.shift_before_m;
  for (std::size_t l = 0; l < lane_count; ++l) {
    next.usual[l] = 1;
    next.lands_left[l] = then.stance_side[l] == Side::right ? 1.0F : -1.0F;
  }
}

void reservation_ways(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                      const GaitState<Lanes<float>>& state, std::uint32_t first_tick, std::uint32_t every_ticks,
                      float tick_s, WaySamples<Lanes<float>>& out) {
  const ClockUnits units = clock_units(tick_s);
  const auto per_tick = static_cast<float>(units.per_tick);
  Lanes<float> first;
  for (std::size_t l = 0; l < lane_count; ++l)
    first[l] = static_cast<float>(units.of(state.time_s[l])) + static_cast<float>(first_tick) * per_tick;
  HWY_DYNAMIC_DISPATCH(reservation_block)
  (size, plan, state, first, static_cast<float>(every_ticks) * per_tick, units.unit_s, out);
}

void tried_ways(const HeelStrikePlace<Lanes<float>>& from, const Trial<Lanes<float>>& tried, const WayInstants& at,
                WaySamples<Lanes<float>>& out, StepEnd<Lanes<float>>& end) {
  HWY_DYNAMIC_DISPATCH(tried_block)(from, tried, at, out, end);
}

void directions(const Lanes<float>& heading_rad, Lanes<float>& x, Lanes<float>& z) {
  HWY_DYNAMIC_DISPATCH(directions_block)(heading_rad, x, z);
}

GroundPoint direction(float heading_rad) {
  Lanes<float> heading{}, x, z;
  heading[0] = heading_rad;
  directions(heading, x, z);
  return {x[0], z[0]};
}

void nearest_approach(const WaySamples<Lanes<float>>& ways, const float* x_m, const float* z_m, Lanes<float>& min_m2) {
  HWY_DYNAMIC_DISPATCH(approach_block)(ways, x_m, z_m, min_m2);
}

void nearest_to_wall(const WaySamples<Lanes<float>>& ways, float a_x_m, float a_z_m, float b_x_m, float b_z_m,
                     Lanes<float>& min_m2) {
  HWY_DYNAMIC_DISPATCH(wall_block)(ways, a_x_m, a_z_m, b_x_m, b_z_m, min_m2);
}

}  // namespace mobil::inline v0_3
#endif
