#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <utility>

#include <mobil/rows.h>
#include "engine/wide-inl.h"
#include "systems/gait/asleep.h"
#include "systems/gait/heading-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

/// Computes the point of the line `chords` straight steps from the anchor, bit-identical to advance_gait.
void line_block(const SteadyWalk<Lanes<float>>& walk, const Lanes<float>& chords, Lanes<float>& x_m,
                Lanes<float>& z_m) {
  Wide s, c;
  sin_cos(load(walk.heading_rad) + 0.0F, s, c);
  const Wide walks = select(load(walk.speed_m_s) > 0.0F, load(walk.step_length_m), wide(0.0F));
  store(fma(load(chords), walks * s, load(walk.anchor_x_m)), x_m);
  store(fma(load(chords), walks * c, load(walk.anchor_z_m)), z_m);
}

/// Marks walkers whose heading is as requested, within the tolerances of turn_gait and lanes_to_plan.
void heads_block(const GaitState<Lanes<float>>& state, const Gait<Lanes<float>>& gait, Lanes<float>& heads) {
  const Wide way = abs(shorter_way(load(state.heading_rad), load(gait.heading_rad)));
  const WideMask walks = load(gait.speed_m_s) > 0.0F, stands = load(gait.speed_m_s) <= 0.0F;
  const WideMask heads_there = (walks & (way < as_asked)) | (stands & (way <= off_heading));
  store(select(heads_there, wide(1.0F), wide(0.0F)), heads);
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {

HWY_EXPORT(line_block);
HWY_EXPORT(heads_block);

namespace {

constexpr int max_strikes = 12;

/// Grid of a parameter: its default plus whole steps within its range, counted by a byte.
struct StyleGrid {
  float usual, step;
  int first;  // steps below the default

  explicit StyleGrid(const GaitParameter& parameter)
      : usual(GaitStyle{}.*parameter.value),
        step((parameter.high - parameter.low) * (1.0F / 254)),
        first(static_cast<int>(std::ceil((parameter.low - usual) / step))) {
    while (at(0) < parameter.low) ++first;
  }
  float at(int byte) const { return usual + static_cast<float>(first + byte) * step; }
  int nearest(const GaitParameter& parameter, float value) const {
    int byte = std::clamp(static_cast<int>(std::lround((value - usual) / step)) - first, 0, 255);
    while (at(byte) > parameter.high) --byte;
    return byte;
  }
};

const std::array<StyleGrid, gait_parameters.size()>& style_grids() {
  static const auto grids = []<std::size_t... p>(std::index_sequence<p...>) {
    return std::array{StyleGrid(gait_parameters[p])...};
  }
  (std::make_index_sequence<gait_parameters.size()>{});
  return grids;
}

/// Progress of a walk at a tick. Exact: all numbers are integers below 2⁵³, and no quotient rounds to the next integer.
struct Progress {
  std::uint32_t strikes, units;
};
Progress progress_at(std::uint32_t clock, std::uint32_t step_units, std::uint32_t tick, std::int32_t per_tick) {
  const double total = static_cast<double>(clock) + static_cast<double>(tick) * per_tick, step = step_units;
  const double strikes = std::floor(total / step);
  return {static_cast<std::uint32_t>(static_cast<std::int64_t>(strikes)),
          static_cast<std::uint32_t>(total - strikes * step)};
}

bool walks(const SteadyWalk<Lanes<float>>& walk, std::size_t lane) {
  return walk.speed_m_s[lane] > 0.0F;
}

Progress progress_at(const SteadyWalk<Lanes<float>>& walk, std::size_t lane, std::uint32_t tick,
                     std::int32_t per_tick) {
  return progress_at(walk.clock[lane], walk.step_units[lane], tick, per_tick);
}

/// Computes the state at tick 0 from the present one: the position in a stride, or in a step for standing people.
void wind_back(SteadyWalk<float>& walk, std::uint32_t tick, std::int32_t per_tick, std::uint32_t units,
               std::uint32_t side, std::uint32_t steps) {
  const std::uint64_t step = walk.step_units, passed = std::uint64_t{tick} * static_cast<std::uint64_t>(per_tick);
  if (walk.speed_m_s <= 0.0F) {
    walk.clock = static_cast<std::uint32_t>((units + step - passed % step) % step + (side != 0 ? step : 0));
    walk.steps = steps;
    return;
  }
  const std::uint64_t stride = 2 * step;
  walk.clock = static_cast<std::uint32_t>((units + side * step + stride - passed % stride) % stride);
  walk.steps = steps - progress_at(walk.clock, walk.step_units, tick, per_tick).strikes;
}

bool same_strike(const HeelStrike<Lanes<float>>& a, const HeelStrike<Lanes<float>>& b, std::size_t lane) {
  return a.speed_m_s[lane] == b.speed_m_s[lane] && a.length_m[lane] == b.length_m[lane] &&
         a.pace_hz[lane] == b.pace_hz[lane] && a.advance_m[lane] == b.advance_m[lane] &&
         a.half_width_m[lane] == b.half_width_m[lane] && a.toe_out[lane] == b.toe_out[lane];
}

/// Returns true if all words of a turn are zero, including their signs.
bool goes_straight(const GaitState<Lanes<float>>& state, std::size_t lane) {
  std::uint32_t bits = 0;
  for (const Lanes<float>* const word :
       {&state.turn_rad, &state.turn_before_rad, &state.chord_rad, &state.chord_before_rad, &state.bend_per_m,
        &state.bend_before_per_m, &state.bend_next_per_m, &state.shift_m, &state.shift_before_m, &state.shift_next_m})
    bits |= std::bit_cast<std::uint32_t>((*word)[lane]);
  return bits == 0;
}

bool has_settled(const StepPlan<Lanes<float>>& plan, const StepPlan<Lanes<float>>& fresh,
                 const Gait<Lanes<float>>& gait, std::size_t lane) {
  return plan.settled[lane] == 1 && plan.revision[lane] == gait.revision[lane] &&
         plan.displacement[lane] == gait.displacement[lane] && plan.swaps[lane] == 0 && plan.slant_rad[lane] == 0 &&
         plan.duration_s[lane] == fresh.duration_s[lane] && plan.landing[lane] == fresh.landing[lane] &&
         same_strike(plan.from, fresh.from, lane) && same_strike(plan.to, fresh.to, lane) &&
         plan.trailing_half_width_m[lane] == fresh.trailing_half_width_m[lane] &&
         plan.trailing_toe_out[lane] == fresh.trailing_toe_out[lane];
}

/// Implements steady_walkers, given the step with which the walkers would begin.
std::uint32_t steady_lanes(const StepPlan<Lanes<float>>& fresh, const Gait<Lanes<float>>& gait,
                           const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state,
                           const Lanes<std::uint32_t>& tick, float tick_s, SteadyWalk<Lanes<float>>& walk) {
  const ClockUnits units = clock_units(tick_s);
  Lanes<float> heads, chords, x_m, z_m;
  HWY_DYNAMIC_DISPATCH(heads_block)(state, gait, heads);
  std::uint32_t bits = 0;
  for (std::size_t l = 0; l < lane_count; ++l) {
    SteadyWalk<float> w{};
    w.step_units = static_cast<std::uint32_t>(units.step(plan.duration_s[l]));
    w.anchor_x_m = state.anchor_x_m[l];
    w.anchor_z_m = state.anchor_z_m[l];
    w.anchor_steps = state.anchor_steps[l];
    w.heading_rad = state.heading_rad[l];
    w.asked_heading_rad = gait.heading_rad[l];
    w.speed_m_s = gait.speed_m_s[l];
    w.step_length_m = gait.step_length_m[l];
    w.requests = (gait.revision[l] & 0xFFFFU) | gait.displacement[l] << 16U;
    wind_back(w, tick[l], units.per_tick, static_cast<std::uint32_t>(units.of(state.time_s[l])), state.stance_side[l],
              state.steps[l]);
    put_row(w, walk, l);
    chords[l] = static_cast<float>(state.steps[l] - state.anchor_steps[l]);
    const bool ticks_fit = w.step_units > static_cast<std::uint32_t>(units.per_tick) && w.step_units < (1U << 23U);
    const bool words_fit = gait.revision[l] <= 0xFFFFU && gait.displacement[l] <= 0xFFFFU;
    const bool steady =
        ticks_fit && words_fit && heads[l] > 0.0F && goes_straight(state, l) && has_settled(plan, fresh, gait, l);
    bits |= static_cast<std::uint32_t>(steady) << l;
  }
  HWY_DYNAMIC_DISPATCH(line_block)(walk, chords, x_m, z_m);
  for (std::size_t l = 0; l < lane_count; ++l) {
    if (x_m[l] != state.line_x_m[l] || z_m[l] != state.line_z_m[l]) bits &= ~(1U << l);
  }
  return bits;
}

/// Walkers in the middle of their steps, each at its own tick.
struct Walkers {
  const ClockUnits units;
  const float tick_s;
  WalkingBlock& at;
  Lanes<std::uint32_t> tick;
  StepPlan<Lanes<float>> next;  // work

  Walkers(float tick_length_s, WalkingBlock& block, const Lanes<std::uint32_t>& asked)
      : units(clock_units(tick_length_s)), tick_s(tick_length_s), at(block), tick(asked) {}

  std::uint32_t ticks_to_strike(std::size_t lane) const {
    const std::int32_t left = units.step(at.plan.duration_s[lane]) - units.of(at.state.time_s[lane]);
    return static_cast<std::uint32_t>(std::max((left + units.per_tick - 1) / units.per_tick, 1));
  }

  /// Advances these lanes to their next heel strike. All other lanes become invalid.
  template <class Next>
  void strike(std::uint32_t lanes, const Next& plan_next) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      if ((lanes >> l & 1U) == 0) continue;
      const std::uint32_t ticks = ticks_to_strike(l);
      at.state.time_s[l] =
          units.seconds(units.of(at.state.time_s[l]) + static_cast<std::int32_t>(ticks - 1) * units.per_tick);
      tick[l] += ticks;
    }
    advance_gait(at.plan, at.state, tick_s);
    const std::uint32_t planned = lanes_to_plan(at.plan, at.gait, at.state, tick_s) & lanes;
    if (planned == lanes) {
      plan_next(at.size, at.gait, at.state, at.plan);
    } else if (planned != 0) {
      next = at.plan;
      plan_next(at.size, at.gait, at.state, next);
      for (std::size_t l = 0; l < lane_count; ++l)
        if ((planned >> l & 1U) != 0) put_row(row_of(next, l), at.plan, l);
    }
    turn_gait(at.size, at.plan, at.gait, at.state, tick_s);
  }
};

/// Marks a step as planned for a request that has been met.
void mark_met(const Gait<Lanes<float>>& gait, StepPlan<Lanes<float>>& plan) {
  plan.revision = gait.revision;
  plan.displacement = gait.displacement;
}

}  // namespace

