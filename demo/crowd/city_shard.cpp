#include "demo/crowd/city_shard.h"

#include <fmt/format.h>

#include <algorithm>

#include <mobil/lod.h>
#include <mobil/shard_bytes.h>
#include <mobil/step_report.h>
#include "demo/measure/machine.h"
#include "demo/measure/measure.h"
#include "demo/measure/phase_time.h"

namespace mobil {
namespace {

int threads_of_rank(const CrowdOptions& options) {
  return Threads(options.alive ? options.alive->threads : options.crowd.threads).count();
}

/// Return a rank's mean time per tick, working and waiting, ms.
double worked_ms(const CityPart& part) {
  return part.ticks.empty() ? 0 : 1e3 * part.report.worked_s / static_cast<double>(part.ticks.size());
}
double waited_ms(const CityPart& part) {
  return part.ticks.empty() ? 0 : 1e3 * part.report.waited_s / static_cast<double>(part.ticks.size());
}

double mean_wall_ms(const CityRun& run) {
  return run.ticks.empty() ? 0 : 1e3 * run.wall_s / static_cast<double>(run.ticks.size());
}

template <class Orders>
Result<Orders> read_orders(std::span<const std::byte> commands) {
  Orders orders{};
  if (commands.empty()) return orders;
  PlainReader reader(commands);
  reader.take(orders);
  if (!reader.whole()) return fail("the commands are not orders for this crowd");
  return orders;
}

void count(Simulation& simulation, CityCounts& counts) {
  const LodReport& report = simulation.lod().report();
  counts.lod_s += phase_s(simulation, "level of detail");
  counts.switched += report.switched;
  counts.refused += report.refused;
  counts.woken += report.woken;
  counts.slept += report.slept;
  counts.begun += report.begun;
}

class CrowdShard : public CityShard {
 public:
  CrowdShard(std::unique_ptr<CrowdScene> scene, std::size_t people, CityCounts& counts)
      : scene_(std::move(scene)), people_(people), counts_(counts) {}

  Simulation& simulation() override { return scene_->simulation(); }
  std::uint32_t ticks() const override { return std::as_const(*scene_).simulation().ticks(); }
  void tick() override {
    scene_->tick();
    count(scene_->simulation(), counts_);
  }
  std::uint64_t state_sum() const override { return std::as_const(*scene_).simulation().state_sum(); }
  Result<std::vector<std::byte>> save() const override { return scene_->save(); }
  Result<void> restore(std::span<const std::byte> saved) override { return scene_->restore(saved); }

  Result<void> populate() override {
    if (auto done = scene_->resize(people_); !done) return done;
    return scene_->settle({}, false);
  }

  Result<void> apply(std::span<const std::byte> commands) override {
    const auto orders = read_orders<CrowdOrders>(commands);
    if (!orders) return tl::unexpected(orders.error());
    const double start = wall_now_s();
    const auto decided = scene_->decide(*orders);
    if (!decided) return tl::unexpected(decided.error());
    counts_.host_s += wall_now_s() - start;
    counts_.spawned += decided->spawned;
    counts_.despawned += decided->despawned;
    counts_.turned += decided->turned;
    counts_.changed_speed += decided->changed_speed;
    return {};
  }

  CityState state() const override {
    CityState state{.people = scene_->walkers().size(), .bytes = scene_->bytes_of_people()};
    state.awake = state.people;
    for (const CrowdWalker& walker : scene_->walkers()) state.seen += walker.near ? 1 : 0;
    state.muscles_by_level = scene_->muscles_by_level();
    return state;
  }

  std::vector<CrowdCamera::Drawn> people() const override {
    std::vector<CrowdCamera::Drawn> all;
    for (const CrowdWalker& walker : scene_->walkers()) all.push_back({walker.entity, walker.number, walker.near});
    return all;
  }

