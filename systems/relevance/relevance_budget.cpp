// What is afforded, and whose method changes now.
#include <algorithm>

#include <mobil/anthropometry.h>
#include <mobil/relevance.h>
#include <mobil/systems/people/person.h>
#include "systems/muscles/finite_shape_effect.h"
#include "systems/muscles/leg_muscles.h"
#include "systems/muscles/muscle_parts.h"
#include "systems/relevance/basis_orders.h"
#include "systems/relevance/packed_rungs.h"
#include "systems/simulation_world.h"

namespace mobil::inline v0_3 {
namespace {

constexpr float easing = 0.97F;  // how fast tolerances come back when there is time again, an update

double deformation_s(const Simulation& simulation) {
  double sum = 0;
  for (const SystemReport& system : simulation.report().systems) {
    if (is_deformation(system.module)) sum += system.seconds;
  }
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

void Relevance::observe_machine() {
  if (!scene_.budget_s) {
    factor_ = 1;
    return;
  }
  if (!options_.machine_factor && simulation_.ticks() != last_tick_) {
    last_tick_ = simulation_.ticks();
    const double measured = options_.measured_s ? options_.measured_s(simulation_) : deformation_s(simulation_);
    machine_.observe(measured, 1e-12 * static_cast<double>(cost_ps_));
  }
  plan_budget();
}

void Relevance::plan_budget() {
  budget_ps_ = static_cast<std::int64_t>(std::min(*scene_.budget_s / machine_.pessimistic() * 1e12, 9e18));
  const float least = scene_.tolerance_m || scene_.camera ? 1.0F : CostSpectrum::least_factor;
  const float afforded = std::max(crowd_.factor_within(budget_ps_), least);
  factor_ = afforded > factor_ ? afforded : std::max(afforded, easing * factor_);
}

/// In their order, until the update has spent `most_ps` on changes.
void Relevance::change_first(std::span<const Switch> all, std::int64_t most_ps, bool within_budget,
                             RelevanceReport& report) {
  for (const Switch& one : all) {
    const float us = (one.living ? living_switch_us : switch_us)[one.rung];
    const auto cost_ps = static_cast<std::int64_t>(1e6 * static_cast<double>(us) * machine_.mean());
    if (switching_ps_ > 0 && switching_ps_ + cost_ps > most_ps) return;
    if (within_budget && cost_ps_ + one.cost_ps > budget_ps_) continue;
    if (change(one, report)) switching_ps_ += cost_ps;
  }
}

/// Cheaper ones get half of the turns and of the time, or what dearer ones leave, or under too high a cost all.
void Relevance::carry_out(RelevanceReport& report) {
  const auto first = [](const Switch& a, const Switch& b, bool most) {
    if (a.excess != b.excess) return most ? a.excess > b.excess : a.excess < b.excess;
    if (a.human.index != b.human.index) return a.human.index < b.human.index;
    return a.muscle < b.muscle;
  };
  const auto arrange = [&](std::vector<Switch>& all, std::size_t count, bool most) {
    const auto before = [&](const Switch& a, const Switch& b) { return first(a, b, most); };
    if (count < all.size())
      std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count), all.end(), before);
    std::sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(std::min(count, all.size())), before);
  };
  const std::size_t turns = options_.switches;
  const bool over = scene_.budget_s && cost_ps_ > budget_ps_;
  const std::size_t left = turns > now_.dearer.size() ? turns - now_.dearer.size() : 0;
  const std::size_t down = std::min(now_.cheaper.size(), over ? turns : std::max(turns / 2, left));
  const std::size_t up = std::min(now_.dearer.size(), turns - down);
  arrange(now_.cheaper, down, false);
  arrange(now_.dearer, up, true);
  const auto most_ps = static_cast<std::int64_t>(std::min(1e12 * options_.switching_s, 9e18));
  switching_ps_ = 0;
  const std::size_t refused_before = report.refused;
  change_first(std::span(now_.cheaper).first(down), over || up == 0 ? most_ps : most_ps / 2, false, report);
  change_first(std::span(now_.dearer).first(up), most_ps, scene_.budget_s.has_value(), report);
  report.waiting = now_.cheaper.size() + now_.dearer.size() - report.switched - (report.refused - refused_before);
}

/// Whether what a rung shares is there, or time has come for it.
bool Relevance::at_hand(const Switch& one, std::uint32_t rung, bool order) {
  const MuscleMethod method = rung_method(rung, one.points, one.living);
  if (options_.background.run == nullptr || method.method != Method::reduced) return true;
  const World& world = simulation_.world();
  const auto muscle = static_cast<Muscle>(one.muscle);
  auto choice = choice_of(world, one.human);
  if (!choice) return true;  // set_method says so
  choice->method = method.method;
  choice->reduced = method.reduced;
  const auto plan = make_muscle_plan(*make_body(body_request(world, one.human)), muscle);
  return orders_->ready(SimulationWorld::library(simulation_), muscle, *choice, plan->scale, simulation_.ticks(),
                        order);
}

/// False where it waits for what its method shares.
bool Relevance::change(const Switch& one, RelevanceReport& report) {
  if (simulation_.is_compact(one.human)) return false;  // waits to be whole
  auto tiers = *simulation_.world().get<Tiers>(one.human);
  const std::uint32_t now = rung_at(tiers.rung, one.muscle);
  const RungCase of = rung_case(tiers, one.muscle, one.points);
  std::uint32_t rung = one.rung;
  if (rung != now && !at_hand(one, rung, true)) {
    const auto& order = ladder_.by_cost(of);
    auto cheaper = std::find(order.begin(), order.end(), static_cast<std::uint8_t>(rung));
    while (cheaper != order.begin() && !at_hand(one, *cheaper, false)) --cheaper;
    rung = *cheaper;
    if (rung == now || ladder_.error_m(of, rung) >= ladder_.error_m(of, now)) return false;
  }
  const auto done =
      simulation_.set_method(one.human, static_cast<Muscle>(one.muscle), rung_method(rung, one.points, one.living));
  if (done) {
    RungCase before = of;
    before.points = bit_at(tiers.points, one.muscle);
    const std::int64_t more_ps = ladder_.cost_ps(of, rung) - ladder_.cost_ps(before, now);
    set_rung(tiers.rung, one.muscle, rung);
    set_bit(tiers.points, one.muscle, one.points);
    cost_ps_ += more_ps;
    counted_ps_ += more_ps;
    ++report.switched;
  } else {
    set_rung(tiers.rung, one.muscle, refused_rung);
    ++report.refused;
    report.refusal = done.error().message;
  }
  world_of(simulation_).set(one.human, tiers);
  return true;
}

}  // namespace mobil::inline v0_3