GaitStyle snapped(const GaitStyle& style) {
  GaitStyle out;
  for (std::size_t p = 0; p < gait_parameters.size(); ++p) {
    const GaitParameter& parameter = gait_parameters[p];
    const StyleGrid& grid = style_grids()[p];
    out.*parameter.value = grid.at(grid.nearest(parameter, style.*parameter.value));
  }
  return out;
}

std::optional<SleepingStyle<float>> packed_style(const GaitStyle& style) {
  SleepingStyle<float> packed{};
  for (std::size_t p = 0; p < gait_parameters.size(); ++p) {
    const GaitParameter& parameter = gait_parameters[p];
    const StyleGrid& grid = style_grids()[p];
    const int byte = grid.nearest(parameter, style.*parameter.value);
    if (grid.at(byte) != style.*parameter.value) return std::nullopt;
    packed.bytes[p / 4] |= static_cast<std::uint32_t>(byte) << 8 * (p % 4);
  }
  return packed;
}

GaitStyle style_of(const SleepingStyle<float>& packed) {
  GaitStyle style;
  const auto& grids = style_grids();
  for (std::size_t p = 0; p < gait_parameters.size(); ++p)
    style.*gait_parameters[p].value = grids[p].at(static_cast<int>(packed.bytes[p / 4] >> 8 * (p % 4) & 0xFFU));
  return style;
}

