#include "demo/crowd/alive_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include <mobil/assets/files/output_file.h>
#include <mobil/components/relevance.h>
#include <mobil/png.h>
#include <mobil/schedule.h>
#include "demo/crowd/alive_scene.h"
#include "demo/crowd/crowd_picture.h"
#include "demo/crowd/crowd_report.h"
#include "demo/crowd/crowd_run.h"
#include "demo/measure/machine.h"
#include "demo/measure/measure.h"
#include "demo/program/commands.h"
#include "demo/program/json.h"
#include "demo/program/progress.h"

namespace mobil {
namespace {

constexpr std::size_t count_every = 30, hash_each = 60;  // ticks

/// All that was measured, sums over all ticks.
struct AliveRun {
  std::vector<CrowdTick> ticks;
  std::vector<std::size_t> cut_ticks;  // from a cut until nobody is left to wake
  std::size_t missed = 0, asked = 0, woken = 0, slept = 0, begun = 0, most_woken = 0;
  double awake = 0, seen = 0, counted = 0;
  std::vector<CrowdSystem> systems;
  std::vector<std::uint64_t> hashes;
};

Result<void> take_picture(const CrowdOptions& options, AliveScene& scene, CrowdCamera& camera, std::size_t number) {
  Image image;
  if (auto done = camera.take(scene.simulation(), picture_from(scene.camera()), scene.seen(), image); !done)
    return done;
  const auto file = numbered(options.capture, number);
  if (auto done = write_png(file.string(), image, PngEffort::small); !done)
    return fail("--capture " + done.error().message);
  say_written(file);
  return {};
}

Result<AliveRun> measure(const CrowdOptions& options, AliveScene& scene) {
  AliveRun run;
  const double tick_s = scene.simulation().tick_s();
  const auto ticks = static_cast<std::size_t>(std::max(1L, std::lround(options.seconds / tick_s)));
  std::optional<CrowdCamera> camera;
  if (!options.capture.empty()) {
    auto made = CrowdCamera::create();
    if (!made) return tl::unexpected(made.error());
    camera = std::move(*made);
  }
  run.ticks.reserve(ticks);
  scene.simulation().schedule().reset_timings();
  std::size_t since_cut = 0, taken = 0;
  for (std::size_t i = 0; i < ticks; ++i) {
    CrowdTick tick;
    const double cpu_start = process_cpu_now_s(), start = wall_now_s();
    const auto asked = scene.decide();
    const double decided = wall_now_s();
    if (!asked) return tl::unexpected(asked.error());
    const RelevanceReport report = scene.choose();
    const double ready = wall_now_s();
    scene.tick();
    const double end = wall_now_s();
    if (report.refused > 0) return fail(report.refusal);
    tick.cpu_ms = 1e3 * (process_cpu_now_s() - cpu_start);
    tick.wall_ms = 1e3 * (end - start);
    tick.host_ms = 1e3 * (decided - start);
    tick.relevance_ms = 1e3 * (ready - decided);
    run.ticks.push_back(tick);
    run.missed += tick.wall_ms > 1e3 * tick_s ? 1 : 0;
    run.asked += *asked;
    run.woken += report.woken;
    run.slept += report.slept;
    run.begun += report.begun;
    run.most_woken = std::max(run.most_woken, report.woken);
    if (scene.cut()) since_cut = 1;
    if (since_cut > 0 && report.to_wake == 0) {
      run.cut_ticks.push_back(since_cut);
      since_cut = 0;
    }
    since_cut += since_cut > 0 ? 1 : 0;
    if (i % count_every == count_every - 1) {
      const AliveScene::Count count = scene.count();
      run.awake += static_cast<double>(count.awake);
      run.seen += static_cast<double>(count.seen);
      ++run.counted;
      show(fmt::format("tick {}/{}  p50 {:.2f} ms  p99 {:.2f} ms  missed {}  awake {}  seen {}", i + 1, ticks,
                       percentile_ms(run.ticks, 0.5), percentile_ms(run.ticks, 0.99), run.missed, count.awake,
                       count.seen));
    }
    if ((i + 1) % hash_each == 0 && options.seconds <= 10) run.hashes.push_back(scene.simulation().state_hash());
    if (camera && taken < alive_pictures && i + 1 == alive_picture_tick(taken, ticks)) {
      show("");
      if (auto done = take_picture(options, scene, *camera, ++taken); !done) return tl::unexpected(done.error());
    }
  }
  show("");
  run.systems = mean_systems(scene.simulation().schedule(), ticks);
  return run;
}

std::string text_of(const AliveRun& run, const AliveScene& scene, int threads) {
  const auto a_tick = [&](std::size_t sum) { return static_cast<double>(sum) / static_cast<double>(run.ticks.size()); };
  std::string text = fmt::format(
      "{} people alive on {:.0f} m x {:.0f} m, {} thread{}, seed {}; who is within {:.0f} m in a cone of 60 degrees is "
      "seen\n",
      scene.request().alive, scene.side_m(), scene.side_m(), threads, threads == 1 ? "" : "s", scene.request().seed,
      scene.camera().reach_m);
  text += fmt::format("{:.0f} awake, {:.0f} of them seen (mean); asleep {:.1f} bytes each, and {} of the host's\n",
                      run.awake / std::max(run.counted, 1.0), run.seen / std::max(run.counted, 1.0),
                      scene.bytes_asleep(), scene.host_bytes());
  text += ticks_line(run.ticks, scene.simulation().tick_s(), run.missed);
  text += fmt::format(
      "a tick, mean: {:.0f} people asked for something, {:.1f} woke ({} at most), {:.1f} fell asleep, {:.1f} got "
      "muscles\n",
      a_tick(run.asked), a_tick(run.woken), run.most_woken, a_tick(run.slept), a_tick(run.begun));
  if (!run.cut_ticks.empty())
    text += fmt::format("{} cuts: everybody to be seen awake within {} ticks\n", run.cut_ticks.size(),
                        *std::ranges::max_element(run.cut_ticks));
  text += fmt::format("a tick, mean: host's decisions {:.3f} ms, waking and choosing {:.3f} ms",
                      mean_ms(run.ticks, &CrowdTick::host_ms), mean_ms(run.ticks, &CrowdTick::relevance_ms));
  for (const CrowdSystem& system : run.systems)
    if (system.mean_ms >= 5e-3) text += fmt::format(", {} {:.3f} ms", system.name, system.mean_ms);
  return text + "\n";
}

std::string json_of(const AliveRun& run, const AliveScene& scene, const CrowdOptions& options, int threads) {
  Json json;
  json["alive"] = scene.request().alive;
  json["in_view"] = scene.request().in_view;
  json["side_m"] = scene.side_m();
  json["reach_m"] = scene.camera().reach_m;
  json["seconds"] = options.seconds;
  json["seed"] = scene.request().seed;
  json["threads"] = threads;
  json["awake_mean"] = run.awake / std::max(run.counted, 1.0);
  json["seen_mean"] = run.seen / std::max(run.counted, 1.0);
  json["bytes_asleep"] = scene.bytes_asleep();
  json["host_bytes"] = scene.host_bytes();
  add_ticks(run.ticks, run.missed, json);
  json["asked"] = run.asked;
  json["woken"] = run.woken;
  json["most_woken"] = run.most_woken;
  json["slept"] = run.slept;
  json["got_muscles"] = run.begun;
  json["cut_ticks"] = run.cut_ticks;
  add_systems(run.systems, json);
  json["state_hash"] = Json::array();
  for (const std::uint64_t hash : run.hashes) json["state_hash"].push_back(fmt::format("{:016x}", hash));
  json["machine"] = machine_json(describe_machine());
  return json.dump(2) + "\n";
}

}  // namespace

std::filesystem::path numbered(const std::filesystem::path& file, std::size_t number) {
  return file.parent_path() / fmt::format("{}_{}{}", file.stem().string(), number, file.extension().string());
}

Result<void> run_alive(const CrowdOptions& options) {
  auto made = AliveScene::make(*options.alive, show_progress);
  if (!made) return tl::unexpected(made.error());
  AliveScene& scene = **made;
  const auto run = measure(options, scene);
  if (!run) return tl::unexpected(run.error());
  const int threads = Threads(options.alive->threads).count();
  fmt::print("{}", text_of(*run, scene, threads));
  if (options.report.empty()) return {};
  return write_result("--report", options.report, json_of(*run, scene, options, threads));
}

}  // namespace mobil
