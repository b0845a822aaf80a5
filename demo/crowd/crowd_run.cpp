#include "demo/crowd/crowd_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include <mobil/components/fade.h>
#include <mobil/engine/world.h>
#include <mobil/lod.h>
#include <mobil/schedule.h>
#include <mobil/step_report.h>
#include "demo/crowd/heap_count.h"
#include "demo/measure/machine.h"
#include "demo/measure/measure.h"
#include "demo/measure/phase_time.h"

namespace mobil {
namespace {

constexpr std::size_t hash_every = 60;  // ticks
constexpr double live_every_s = 0.25;

/// Returns the number of muscles that fade after a change of method. Their archetype changes when the fade ends.
std::size_t fading(const World& world) {
  std::size_t rows = 0;
  for (const Table& table : world.tables()) {
    if (table.row_count() > 0 && find_component(table.key(), type_id<Fade<float>>()) != nullptr)
      rows += table.row_count();
  }
  return rows;
}

/// Runs one tick and adds its times, events and heap requests to the run.
Result<void> measured_tick(CrowdScene& scene, CrowdRun& run) {
  CrowdTick tick;
  const std::size_t fading_before = fading(scene.simulation().world());
  start_heap_count();
  const double cpu_start = process_cpu_now_s(), start = wall_now_s();
  const auto decisions = scene.decide();
  const double decided = wall_now_s();
  scene.tick();
  const double end = wall_now_s();
  tick.cpu_ms = 1e3 * (process_cpu_now_s() - cpu_start);
  const std::size_t allocations = stop_heap_count();
  if (!decisions) return tl::unexpected(decisions.error());
  const LodReport& chosen = scene.simulation().lod().report();
  tick.wall_ms = 1e3 * (end - start);
  tick.host_ms = 1e3 * (decided - start);
  tick.lod_ms = 1e3 * phase_s(scene.simulation(), "level of detail");
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

Json options_json(const CrowdOptions& options) {
  const CrowdRequest& crowd = options.crowd;
  Json json;
  json["seconds"] = options.seconds;
  json["tolerance_mm"] = 1e3 * crowd.tolerance_m;
  json["near"] = crowd.near;
  json["near_tolerance_mm"] = 1e3 * crowd.near_tolerance_m;
  json["budget_ms"] = crowd.budget_s ? Json(1e3 * *crowd.budget_s) : Json(nullptr);
  json["effects"] = Json::array();
  for (const auto& [name, on] :
       {std::pair("muscles", crowd.effects.muscles), std::pair("forces", crowd.effects.forces),
        std::pair("inertia", crowd.effects.inertia), std::pair("line-motion", crowd.effects.line_motion),
        std::pair("activation", crowd.effects.activation), std::pair("avoidance", crowd.effects.avoidance)}) {
    if (on) json["effects"].push_back(name);
  }
  json["muscles"] = muscle_list(crowd.muscles);
  json["churn_per_s"] = crowd.churn_per_s;
  json["burst"] = crowd.burst;
  json["all_seen"] = crowd.all_seen;
  return json;
}

std::size_t threads_of(const CrowdRequest& crowd) {
  return static_cast<std::size_t>(Threads(crowd.threads).count());
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
  run.active = scene.request().effects.activation;
  run.ticks.reserve(ticks);
  simulation.schedule().reset_timings();
  double live_s = wall_now_s();
  for (std::size_t i = 0; i < ticks; ++i) {
    if (auto done = measured_tick(scene, run); !done) return tl::unexpected(done.error());
    if (hashes && ((i + 1) % hash_every == 0 || i + 1 == ticks)) run.hashes.push_back(simulation.state_hash());
    if (!live || wall_now_s() < live_s) continue;
    run.muscles_by_level = scene.muscles_by_level();
    live(run, ticks);
    live_s = wall_now_s() + live_every_s;
  }
  run.muscles_by_level = scene.muscles_by_level();
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
  const auto keeps_up = [&](std::size_t people) -> Result<bool> {
    if (auto done = scene.resize(people, progress); !done) return tl::unexpected(done.error());
    if (auto done = scene.settle(progress); !done) return tl::unexpected(done.error());
    for (int attempt = 0; attempt < attempts; ++attempt) {
      const auto run = run_crowd(scene, ticks, false);
      if (!run) return tl::unexpected(run.error());
      const CrowdLimit::Tried tried = {people,
                                       run->missed,
                                       ticks,
                                       percentile_ms(run->ticks, 0.5),
                                       percentile_ms(run->ticks, 0.99),
                                       percentile_ms(run->ticks, 1),
                                       percentile_ms(run->ticks, 0.5, &CrowdTick::cpu_ms)};
      limit.tried.push_back(tried);
      if (told) told(tried);
      if (run->missed == 0) return true;
      if (tried.p50_ms > 1e3 * run->tick_s) return false;  // not an outlier
    }
    return false;
  };
  for (std::size_t people = scene.walkers().size();;) {
    const auto kept = keeps_up(people);
    if (!kept) return tl::unexpected(kept.error());
    if (!*kept) {
      limit.missed_with = people;
      break;
    }
    limit.people = people;
    if (people == most) return limit;
    people = std::min(2 * people, most);
  }
  for (int i = 0; i < halvings && limit.missed_with - limit.people > 1; ++i) {
    const std::size_t middle = (limit.people + limit.missed_with) / 2;
    const auto kept = keeps_up(middle);
    if (!kept) return tl::unexpected(kept.error());
    (*kept ? limit.people : limit.missed_with) = middle;
  }
  return limit;
}

std::size_t peak_bytes() {
  std::ifstream status("/proc/self/status");
  std::string word;
  std::size_t kib = 0;
  while (status >> word) {
    if (word == "VmHWM:" && status >> kib) return 1024 * kib;
  }
  return 0;
}

CrowdMemory crowd_memory(const CrowdScene& scene) {
  CrowdMemory memory;
  if (!scene.walkers().empty()) memory.per_person = scene.bytes_of_people() / scene.walkers().size();
  memory.far_person = far_bytes(scene);
  memory.peak = peak_bytes();
  return memory;
}

std::string crowd_live_line(const CrowdRun& run, std::size_t of) {
  std::string line = fmt::format("tick {}/{}  p50 {:.2f} ms  p99 {:.2f} ms  missed {}", run.ticks.size(), of,
                                 percentile_ms(run.ticks, 0.5), percentile_ms(run.ticks, 0.99), run.missed);
  for (const auto& [method, count] : by_method(run.muscles_by_level, run.active))
    line += fmt::format("  {} {}", method, count);
  return line;
}

std::string crowd_text(const CrowdRun& run, const CrowdMemory& memory, const CrowdScene& scene) {
  const CrowdRequest& crowd = scene.request();
  std::string text =
      fmt::format("{} people on {:.0f} m x {:.0f} m, {} thread{}, seed {}\n", scene.walkers().size(), scene.side_m(),
                  scene.side_m(), threads_of(crowd), threads_of(crowd) == 1 ? "" : "s", crowd.seed);
  text += ticks_line(run.ticks, run.tick_s, run.missed) + processor_line(run.ticks, "threads");
  text += parts_line(run.ticks, run.systems, 5e-4) + "\nmuscles:";
  for (const auto& [method, count] : by_method(run.muscles_by_level, run.active))
    text += fmt::format(" {} {}", count, method);
  text += fmt::format("\n{} arrived, {} left; {} turned, {} changed speed, {} muscles changed method\n", run.spawned,
                      run.despawned, run.turned, run.changed_speed, 2 * run.switched);
  text += fmt::format("memory: {} bytes per person, {} if far away; peak {:.0f} MB\n", memory.per_person,
                      memory.far_person, 1e-6 * static_cast<double>(memory.peak));
  if (heap_is_counted()) {
    text += fmt::format("heap: {} requests in the {} ticks without arrivals, departures or changes of method\n",
                        run.steady_allocations, run.steady_ticks);
  }
  return text;
}

std::string ticks_line(const std::vector<CrowdTick>& ticks, double tick_s, std::size_t missed, std::string_view of) {
  return fmt::format("{} ticks of {:.2f} ms: {} missed; p50 {:.2f} ms, p99 {:.2f} ms, longest {:.2f} ms{}\n",
                     ticks.size(), 1e3 * tick_s, missed, percentile_ms(ticks, 0.5), percentile_ms(ticks, 0.99),
                     percentile_ms(ticks, 1), of);
}

std::string processor_line(const std::vector<CrowdTick>& ticks, std::string_view of) {
  return fmt::format("processor time of all {}: p50 {:.2f} ms, p99 {:.2f} ms, longest {:.2f} ms per tick\n", of,
                     percentile_ms(ticks, 0.5, &CrowdTick::cpu_ms), percentile_ms(ticks, 0.99, &CrowdTick::cpu_ms),
                     percentile_ms(ticks, 1, &CrowdTick::cpu_ms));
}

std::string parts_line(const std::vector<CrowdTick>& ticks, const std::vector<CrowdSystem>& systems, double min_ms) {
  std::string line = fmt::format("mean tick: host's decisions {:.3f} ms, choice of methods {:.3f} ms",
                                 mean_ms(ticks, &CrowdTick::host_ms), mean_ms(ticks, &CrowdTick::lod_ms));
  for (const CrowdSystem& system : systems) {
    if (system.mean_ms >= min_ms) line += fmt::format(", {} {:.3f} ms", system.name, system.mean_ms);
  }
  return line;
}

std::vector<std::pair<std::string, std::size_t>> by_method(const MusclesByLevel& muscles, bool active) {
  std::vector<std::pair<std::string, std::size_t>> all;
  for (std::size_t r = 0; r < muscles.size(); ++r) {
    if (muscles[r] > 0) all.emplace_back(r < level_count ? levels_of(active)[r].name : "other", muscles[r]);
  }
  return all;
}

void add_ticks(const std::vector<CrowdTick>& ticks, std::size_t missed, Json& json) {
  json["ticks"] = ticks.size();
  json["missed_ticks"] = missed;
  json["tick_ms_p50"] = percentile_ms(ticks, 0.5);
  json["tick_ms_p99"] = percentile_ms(ticks, 0.99);
  json["tick_ms_max"] = percentile_ms(ticks, 1);
  json["tick_cpu_ms_p50"] = percentile_ms(ticks, 0.5, &CrowdTick::cpu_ms);
  json["tick_cpu_ms_p99"] = percentile_ms(ticks, 0.99, &CrowdTick::cpu_ms);
  json["tick_cpu_ms_max"] = percentile_ms(ticks, 1, &CrowdTick::cpu_ms);
  json["host_ms"] = mean_ms(ticks, &CrowdTick::host_ms);
  json["lod_ms"] = mean_ms(ticks, &CrowdTick::lod_ms);
}

void add_systems(const std::vector<CrowdSystem>& systems, Json& json) {
  json["system_ms"] = Json::object();
  for (const CrowdSystem& system : systems) json["system_ms"][system.name] = system.mean_ms;
}

std::string crowd_json(const CrowdRun& run, const CrowdMemory& memory, const CrowdScene& scene,
                       const CrowdOptions& options) {
  Json json;
  json["people"] = scene.walkers().size();
  json["muscles_by_method"] = Json::object();
  for (const auto& [method, count] : by_method(run.muscles_by_level, run.active))
    json["muscles_by_method"][method] = count;
  json["tick_s"] = run.tick_s;
  add_ticks(run.ticks, run.missed, json);
  add_systems(run.systems, json);
  json["bytes_per_person"] = memory.per_person;
  json["far_bytes_per_person"] = memory.far_person;
  json["peak_bytes"] = memory.peak;
  json["steady_allocations"] = heap_is_counted() ? Json(run.steady_allocations) : Json(nullptr);
  json["steady_ticks"] = run.steady_ticks;
  json["spawns"] = run.spawned;
  json["despawns"] = run.despawned;
  json["turns"] = run.turned;
  json["speed_changes"] = run.changed_speed;
  json["method_changes"] = 2 * run.switched;
  json["refusals"] = run.refused;
  json["state_hash"] = Json::array();
  for (const std::uint64_t hash : run.hashes) json["state_hash"].push_back(fmt::format("{:016x}", hash));
  json["threads"] = threads_of(options.crowd);
  json["seed"] = options.crowd.seed;
  json["options"] = options_json(options);
  json["machine"] = machine_json(describe_machine());
  return json.dump(2) + "\n";
}

std::string tried_line(const CrowdLimit::Tried& tried) {
  return fmt::format(
      "{:>7} people: {} of {} ticks missed; p50 {:.2f} ms, p99 {:.2f} ms, longest {:.2f} ms; processor "
      "time p50 {:.2f} ms",
      tried.people, tried.missed, tried.ticks, tried.p50_ms, tried.p99_ms, tried.max_ms, tried.cpu_p50_ms);
}

std::string limit_text(const CrowdLimit& limit) {
  if (limit.people == 0) return fmt::format("{} people already miss ticks; start with fewer\n", limit.missed_with);
  if (limit.missed_with == 0) return fmt::format("{} people, the maximum: no tick missed\n", limit.people);
  return fmt::format("{} people: no tick missed; {}: missed\n", limit.people, limit.missed_with);
}

std::string limit_json(const CrowdLimit& limit, const CrowdOptions& options) {
  Json json;
  json["people"] = limit.people;
  json["missed_with"] = limit.missed_with;
  json["tried"] = Json::array();
  for (const CrowdLimit::Tried& t : limit.tried) {
    json["tried"].push_back({{"people", t.people},
                             {"missed_ticks", t.missed},
                             {"ticks", t.ticks},
                             {"tick_ms_p50", t.p50_ms},
                             {"tick_ms_p99", t.p99_ms},
                             {"tick_ms_max", t.max_ms},
                             {"tick_cpu_ms_p50", t.cpu_p50_ms}});
  }
  json["threads"] = threads_of(options.crowd);
  json["seed"] = options.crowd.seed;
  json["options"] = options_json(options);
  json["machine"] = machine_json(describe_machine());
  return json.dump(2) + "\n";
}

}  // namespace mobil
