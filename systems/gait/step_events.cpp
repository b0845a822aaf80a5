#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include <algorithm>
#include <bit>

#include "assets/gait/step_curves-inl.h"
#include "engine/wide-inl.h"
#include "systems/gait/gait.h"
#include "systems/gait/step_events.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

/// Writes a foothold in the world, from its position left of and ahead of the stance foothold and the foot's heading.
HWY_INLINE void put_foothold(const GaitState<Lanes<float>>& state, FootholdOf which, const Wide& left,
                             const Wide& forward, const Wide& turned, Footholds<Lanes<float>>& out) {
  const auto i = index(which);
  const Wide heading = load(state.heading_rad);
  Wide s, c;
  sin_cos(heading, s, c);
  store(fma(left, c, fma(forward, s, load(state.line_x_m))), out.x_m[i]);
  store(fnma(left, s, fma(forward, c, load(state.line_z_m))), out.z_m[i]);
  store(heading + turned, out.heading_rad[i]);
}

/// Computes footholds as in assets/gait/on_line-inl.h: each foot stands next to its own point of the line.
void footholds_block(const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state,
                     Footholds<Lanes<float>>& out) {
  const Wide one = wide(1.0F), zero = wide(0.0F);
  const Wide side = select(equal(state.stance_side, Side::left), one, -one);  // of the stance foot, to the left
  const Wide turned_before = -load(state.turn_before_rad), turn = load(state.turn_rad);
  Wide from_s, from_c, to_s, to_c, before_s, before_c, next_s, next_c;
  sin_cos(load(state.chord_before_rad), from_s, from_c);
  sin_cos(load(state.chord_rad), to_s, to_c);
  sin_cos(turned_before, before_s, before_c);
  sin_cos(turn, next_s, next_c);
  const Wide before = fnma(side, load(plan.trailing_half_width_m), load(state.shift_before_m));
  const Wide stance = fma(side, load(plan.from.half_width_m), load(state.shift_m));
  const Wide next = fnma(side, load(plan.to.half_width_m), load(state.shift_next_m));
  const Wide length_before = load(plan.length_before_m), length = load(plan.step_length_m);
  put_foothold(state, FootholdOf::leaving, fnma(length_before, from_s, before * before_c),
               fnma(length_before, from_c, -(before * before_s)),
               fnma(side, load(plan.trailing_toe_out), turned_before), out);
  put_foothold(state, FootholdOf::stance, stance, zero, side * load(plan.from.toe_out), out);
  put_foothold(state, FootholdOf::landing, fma(length, to_s, next * next_c), fma(length, to_c, -(next * next_s)),
               fnma(side, load(plan.to.toe_out), turn), out);
}

