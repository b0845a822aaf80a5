#include "systems/lod/lod_round.h"

#include <algorithm>

#include <mobil/anthropometry.h>
#include <mobil/lod.h>
#include <mobil/schedule.h>
#include "systems/accuracy/packed_levels.h"
#include "systems/lod/basis_orders.h"
#include "systems/muscles/finite_shape_effect.h"
#include "systems/muscles/leg_muscles.h"
#include "systems/muscles/muscle_parts.h"
#include "systems/people/person_requests.h"
#include "systems/states/muscle_verbs.h"

namespace mobil::inline v0_3 {
namespace {

constexpr float easing = 0.97F;  // factor per update by which tolerances tighten again when time is available

double deformation_s(const Schedule& schedule) {
  double sum = 0;
  for (std::size_t i = 0; i < schedule.systems().size(); ++i)
    if (is_deformation(schedule.systems()[i].module)) sum += schedule.timings()[i].last_seconds;
  return sum;
}

}  // namespace

bool is_deformation(std::string_view module) {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = {fade_module().name, finite_shape_effect.module().name};
    for (const DeformationMethod& method : deformation_methods()) {
      if (method.module != nullptr) all.push_back(method.module().name);
    }
    return all;
  }();
  return std::find(names.begin(), names.end(), module) != names.end();
}

void LodRound::observe_machine() {
  if (!work_.scene.budget_s) {
    progress_.factor = 1;
    return;
  }
  if (!work_.options.machine_factor && frame_.tick.index != progress_.last_tick) {
    progress_.last_tick = frame_.tick.index;
    const double measured =
        work_.options.measured_s ? work_.options.measured_s(frame_.schedule) : deformation_s(frame_.schedule);
    progress_.machine.observe(measured, 1e-12 * static_cast<double>(progress_.cost_ps));
  }
  plan_budget();
}

void LodRound::plan_budget() {
  progress_.budget_ps =
      static_cast<std::int64_t>(std::min(*work_.scene.budget_s / machine().pessimistic() * 1e12, 9e18));
  const float least = work_.scene.tolerance_m || work_.scene.camera ? 1.0F : CostSpectrum::min_factor;
  const float afforded = std::max(progress_.crowd.factor_within(progress_.budget_ps), least);
  progress_.factor = afforded > progress_.factor ? afforded : std::max(afforded, easing * progress_.factor);
}

/// Makes changes in order until the update has spent `max_ps` on them.
void LodRound::change_first(std::span<const Switch> all, std::int64_t max_ps, bool within_budget) {
  for (const Switch& one : all) {
    const float us = (one.active ? active_switch_us : switch_us)[one.level];
    const auto cost_ps = static_cast<std::int64_t>(1e6 * static_cast<double>(us) * machine().mean());
    if (switching_ps_ > 0 && switching_ps_ + cost_ps > max_ps) return;
    if (within_budget && progress_.cost_ps + one.cost_ps > progress_.budget_ps) continue;
    if (change(one)) switching_ps_ += cost_ps;
  }
}

/// Gives cheaper switches half of the count and time, or what dearer ones leave; above the budget they get all.
void LodRound::carry_out() {
  const auto first = [](const Switch& a, const Switch& b, bool most) {
    if (a.excess != b.excess) return most ? a.excess > b.excess : a.excess < b.excess;
    if (a.person.index != b.person.index) return a.person.index < b.person.index;
    return a.muscle < b.muscle;
  };
  const auto arrange = [&](std::vector<Switch>& all, std::size_t count, bool most) {
    const auto before = [&](const Switch& a, const Switch& b) { return first(a, b, most); };
    if (count < all.size())
      std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count), all.end(), before);
    std::sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(std::min(count, all.size())), before);
  };
  const std::size_t turns = work_.options.switches;
  const bool over = work_.scene.budget_s && progress_.cost_ps > progress_.budget_ps;
  const std::size_t left = turns > work_.now.dearer.size() ? turns - work_.now.dearer.size() : 0;
  const std::size_t down = std::min(work_.now.cheaper.size(), over ? turns : std::max(turns / 2, left));
  const std::size_t up = std::min(work_.now.dearer.size(), turns - down);
  arrange(work_.now.cheaper, down, false);
  arrange(work_.now.dearer, up, true);
  const auto max_ps = static_cast<std::int64_t>(std::min(1e12 * work_.options.switching_s, 9e18));
  switching_ps_ = 0;
  const std::size_t refused_before = report_.refused;
  change_first(std::span(work_.now.cheaper).first(down), over || up == 0 ? max_ps : max_ps / 2, false);
  change_first(std::span(work_.now.dearer).first(up), max_ps, work_.scene.budget_s.has_value());
  report_.waiting =
      work_.now.cheaper.size() + work_.now.dearer.size() - report_.switched - (report_.refused - refused_before);
}

/// Returns true if the level's shared data exists, or its waiting time has passed.
bool LodRound::at_hand(const Switch& one, std::uint32_t level, bool order) {
  const MuscleMethod method = level_method(level, one.points, one.active);
  if (work_.options.background.run == nullptr || method.method != Method::modal) return true;
  const auto muscle = static_cast<Muscle>(one.muscle);
  auto choice = choice_of(world_, one.person);
  if (!choice) return true;  // set_method reports the error
  choice->method = method.method;
  choice->modal = method.modal;
  const auto plan = make_muscle_plan(*make_body(body_request(world_, one.person)), muscle);
  return work_.orders.ready(library(), muscle, *choice, plan->scale, frame_.tick.index, order, progress_.ordered);
}

/// Returns false if the change waits: for the person to be full, or for the method's shared data.
bool LodRound::change(const Switch& one) {
  if (is_compact(world_, one.person)) return false;  // waits until the person is full
  auto lod_state = *world_.get<LodState>(one.person);
  const std::uint32_t now = level_at(lod_state.level, one.muscle);
  const LevelCase of = level_case(lod_state, one.muscle, one.points);
  std::uint32_t level = one.level;
  if (level != now && !at_hand(one, level, true)) {
    const auto& order = work_.lod_table.by_cost(of);
    auto cheaper = std::find(order.begin(), order.end(), static_cast<std::uint8_t>(level));
    while (cheaper != order.begin() && !at_hand(one, *cheaper, false)) --cheaper;
    level = *cheaper;
    if (level == now || work_.lod_table.error_m(of, level) >= work_.lod_table.error_m(of, now)) return false;
  }
  const auto done = set_method(frame_, {&one.person, 1}, static_cast<Muscle>(one.muscle),
                               level_method(level, one.points, one.active));
  if (done) {
    LevelCase before = of;
    before.points = bit_at(lod_state.points, one.muscle);
    const std::int64_t more_ps = work_.lod_table.cost_ps(of, level) - work_.lod_table.cost_ps(before, now);
    set_level(lod_state.level, one.muscle, level);
    set_bit(lod_state.points, one.muscle, one.points);
    progress_.cost_ps += more_ps;
    progress_.counted_ps += more_ps;
    ++report_.switched;
  } else {
    set_level(lod_state.level, one.muscle, refused_level);
    ++report_.refused;
    report_.refusal = done.error().message;
  }
  world_.set(one.person, lod_state);
  return true;
}

}  // namespace mobil::inline v0_3
