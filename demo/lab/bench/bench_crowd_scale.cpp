// Crowds as a whole: whether a human costs more in a larger crowd, and what a human with muscles costs to spawn.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "demo/lab/bench/bench.h"
#include "demo/lab/bench/bench_crowd_scene.h"

namespace mobil {
namespace {

/// Few ticks where each is long.
int ticks_for(const BenchRun& run, std::size_t humans) {
  return run.quick ? 5 : static_cast<int>(std::clamp<std::size_t>(2'000'000 / humans, 20, 200));
}

/// Processor time of a human's tick by one thread, us.
double measure_cost(BenchRun& run, BenchScene& scene, const std::string& ending) {
  BenchTick tick;
  scene.measure(1, ticks_for(run, scene.size()), tick);
  BenchResult& result =
      run.add_time(fmt::format("crowd.{}{}.us_per_human_tick", scene.size(), ending),
                   {tick.cpu_s, tick.cpu_median_s, tick.cpu_s}, static_cast<double>(scene.size()), 1e-6, "us");
  result.bound = fmt::format("processor time; the tick {:.2f} ms by the wall's clock, {:.0f} bytes of tables each",
                             tick.wall_median_s * 1e3, scene.bytes_per_human());
  return result.value;
}

}  // namespace

Result<void> bench_crowds(BenchRun& run) {
  const std::array sizes = {std::max<std::size_t>(16, run.humans / 10), run.humans,
                            std::min<std::size_t>(10 * run.humans, 200'000)};
  std::array<double, 3> whole_us{}, compact_us{};
  BenchScene scene(bench_reduced_muscles());
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    if (auto done = scene.grow_to(sizes[i]); !done) return done;
    whole_us[i] = measure_cost(run, scene, "");
    if (auto done = scene.compact(); !done) return done;
    compact_us[i] = measure_cost(run, scene, ".compact");
    if (auto done = scene.expand(); !done) return done;
  }
  run.add_figure("crowd.us_per_spawn", scene.spawn_s() * 1e6, "us",
                 "with eight muscles, a thousand at a time; processor time, what they share made before");
  const std::string among = fmt::format("a human's cost among {} over that among {}", sizes[2], sizes[0]);
  run.add_figure("crowd.large_over_small", whole_us[2] / whole_us[0], "1", among);
  run.add_figure("crowd.compact.large_over_small", compact_us[2] / compact_us[0], "1", among + ", everybody compact");
  return {};
}

}  // namespace mobil