std::uint32_t steady_walkers(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& gait,
                             const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state,
                             const Lanes<std::uint32_t>& tick, float tick_s, SteadyWalk<Lanes<float>>& walk) {
  const auto fresh = std::make_unique<StepPlan<Lanes<float>>>();
  time_first_step(size, gait, *fresh);
  return steady_lanes(*fresh, gait, plan, state, tick, tick_s, walk);
}

bool may_be_steady(const Gait<Lanes<float>>& gait, const StepPlan<Lanes<float>>& plan,
                   const GaitState<Lanes<float>>& state, std::size_t lane) {
  return plan.settled[lane] == 1 && plan.revision[lane] == gait.revision[lane] &&
         plan.displacement[lane] == gait.displacement[lane] && goes_straight(state, lane);
}

void steady_state(const SteadyWalk<Lanes<float>>& walk, const Lanes<std::uint32_t>& tick, float tick_s,
                  GaitState<Lanes<float>>& state) {
  const ClockUnits units = clock_units(tick_s);
  state = {};
  Lanes<float> chords;
  for (std::size_t l = 0; l < lane_count; ++l) {
    const auto [strikes, in_step] = progress_at(walk, l, tick[l], units.per_tick);
    state.time_s[l] = units.seconds(static_cast<std::int32_t>(in_step));
    state.stance_side[l] = walks(walk, l) ? strikes & 1U : walk.clock[l] >= walk.step_units[l] ? 1U : 0U;
    state.steps[l] = walk.steps[l] + (walks(walk, l) ? strikes : 0);
    chords[l] = static_cast<float>(state.steps[l] - walk.anchor_steps[l]);
  }
  state.heading_rad = walk.heading_rad;
  state.anchor_x_m = walk.anchor_x_m;
  state.anchor_z_m = walk.anchor_z_m;
  state.anchor_steps = walk.anchor_steps;
  HWY_DYNAMIC_DISPATCH(line_block)(walk, chords, state.line_x_m, state.line_z_m);
}

