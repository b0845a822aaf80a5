// What each way costs, all in turn so that a busy moment hits all alike.

#include <fmt/format.h>

#include <memory>

#include "demo/lab/bench/bench_fem_bellies.h"
#include "demo/lab/frontier/frontier.h"
#include "demo/lab/frontier/frontier_costs.h"

namespace mobil {
namespace {

constexpr int repeats = 3;

struct Meter {
  std::unique_ptr<FrontierCrowd> crowd;
  Rounds ticks, points;

  void measure_once(bool also_points) {
    ticks.add(measure(repeats, [this] { crowd->tick(false); }));
    if (also_points) points.add(measure(repeats, [this] { crowd->tick(true); }));
  }
  /// µs of one muscle in a tick of 1/60 s: the least time that the thread had a processor.
  double us(const Rounds& rounds) const {
    return *rounds.all().cpu_s / (static_cast<double>(crowd->muscles()) * crowd->ticks_a_call()) * 1e6;
  }
};

/// As many blocks as fill the memory, or as fit into the time.
std::unique_ptr<FrontierCrowd> crowd_of(const FrontierPriced& priced, std::span<const FrontierDrive> drives, bool loads,
                                        Stiffness stiffness, const FrontierRequest& request) {
  const FrontierMethod& method = priced.rung->method;
  FrontierCrowd few(method, drives, priced.individuals, loads, stiffness, request.bytes, 1);
  const double block_s = measure(1, [&] { few.tick(true); }).best_s * lane_count / static_cast<double>(few.muscles());
  const auto most = static_cast<std::size_t>(request.call_s / block_s);
  return std::make_unique<FrontierCrowd>(method, drives, priced.individuals, loads, stiffness, request.bytes, most);
}

}  // namespace

Result<void> price(std::span<const FrontierPriced> all, std::span<const FrontierDrive> drives, bool loads,
                   Frontier& frontier) {
  if (all.empty()) return fail("frontier: no method is left to be measured; choose others");
  const FrontierRequest& request = frontier.request;
  std::vector<Meter> meters(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    meters[i].crowd = crowd_of(all[i], drives, loads, Stiffness::individual, request);
  }
  Meter shared{crowd_of(all.front(), drives, loads, Stiffness::shared, request), {}, {}};
  const auto has_choice = [&](std::size_t i) { return all[i].rung->method.reduced() && all[i].rung->method.moving(); };
  for (int round = 0; round < request.rounds; ++round) {
    request.progress(loads ? "costs with the frame's loads" : "costs", static_cast<double>(round) / request.rounds);
    for (std::size_t i = 0; i < all.size(); ++i) meters[i].measure_once(has_choice(i));
    if (!loads) shared.measure_once(false);
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Meter& meter = meters[i];
    if (!meter.crowd->finite()) {
      return fail(
          fmt::format("frontier: {} of {}: a displacement is not a number", all[i].row->method, all[i].row->cells));
    }
    FrontierRow& row = *all[i].row;
    row.cost_us = meter.us(meter.ticks);
    row.points_us = has_choice(i) ? meter.us(meter.points) : row.cost_us;
    row.memory_bytes = meter.crowd->bytes_each();
    row.dt_s = frontier_tick_s / meter.crowd->steps_a_tick();
    row.ratio = all.front().row->cost_us / row.cost_us;
    row.points_ratio = all.front().row->cost_us / row.points_us;
    const bool least = frontier.least_muscles == 0 || meter.crowd->muscles() < frontier.least_muscles;
    if (least) frontier.least_muscles = meter.crowd->muscles();
  }
  if (!loads) frontier.shared_us = shared.us(shared.ticks);
  return {};
}

}  // namespace mobil