 private:
  std::unique_ptr<CrowdScene> scene_;
  std::size_t people_;
  CityCounts& counts_;
};

class AliveShard : public CityShard {
 public:
  AliveShard(std::unique_ptr<AliveScene> scene, CityCounts& counts) : scene_(std::move(scene)), counts_(counts) {}

  Simulation& simulation() override { return scene_->simulation(); }
  std::uint32_t ticks() const override { return std::as_const(*scene_).simulation().ticks(); }
  Result<void> populate() override { return scene_->populate(); }
  void tick() override {
    scene_->tick();
    count(scene_->simulation(), counts_);
    if (refusal_.empty()) refusal_ = scene_->simulation().lod().report().refusal;
  }
  std::uint64_t state_sum() const override { return std::as_const(*scene_).simulation().state_sum(); }
  Result<std::vector<std::byte>> save() const override { return scene_->save(); }
  Result<void> restore(std::span<const std::byte> saved) override { return scene_->restore(saved); }

  Result<void> apply(std::span<const std::byte> commands) override {
    const auto orders = read_orders<Viewpoint>(commands);
    if (!orders) return tl::unexpected(orders.error());
    const double start = wall_now_s();
    const auto asked = scene_->decide(*orders);
    if (!asked) return tl::unexpected(asked.error());
    if (!refusal_.empty()) return fail(refusal_);
    counts_.host_s += wall_now_s() - start;
    counts_.asked += *asked;
    return {};
  }

  CityState state() const override {
    const AliveScene::Count now = scene_->count();
    return {.people = scene_->people(), .bytes = scene_->bytes_of_people(), .awake = now.awake, .seen = now.seen};
  }

  std::vector<CrowdCamera::Drawn> people() const override { return scene_->seen(); }