void steady_places(const SteadyWalk<Lanes<float>>& walk, std::uint32_t tick, float tick_s, Lanes<float>& x_m,
                   Lanes<float>& z_m) {
  const double passed = static_cast<double>(tick) * clock_units(tick_s).per_tick;
  Lanes<float> chords;
  for (std::size_t l = 0; l < lane_count; ++l) {
    const double steps = (walk.clock[l] + passed) / walk.step_units[l];
    chords[l] = static_cast<float>(steps + static_cast<std::int32_t>(walk.steps[l] - walk.anchor_steps[l]));
  }
  HWY_DYNAMIC_DISPATCH(line_block)(walk, chords, x_m, z_m);
}

void begin_steady(const SteadyWalk<Lanes<float>>& walk, const Lanes<std::uint32_t>& tick, float tick_s,
                  WalkingBlock& block) {
  steady_state(walk, tick, tick_s, block.state);
  block.plan = {};
  plan_first_step(block.size, block.gait, block.plan);
  mark_met(block.gait, block.plan);
}

void walk_on(const Gait<Lanes<float>>& gait_before, const SteadyWalk<Lanes<float>>& before,
             const Lanes<std::uint32_t>& asked, const Lanes<std::uint32_t>& tick, float tick_s, WalkingBlock& block,
             WalkingBlock& work) {
  work.size = block.size;
  work.gait = block.gait;
  steady_state(before, asked, tick_s, work.state);
  work.plan = {};
  plan_first_step(work.size, gait_before, work.plan);
  mark_met(gait_before, work.plan);
  Walkers walkers(tick_s, work, asked);
  for (std::uint32_t left = 0xFFFF;;) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      if ((left >> l & 1U) == 0 || walkers.tick[l] + walkers.ticks_to_strike(l) <= tick[l]) continue;
      left &= ~(1U << l);
      put_row(row_of(work.plan, l), block.plan, l);
      put_row(row_of(work.state, l), block.state, l);
      const ClockUnits& units = walkers.units;
      block.state.time_s[l] = units.seconds(units.of(work.state.time_s[l]) +
                                            static_cast<std::int32_t>(tick[l] - walkers.tick[l]) * units.per_tick);
    }
    if (left == 0) return;
    walkers.strike(left, &plan_next_step);
  }
}

void settle(const Gait<Lanes<float>>& gait_before, const SteadyWalk<Lanes<float>>& before,
            const Lanes<std::uint32_t>& asked, float tick_s, WalkingBlock& block, SteadyWalk<Lanes<float>>& after,
            Lanes<std::uint32_t>& until) {
  steady_state(before, asked, tick_s, block.state);
  block.plan = {};
  time_first_step(block.size, gait_before, block.plan);
  mark_met(gait_before, block.plan);
  const auto walkers = std::make_unique<Walkers>(tick_s, block, asked);
  const auto fresh = std::make_unique<StepPlan<Lanes<float>>>();
  time_first_step(block.size, block.gait, *fresh);
  SteadyWalk<Lanes<float>> walk;
  std::uint32_t left = 0xFFFF;
  until = {};
  for (int i = 0; i < max_strikes && left != 0; ++i) {
    walkers->strike(left, &time_next_step);
    const std::uint32_t steady =
        left & steady_lanes(*fresh, block.gait, block.plan, block.state, walkers->tick, tick_s, walk);
    for (std::size_t l = 0; l < lane_count; ++l) {
      if ((steady >> l & 1U) == 0) continue;
      put_row(row_of(walk, l), after, l);
      until[l] = walkers->tick[l];
    }
    left &= ~steady;
  }
  for (std::size_t l = 0; l < lane_count; ++l)
    if ((left >> l & 1U) != 0) until[l] = never_settles;
}

}  // namespace mobil::inline v0_3
#endif
