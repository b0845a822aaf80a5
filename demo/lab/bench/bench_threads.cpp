// One crowd ticked by 1, 2, 4, … threads, and a model of it for machines of more cores.

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "demo/lab/bench/bench.h"
#include "demo/lab/bench/bench_crowd_scene.h"

namespace mobil {
namespace {

/// T(n) = serial + parallel·cost(n)/n + loops·fork(n). `cost` is what a system takes of all threads' time over what it
/// takes of one, `fork` what handing a loop out takes; both are measured up to the cores that there are. Beyond, cost
/// stays and fork grows with log₂(n), as a tree that wakes threads does: speedups there are at most those.
struct ThreadModel {
  double serial_s = 0, parallel_s = 0, loops = 0;
  std::map<int, double> cost, fork_s;  // of two threads and more

  double tick_s(int threads) const {
    if (threads == 1 || cost.empty()) return serial_s + parallel_s;
    const auto at = [threads](const std::map<int, double>& measured) {
      const auto more = measured.upper_bound(threads);
      return more == measured.begin() ? *more : *std::prev(more);
    };
    const auto [most, fork] = at(fork_s);
    const double deeper = std::log2(threads) / std::log2(most);
    return serial_s + parallel_s * at(cost).second / threads + loops * fork * deeper;
  }
  double speedup(int threads) const { return tick_s(1) / tick_s(threads); }
};

/// Seconds from handing out as many bodies as there are threads until all are done, beyond what a body takes: median.
double fork_s(const Threads& pool) {
  static constexpr double body_s = 20e-6;
  const Jobs jobs = pool.jobs();
  std::vector<double> beyond;
  for (int round = 0; round < 500; ++round) {
    const double start_s = wall_now_s();
    jobs.parallel_for(
        jobs.user, jobs.threads,
        [](void*, std::size_t begin, std::size_t end) {
          const double until_s = wall_now_s() + body_s * static_cast<double>(end - begin);
          while (wall_now_s() < until_s) {
          }
        },
        nullptr);
    beyond.push_back(wall_now_s() - start_s - body_s);
  }
  return median(beyond);
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
                    .cost = {},
                    .fork_s = {}};
  for (const auto& [threads, tick] : ticks) {
    if (threads == 1) continue;
    model.cost[threads] = of_systems(tick) / of_systems(alone);
    model.fork_s[threads] = fork_s(scene.pool(threads));
  }
  const auto figure = [&](const std::string& what, double value, const std::string& unit, std::string bound) {
    run.add_figure(fmt::format("threads.{}.{}", name, what), value, unit, std::move(bound));
  };
  figure(
      "serial_share", alone.serial_share, "1",
      fmt::format("of {:.2f} ms by one thread; {:.0f} loops a tick are shared out", alone.wall_s * 1e3, alone.loops));
  for (const auto& [threads, seconds] : model.fork_s)
    figure(fmt::format("{}.fork_us", threads), seconds * 1e6, "us", "handing a loop out, and waiting for its end");
  for (const auto& [threads, tick] : ticks) {
    if (threads == 1) continue;
    figure(fmt::format("{}.speedup", threads), alone.wall_s / tick.wall_s, "1",
           fmt::format("{:.2f} ms, median {:.2f}; processor time of the systems {:.2f} times one thread's",
                       tick.wall_s * 1e3, tick.wall_median_s * 1e3, model.cost[threads]));
  }
  for (const int threads : {2, 16, 64}) {
    figure(fmt::format("{}.speedup_predicted", threads), model.speedup(threads), "1",
           fmt::format("at most, by the model: {:.2f} ms", model.tick_s(threads) * 1e3));
  }
}

}  // namespace

Result<void> bench_threads(BenchRun& run) {
  BenchScene scene(bench_reduced_muscles());
  if (auto done = scene.grow_to(run.humans); !done) return done;
  measure_scene(run, scene, "unseen");
  if (auto done = scene.compact(); !done) return done;
  measure_scene(run, scene, "compact");
  return {};
}

}  // namespace mobil