 private:
  std::unique_ptr<AliveScene> scene_;
  CityCounts& counts_;
  std::string refusal_;  // first error of a tick, returned by `apply`
};

}  // namespace

std::vector<std::byte> pack(const CityPart& part) {
  PlainBytes bytes;
  bytes.put(part.state);
  bytes.put(part.counts);
  bytes.put(part.report);
  bytes.put(part.peak_bytes);
  bytes.put(std::uint64_t{part.ticks.size()});
  bytes.put_all(std::span<const CrowdTick>(part.ticks));
  bytes.put(std::uint64_t{part.system_ms.size()});
  bytes.put_all(std::span<const double>(part.system_ms));
  return bytes.bytes();
}

Result<CityPart> unpack_part(std::span<const std::byte> bytes) {
  CityPart part;
  PlainReader reader(bytes);
  std::uint64_t count = 0;
  reader.take(part.state);
  reader.take(part.counts);
  reader.take(part.report);
  reader.take(part.peak_bytes);
  reader.take(count);
  part.ticks = reader.take_many<CrowdTick>(static_cast<std::size_t>(count));
  reader.take(count);
  part.system_ms = reader.take_many<double>(static_cast<std::size_t>(count));
  if (!reader.whole()) return fail("the report of a rank is inconsistent");
  return part;
}

void put_together(CityRun& run) {
  for (const CityPart& part : run.parts) {
    run.ticks.resize(std::max(run.ticks.size(), part.ticks.size()));
    for (std::size_t i = 0; i < part.ticks.size(); ++i) {
      CrowdTick& tick = run.ticks[i];
      tick.wall_ms = std::max(tick.wall_ms, part.ticks[i].wall_ms);
      tick.host_ms = std::max(tick.host_ms, part.ticks[i].host_ms);
      tick.lod_ms = std::max(tick.lod_ms, part.ticks[i].lod_ms);
      tick.cpu_ms += part.ticks[i].cpu_ms;
    }
    for (std::size_t s = 0; s < std::min(run.systems.size(), part.system_ms.size()); ++s)
      run.systems[s].mean_ms += part.system_ms[s];
    add(run.state, part.state);
    run.counts.spawned += part.counts.spawned;
    run.counts.despawned += part.counts.despawned;
    run.counts.turned += part.counts.turned;
    run.counts.changed_speed += part.counts.changed_speed;
    run.counts.asked += part.counts.asked;
    run.counts.switched += part.counts.switched;
    run.counts.refused += part.counts.refused;
    run.counts.woken += part.counts.woken;
    run.counts.slept += part.counts.slept;
    run.counts.begun += part.counts.begun;
    if (!part.ticks.empty())
      run.sent_bytes_a_tick += static_cast<double>(part.report.bytes_sent) / static_cast<double>(part.ticks.size());
  }
  run.missed = static_cast<std::size_t>(
      std::ranges::count_if(run.ticks, [&](const CrowdTick& tick) { return tick.wall_ms > 1e3 * run.tick_s; }));
}

std::string city_text(const CityRun& run, const CrowdOptions& options) {
  const std::size_t ranks = run.parts.size();
  const int threads = threads_of_rank(options);
  std::string text = fmt::format("{} {} on {:.0f} m x {:.0f} m, {} rank{} of {} thread{}, {} shards, seed {}\n",
                                 run.state.people, options.alive ? "people alive" : "people", run.side_m, run.side_m,
                                 ranks, ranks == 1 ? "" : "s", threads, threads == 1 ? "" : "s", options.cluster.shards,
                                 options.alive ? options.alive->seed : options.crowd.seed);
  text += ticks_line(run.ticks, run.tick_s, run.missed, ranks == 1 ? "" : " (slowest rank)");
  text += processor_line(run.ticks, "ranks");
  text += parts_line(run.ticks, run.systems, 5e-3);
  if (!options.alive) {
    text += "\nmuscles:";
    for (const auto& [method, count] : by_method(run.state.muscles_by_level, options.crowd.effects.activation))
      text += fmt::format(" {} {}", count, method);
    text += fmt::format("\n{} arrived, {} left; {} turned, {} changed speed, {} muscles changed method\n",
                        run.counts.spawned, run.counts.despawned, run.counts.turned, run.counts.changed_speed,
                        2 * run.counts.switched);
  } else {
    text += fmt::format(
        "\nat the end {} awake, {} of them seen; {} changes of gait, {} woke, {} fell asleep, {} got muscles\n",
        run.state.awake, run.state.seen, run.counts.asked, run.counts.woken, run.counts.slept, run.counts.begun);
  }
  text += "per tick, rank by rank: work";
  for (const CityPart& part : run.parts) text += fmt::format(" {:.2f}", worked_ms(part));
  text += " ms; wait";
  for (const CityPart& part : run.parts) text += fmt::format(" {:.2f}", waited_ms(part));
  std::uint64_t peak = 0, moved = 0, saved = 0;
  double saving_s = 0;
  for (const CityPart& part : run.parts) {
    peak += part.peak_bytes;
    moved = std::max<std::uint64_t>(moved, part.report.moved);
    saved += part.report.bytes_saved;
    saving_s = std::max(saving_s, part.report.saving_s);
  }
  text += fmt::format(" ms; total: {:.2f} ms per tick; sent: {:.0f} bytes per tick; {} shards moved\n",
                      mean_wall_ms(run), run.sent_bytes_a_tick, moved);
  if (saved > 0)
    text += fmt::format("{} snapshots, {:.1f} MB in {:.0f} ms\n", run.parts.front().report.snapshots,
                        1e-6 * static_cast<double>(saved), 1e3 * saving_s);
  text += fmt::format("memory: {} bytes per person; peak of all ranks {:.0f} MB\n",
                      run.state.bytes / std::max<std::uint64_t>(run.state.people, 1), 1e-6 * static_cast<double>(peak));
  if (!run.hashes.empty()) text += fmt::format("state hash {:016x} at tick {}\n", run.hashes.back(), run.last_tick);
  return text;
}

std::string city_json(const CityRun& run, const CrowdOptions& options) {
  Json json;
  json[options.alive ? "alive" : "people"] = run.state.people;
  json["ranks"] = run.parts.size();
  json["shards"] = options.cluster.shards;
  json["threads"] = threads_of_rank(options);
  json["seed"] = options.alive ? options.alive->seed : options.crowd.seed;
  json["seconds"] = options.seconds;
  json["tick_s"] = run.tick_s;
  json["side_m"] = run.side_m;
  json["first_tick"] = run.first_tick;
  json["last_tick"] = run.last_tick;
  add_ticks(run.ticks, run.missed, json);
  json["wall_ms_mean"] = mean_wall_ms(run);
  add_systems(run.systems, json);
  json["muscles_by_method"] = Json::object();
  for (const auto& [method, count] : by_method(run.state.muscles_by_level, options.crowd.effects.activation))
    json["muscles_by_method"][method] = count;
  json["spawns"] = run.counts.spawned;
  json["despawns"] = run.counts.despawned;
  json["turns"] = run.counts.turned;
  json["speed_changes"] = run.counts.changed_speed;
  json["asked"] = run.counts.asked;
  json["method_changes"] = 2 * run.counts.switched;
  json["refusals"] = run.counts.refused;
  json["woken"] = run.counts.woken;
  json["slept"] = run.counts.slept;
  json["got_muscles"] = run.counts.begun;
  json["awake"] = run.state.awake;
  json["seen"] = run.state.seen;
  json["bytes_per_person"] = run.state.bytes / std::max<std::uint64_t>(run.state.people, 1);
  json["sent_bytes_a_tick"] = run.sent_bytes_a_tick;
  json["of_rank"] = Json::array();
  for (const CityPart& part : run.parts) {
    json["of_rank"].push_back({{"people", part.state.people},
                               {"worked_ms", worked_ms(part)},
                               {"waited_ms", waited_ms(part)},
                               {"cpu_ms", mean_ms(part.ticks, &CrowdTick::cpu_ms)},
                               {"bytes_sent", part.report.bytes_sent},
                               {"bytes_saved", part.report.bytes_saved},
                               {"saving_ms", 1e3 * part.report.saving_s},
                               {"snapshots", part.report.snapshots},
                               {"replayed_ticks", part.report.replayed},
                               {"shards_moved", part.report.moved},
                               {"peak_bytes", part.peak_bytes}});
  }
  json["state_hash"] = Json::array();
  for (const std::uint64_t hash : run.hashes) json["state_hash"].push_back(fmt::format("{:016x}", hash));
  json["machine"] = machine_json(describe_machine());
  return json.dump(2) + "\n";
}

void add(CityState& to, const CityState& more) {
  to.people += more.people;
  to.bytes += more.bytes;
  to.awake += more.awake;
  to.seen += more.seen;
  for (std::size_t r = 0; r < to.muscles_by_level.size(); ++r) to.muscles_by_level[r] += more.muscles_by_level[r];
}

Cluster::Make city_shards(const CrowdOptions& options, const Simulation& library, CityCounts& counts) {
  return [&](std::uint32_t shard) -> Result<std::unique_ptr<Shard>> {
    if (options.alive) {
      AliveRequest request = *options.alive;
      request.shard = shard;
      request.shards = options.cluster.shards;
      request.library = &library;
      auto scene = AliveScene::make_empty(request);
      if (!scene) return tl::unexpected(scene.error());
      return std::make_unique<AliveShard>(std::move(*scene), counts);
    }
    CrowdRequest request = options.crowd;
    request.shard = shard;
    request.shards = options.cluster.shards;
    request.library = &library;
    auto scene = CrowdScene::make_empty(request);
    if (!scene) return tl::unexpected(scene.error());
    return std::make_unique<CrowdShard>(std::move(*scene), options.crowd.people, counts);
  };
}

}  // namespace mobil