/// Computes the time in the step at which the other foot lands.
void landing_times_block(const StepPlan<Lanes<float>>& plan, Lanes<float>& seconds) {
  store(time_of_phase(plan, load(plan.landing)) * load(plan.duration_s), seconds);
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {

HWY_EXPORT(footholds_block);
HWY_EXPORT(landing_times_block);

namespace {

/// Returns true if the other foot lands before the step ends: in last steps and in steps of standing people.
bool lands_early(const StepPlan<Lanes<float>>& plan, std::size_t lane) {
  return plan.landing[lane] > 0.0F && plan.landing[lane] < 1.0F;
}

/// Returns the lanes that can have an event in this tick: their steps end, or the other foot leaves the ground or lands
/// before the end.
std::uint32_t lanes_to_look_at(const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state, float tick_s) {
  const float slack = 1e-4F * tick_s + 2e-6F;  // more than the clock's units and rounding
  Lanes<std::uint32_t> look;
  for (std::size_t l = 0; l < lane_count; ++l) {
    const float from = state.time_s[l] - slack, to = state.time_s[l] + tick_s + slack;
    const float off = plan.double_support_s[l], landing = plan.landing[l];
    const bool leaves = from < off && off <= to, early = landing > 0.0F && landing < 1.0F;
    look[l] = static_cast<std::uint32_t>(leaves || early || plan.duration_s[l] <= to);
  }
  std::uint32_t lanes = 0;
  for (std::size_t l = 0; l < lane_count; ++l) lanes |= look[l] << l;
  return lanes;
}

/// Data needed by few lanes, computed once per block on first use.
class BlockEvents {
 public:
  BlockEvents(const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state, float tick_s, StepEvents* rows)
      : units(clock_units(tick_s)), plan_(plan), state_(state), rows_(rows) {
    bool early = false;
    for (std::size_t l = 0; l < lane_count; ++l) early = early || lands_early(plan, l);
    if (early) HWY_DYNAMIC_DISPATCH(landing_times_block)(plan, landing_s_);
  }

  /// Adds feet that leave the ground or land after `from` and up to `to`, in units since the beginning of the step,
  /// which is `began` units after the beginning of the tick.
  void in_step(std::size_t lane, std::int32_t from, std::int32_t to, std::int32_t began) {
    const std::uint32_t other = state_.stance_side[lane] ^ 1U;
    const std::int32_t off = units.of(plan_.double_support_s[lane]);
    if (from < off && off <= to) add(lane, began + off, StepEventKind::toe_off, other, FootholdOf::leaving);
    if (!lands_early(plan_, lane)) return;
    const std::int32_t down = units.of(landing_s_[lane]);
    if (from < down && down <= to) add(lane, began + down, StepEventKind::heel_strike, other, FootholdOf::landing);
  }

  void add(std::size_t lane, std::int32_t at, StepEventKind kind, std::uint32_t side, FootholdOf where) {
    if (!placed_) HWY_DYNAMIC_DISPATCH(footholds_block)(plan_, state_, places_);
    placed_ = true;
    const auto i = index(where);
    append(lane, at, kind, side, {places_.x_m[i][lane], 0, places_.z_m[i][lane]}, places_.heading_rad[i][lane]);
  }
  /// Adds an event of the whole person, placed on the walking line.
  void add_on_line(std::size_t lane, std::int32_t at, StepEventKind kind, std::uint32_t side) {
    append(lane, at, kind, side, {state_.line_x_m[lane], 0, state_.line_z_m[lane]}, state_.heading_rad[lane]);
  }

  const ClockUnits units;

 private:
  void append(std::size_t lane, std::int32_t at, StepEventKind kind, std::uint32_t side, const Vec3<float>& place,
              float heading_rad) {
    StepEvents& row = rows_[lane];
    if (row.count == StepEvents::most) return;
    rows_[0].telling = static_cast<std::uint16_t>(rows_[0].telling | 1U << lane);
    row.of[row.count++] = {static_cast<std::uint16_t>(std::clamp(at, 0, units.per_tick)),
                           kind,
                           static_cast<std::uint8_t>(side),
                           place.x,
                           place.z,
                           heading_rad};
  }

  const StepPlan<Lanes<float>>& plan_;
  const GaitState<Lanes<float>>& state_;
  StepEvents* rows_;
  Lanes<float> landing_s_;
  Footholds<Lanes<float>> places_;
  bool placed_ = false;
};

}  // namespace

void footholds(const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state, Footholds<Lanes<float>>& out) {
  HWY_DYNAMIC_DISPATCH(footholds_block)(plan, state, out);
}

void begin_step_events(const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state, float tick_s,
                       StepEvents* rows) {
  rows[0].telling = rows[0].ending = 0;
  std::uint32_t left = lanes_to_look_at(plan, state, tick_s);
  if (left == 0) return;
  BlockEvents events(plan, state, tick_s, rows);
  const ClockUnits& units = events.units;
  for (; left != 0; left &= left - 1) {
    const auto l = static_cast<std::size_t>(std::countr_zero(left));
    StepEvents& row = rows[l];
    const std::int32_t from = units.of(state.time_s[l]), end = units.step(plan.duration_s[l]);
    const std::int32_t to = from + units.per_tick;
    row.count = 0;
    row.moved = plan.landing[l] > 0.0F ? 1 : 0;
    if (row.moved != 0) events.in_step(l, from, std::min(to, end), -from);
    if (to < end) continue;
    rows[0].ending = static_cast<std::uint16_t>(rows[0].ending | 1U << l);
    row.ends_at = static_cast<std::uint16_t>(std::max(end - from, 0));
    row.lands = row.moved != 0 && !lands_early(plan, l) ? 1 : 0;
    row.landing_side = static_cast<std::uint16_t>(state.stance_side[l] ^ 1U);
  }
}

void end_step_events(const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state, float tick_s,
                     StepEvents* rows) {
  std::uint32_t left = rows[0].ending;
  if (left == 0) return;
  BlockEvents events(plan, state, tick_s, rows);
  for (; left != 0; left &= left - 1) {
    const auto l = static_cast<std::size_t>(std::countr_zero(left));
    const StepEvents& row = rows[l];
    const std::int32_t at = row.ends_at;
    const bool moves = plan.landing[l] > 0.0F;
    if (row.lands != 0) events.add(l, at, StepEventKind::heel_strike, row.landing_side, FootholdOf::stance);
    if (row.moved != 0 && !moves) events.add_on_line(l, at, StepEventKind::stopped, row.landing_side);
    if (row.moved == 0 && moves) events.add_on_line(l, at, StepEventKind::started, state.stance_side[l] ^ 1U);
    if (moves) events.in_step(l, 0, events.units.of(state.time_s[l]), at);
  }
}

}  // namespace mobil::inline v0_3
#endif
