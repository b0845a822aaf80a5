// One crowd ticked by 1, 2, 4, … threads, and a model of it whose parameters are measured, for machines of more cores.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>

#include "demo/bench/bench.h"
#include "demo/bench/bench_crowd_scene.h"
#include "demo/bench/bench_fem.h"

namespace mobil {
namespace {

/// T(n) = serial + parallel·cost(n)/n + loops·fork(n). `cost` is what a system takes of all threads' time over what it
/// takes of one; of more threads than there are cores here it is taken for that of all cores. `fork` is what handing
/// out takes, and grows as the tree by which threads are woken: in proportion to log₂(n).
struct ThreadModel {
  double serial_s = 0, parallel_s = 0, loops = 0, fork_s = 0;  // fork_s: of two threads
  std::map<int, double> cost;

  double tick_s(int threads) const {
    if (threads == 1) return serial_s + parallel_s;
    const auto more = cost.upper_bound(threads);
    const double shared = more == cost.begin() ? 1 : std::prev(more)->second;
    return serial_s + parallel_s * shared / threads + loops * fork_s * std::log2(threads);
  }
  double speedup(int threads) const { return tick_s(1) / tick_s(threads); }
};

/// Seconds that an empty loop takes, the least of many.
double fork_s(const Threads& pool) {
  constexpr int loops = 200;
  const Jobs jobs = pool.jobs();
  double least = 1e9;
  for (int round = 0; round < 50; ++round) {
    const double start_s = wall_now_s();
    for (int i = 0; i < loops; ++i) {
      jobs.parallel_for(
          jobs.user, 4 * jobs.threads, [](void*, std::size_t, std::size_t) {}, nullptr);
    }
    least = std::min(least, (wall_now_s() - start_s) / loops);
  }
  return least;
}

double of_systems(const BenchTick& tick) {
  return std::accumulate(tick.system_s.begin(), tick.system_s.end(), 0.0);
}

void measure_scene(BenchRun& run, BenchScene& scene, const std::string& name) {
  const int cores = Threads().count();
  std::map<int, BenchTick> ticks;
  for (int threads = 1; threads < cores; threads *= 2) ticks[threads];
  ticks[cores];
  for (int round = 0; round < run.rounds(15); ++round) {
    for (auto& [threads, tick] : ticks) scene.measure(threads, 10, tick);
  }
  const BenchTick& alone = ticks[1];
  ThreadModel model{.serial_s = alone.serial_share * alone.wall_s,
                    .parallel_s = (1 - alone.serial_share) * alone.wall_s,
                    .loops = alone.loops,
                    .fork_s = cores > 1 ? fork_s(scene.pool(2)) : 0,
                    .cost = {}};
  for (const auto& [threads, tick] : ticks) model.cost[threads] = of_systems(tick) / of_systems(alone);
  const auto figure = [&](const std::string& what, double value, const std::string& unit, std::string bound) {
    add_figure(run, fmt::format("threads.{}.{}", name, what), value, unit, std::move(bound));
  };
  figure(
      "serial_share", alone.serial_share, "1",
      fmt::format("of {:.2f} ms by one thread; {:.0f} loops a tick are shared out", alone.wall_s * 1e3, alone.loops));
  if (cores > 1) figure("fork_us", model.fork_s * 1e6, "us", "an empty loop of two threads");
  for (const auto& [threads, tick] : ticks) {
    if (threads == 1) continue;
    figure(fmt::format("{}.speedup", threads), alone.wall_s / tick.wall_s, "1",
           fmt::format("{:.2f} ms, median {:.2f}; processor time of the systems {:.2f} times one thread's",
                       tick.wall_s * 1e3, tick.wall_median_s * 1e3, model.cost[threads]));
  }
  for (const int threads : {2, 16, 64}) {
    figure(fmt::format("{}.speedup_predicted", threads), model.speedup(threads), "1",
           fmt::format("by the model, where memory keeps up: {:.2f} ms", model.tick_s(threads) * 1e3));
  }
}

}  // namespace

Result<void> bench_threads(BenchRun& run) {
  BenchScene scene(bench_reduced_muscles(false));
  if (auto done = scene.grow_to(run.humans); !done) return done;
  measure_scene(run, scene, "unseen");
  if (auto done = scene.compact(); !done) return done;
  measure_scene(run, scene, "compact");
  return {};
}

}  // namespace mobil
