#include "demo/crowd/crowd_run.h"

#include <algorithm>
#include <cmath>

#include <mobil/components/fade.h>
#include <mobil/schedule.h>
#include "demo/crowd/heap_count.h"
#include "demo/measure/measure.h"

namespace mobil {
namespace {

constexpr std::size_t hash_every = 60;  // ticks
constexpr double live_every_s = 0.25;

/// Muscles that fade after a change of method; when that ends the row is made anew.
std::size_t fading(const World& world) {
  std::size_t rows = 0;
  for (const Table& table : world.tables()) {
    if (table.row_count() > 0 && find_part(table.key(), type_id<Fade<float>>()) != nullptr) rows += table.row_count();
  }
  return rows;
}

/// One tick, and what it took of heap.
Result<void> measured_tick(CrowdScene& scene, CrowdRun& run) {
  CrowdTick tick;
  const std::size_t fading_before = fading(scene.simulation().world());
  start_heap_count();
  const double cpu_start = process_cpu_now_s(), start = wall_now_s();
  const auto decisions = scene.decide();
  const double decided = wall_now_s();
  const RelevanceReport chosen = scene.choose_methods();
  const double ready = wall_now_s();
  scene.tick();
  const double end = wall_now_s();
  tick.cpu_ms = 1e3 * (process_cpu_now_s() - cpu_start);
  const std::size_t allocations = stop_heap_count();
  if (!decisions) return tl::unexpected(decisions.error());
  tick.wall_ms = 1e3 * (end - start);
  tick.host_ms = 1e3 * (decided - start);
  tick.relevance_ms = 1e3 * (ready - decided);
  tick.steady = !decisions->structural() && chosen.switched + chosen.compacted + chosen.expanded == 0 &&
                fading(scene.simulation().world()) == fading_before;
  if (tick.steady) {
    ++run.steady_ticks;
    run.steady_allocations += allocations;
  }
  run.missed += tick.wall_ms > 1e3 * run.tick_s ? 1 : 0;
  run.spawned += decisions->spawned;
  run.despawned += decisions->despawned;
  run.turned += decisions->turned;
  run.changed_speed += decisions->changed_speed;
  run.switched += chosen.switched;
  run.refused += chosen.refused;
  run.ticks.push_back(tick);
  return {};
}

std::size_t row_bytes(const World& world, Entity entity) {
  const auto place = world.find(entity);
  return place ? place.table->block_bytes() / lane_count + sizeof(Entity) : 0;
}

}  // namespace

double percentile_ms(const std::vector<CrowdTick>& ticks, double part, double CrowdTick::*what) {
  if (ticks.empty()) return 0;
  std::vector<double> all(ticks.size());
  std::ranges::transform(ticks, all.begin(), what);
  const auto at = static_cast<std::size_t>(std::ceil(part * static_cast<double>(all.size())));
  const auto nth = all.begin() + static_cast<std::ptrdiff_t>(std::clamp<std::size_t>(at, 1, all.size()) - 1);
  std::nth_element(all.begin(), nth, all.end());
  return *nth;
}

double mean_ms(const std::vector<CrowdTick>& ticks, double CrowdTick::*what) {
  double sum = 0;
  for (const CrowdTick& tick : ticks) sum += tick.*what;
  return ticks.empty() ? 0 : sum / static_cast<double>(ticks.size());
}

std::vector<CrowdSystem> mean_systems(const Schedule& schedule, std::size_t ticks) {
  std::vector<CrowdSystem> all;
  for (std::size_t s = 0; s < schedule.systems().size(); ++s)
    all.push_back({schedule.systems()[s].name, 1e3 * schedule.timings()[s].seconds / static_cast<double>(ticks)});
  return all;
}

Result<CrowdRun> run_crowd(CrowdScene& scene, std::size_t ticks, bool hashes, const CrowdLive& live) {
  Simulation& simulation = scene.simulation();
  CrowdRun run;
  run.tick_s = simulation.tick_s();
  run.living = scene.request().effects.activation;
  run.ticks.reserve(ticks);
  simulation.schedule().reset_timings();
  double live_s = wall_now_s();
  for (std::size_t i = 0; i < ticks; ++i) {
    if (auto done = measured_tick(scene, run); !done) return tl::unexpected(done.error());
    if (hashes && (i + 1) % hash_every == 0) run.hashes.push_back(simulation.state_hash());
    if (!live || wall_now_s() < live_s) continue;
    run.muscles_by_rung = scene.muscles_by_rung();
    live(run, ticks);
    live_s = wall_now_s() + live_every_s;
  }
  run.muscles_by_rung = scene.muscles_by_rung();
  run.systems = mean_systems(simulation.schedule(), ticks);
  return run;
}

std::size_t far_bytes(const CrowdScene& scene) {
  const Simulation& simulation = scene.simulation();
  for (const CrowdWalker& walker : scene.walkers()) {
    if (walker.near && scene.request().near < scene.walkers().size()) continue;
    std::size_t bytes = sizeof(CrowdWalker) + row_bytes(simulation.world(), walker.entity);
    simulation.world().each_member(walker.entity,
                                   [&](Entity muscle) { bytes += row_bytes(simulation.world(), muscle); });
    return bytes;
  }
  return 0;
}

Result<CrowdLimit> raise_crowd(CrowdScene& scene, std::size_t ticks, std::size_t most,
                               const std::function<void(const CrowdLimit::Tried&)>& told,
                               const CrowdScene::Progress& progress) {
  constexpr int attempts = 3, halvings = 4;
  CrowdLimit limit;
  const auto keeps_up = [&](std::size_t humans) -> Result<bool> {
    if (auto done = scene.resize(humans, progress); !done) return tl::unexpected(done.error());
    if (auto done = scene.settle(progress); !done) return tl::unexpected(done.error());
    for (int attempt = 0; attempt < attempts; ++attempt) {
      const auto run = run_crowd(scene, ticks, false);
      if (!run) return tl::unexpected(run.error());
      const CrowdLimit::Tried tried = {humans,
                                       run->missed,
                                       ticks,
                                       percentile_ms(run->ticks, 0.5),
                                       percentile_ms(run->ticks, 0.99),
                                       percentile_ms(run->ticks, 1),
                                       percentile_ms(run->ticks, 0.5, &CrowdTick::cpu_ms)};
      limit.tried.push_back(tried);
      if (told) told(tried);
      if (run->missed == 0) return true;
      if (tried.p50_ms > 1e3 * run->tick_s) return false;  // no bad luck
    }
    return false;
  };
  for (std::size_t humans = scene.walkers().size();;) {
    const auto kept = keeps_up(humans);
    if (!kept) return tl::unexpected(kept.error());
    if (!*kept) {
      limit.missed_with = humans;
      break;
    }
    limit.humans = humans;
    if (humans == most) return limit;
    humans = std::min(2 * humans, most);
  }
  for (int i = 0; i < halvings && limit.missed_with - limit.humans > 1; ++i) {
    const std::size_t middle = (limit.humans + limit.missed_with) / 2;
    const auto kept = keeps_up(middle);
    if (!kept) return tl::unexpected(kept.error());
    (*kept ? limit.humans : limit.missed_with) = middle;
  }
  return limit;
}

}  // namespace mobil
