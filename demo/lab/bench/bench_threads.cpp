// Whole crowds: the cost of a person in a larger crowd and of spawning one; one crowd ticked by 1, 2, 4, … threads; and
// a model of it for machines with more cores.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>

#include <mobil/engine/jobs.h>
#include <mobil/engine/world.h>
#include <mobil/muscle_library.h>
#include <mobil/schedule.h>
#include <mobil/simulation.h>
#include "demo/lab/bench/bench.h"
#include "demo/scene/crowd_people.h"

namespace mobil {
namespace {

/// One tick: wall-clock time, processor time of this process, and each system's part of the latter in the order of the
/// schedule. Values are the minimum of all measured ticks, and the median. `serial_share` is the median fraction of
/// wall-clock time in which the tick's caller worked alone, `loops` the number of parallel loops of a tick.
struct BenchTick {
  double wall_s = 0, wall_median_s = 0, cpu_s = 0, cpu_median_s = 0;
  std::vector<double> system_s;
  double serial_share = 0, loops = 0;
};

constexpr int settling_ticks = 90;  // the second step shows that the third is like it

/// Returns twelve modes of the fine mesh, without viewers.
LegMuscles bench_modal_muscles() {
  LegMuscles choice;
  choice.method = Method::modal;
  choice.modal.control_points = false;
  choice.modal.reported = false;
  return choice;
}

/// People with leg muscles, a growing number of them in one world, ticked by any number of threads.
class BenchScene {
 public:
  static constexpr std::uint64_t seed = 1;

  explicit BenchScene(const LegMuscles& choice) : choice_(choice), simulation_({.jobs = jobs()}) {}
  BenchScene(const BenchScene&) = delete;
  BenchScene& operator=(const BenchScene&) = delete;

  /// Spawns the people of demo/scene/crowd_people.h up to this number, and ticks until they walk steadily. Errors:
  /// refusals of the simulation.
  void grow_to(std::size_t count) {
    constexpr std::size_t at_once = 1000;
    must(simulation_.muscle_library().prepare(choice_));
    std::vector<SpawnRequest> requests;
    std::vector<Entity> entities;
    double spent_s = 0;
    const std::size_t before = people_.size();
    while (people_.size() < count) {
      requests.clear();
      while (requests.size() < std::min(at_once, count - people_.size())) {
        std::uint8_t draw = 0;
        const auto person = must(crowd_walker(seed, drawn_++, draw));
        requests.push_back({.body = person.body, .gait = person.gait, .muscles = choice_});
      }
      entities.resize(requests.size());
      const double start_s = process_cpu_now_s();
      must(simulation_.spawn(requests, entities));
      spent_s += process_cpu_now_s() - start_s;
      people_.insert(people_.end(), entities.begin(), entities.end());
    }
    if (people_.size() > before) spawn_s_ = spent_s / static_cast<double>(people_.size() - before);
    for (int i = 0; i < settling_ticks; ++i) simulation_.tick();
  }
  /// Makes all people compact (PersonState::compact); `expand` makes them full again.
  void compact() {
    if (must(simulation_.set_state(people_, PersonState::compact)) < people_.size())
      throw Stopped("somebody does not become compact");
    simulation_.tick();
  }
  void expand() { must(simulation_.set_state(people_, PersonState::full)); }

  std::size_t size() const { return people_.size(); }
  /// Returns seconds of processor time per person of the last spawning.
  double spawn_s() const { return spawn_s_; }
  /// Returns bytes of the tables' rows per person.
  double bytes_per_person() const {
    std::size_t bytes = 0;
    for (const Table& table : simulation_.world().tables())
      bytes += table.row_count() * (table.block_bytes() / lane_count);
    return static_cast<double>(bytes) / static_cast<double>(size());
  }

  /// Measures ticks with this number of threads, at most as many as the machine has. Adds to the previous measurements.
  void measure(int threads, int ticks, BenchTick& best) {
    Schedule& schedule = simulation_.schedule();
    if (threads > 1) turn_.now = &pool(threads);
    Series& series = series_[threads];
    if (best.system_s.empty()) series = {};
    best.system_s.resize(schedule.systems().size(), 1e9);
    turn_.loops = 0;
    for (int i = 0; i < ticks; ++i) {
      turn_.handed_out_s = 0;
      const double wall = wall_now_s(), cpu = process_cpu_now_s();
      simulation_.tick();
      series.cpu.push_back(process_cpu_now_s() - cpu);
      series.wall.push_back(wall_now_s() - wall);
      series.serial_share.push_back(1 - turn_.handed_out_s / series.wall.back());
    }
    best.loops = static_cast<double>(turn_.loops) / ticks;
    // Reading a thread's clock after every block slows a small crowd's tick by a tenth or more. Systems are therefore
    // timed in ticks of their own.
    schedule.measure_with(&thread_cpu_now_s);
    for (int i = 0; i < ticks; ++i) {
      simulation_.tick();
      for (std::size_t s = 0; s < best.system_s.size(); ++s)
        best.system_s[s] = std::min(best.system_s[s], schedule.timings()[s].last_seconds);
    }
    schedule.measure_with(nullptr);
    turn_.now = nullptr;
    best.wall_s = std::ranges::min(series.wall);
    best.wall_median_s = median(series.wall);
    best.cpu_s = std::ranges::min(series.cpu);
    best.cpu_median_s = median(series.cpu);
    best.serial_share = median(series.serial_share);
  }
  /// Returns the pool that `measure` uses for more than one thread.
  const Threads& pool(int threads) { return pools_.try_emplace(threads, threads).first->second; }

 private:
  /// Runs the work on the pool whose turn it is, or directly without one, and counts the time.
  struct Turn {
    const Threads* now = nullptr;
    double handed_out_s = 0;
    std::size_t loops = 0;
  };
  Jobs jobs() {
    return {&turn_,
            [](void* user, std::size_t count, Jobs::Body body, void* context) {
              Turn& turn = *static_cast<Turn*>(user);
              const double start_s = wall_now_s();
              if (turn.now == nullptr) {
                body(context, 0, count);
              } else {
                const Jobs all = turn.now->jobs();
                all.parallel_for(all.user, count, body, context);
              }
              turn.handed_out_s += wall_now_s() - start_s;
              ++turn.loops;
            },
            static_cast<std::size_t>(Threads().count())};
  }

  LegMuscles choice_;
  std::map<int, Threads> pools_;
  Turn turn_;
  Simulation simulation_;
  std::vector<Entity> people_;
  std::size_t drawn_ = 0;
  double spawn_s_ = 0;
  struct Series {
    std::vector<double> wall, cpu, serial_share;
  };
  std::map<int, Series> series_;
};

/// T(n) = serial + parallel·cost(n)/n + loops·fork(n). `cost` is a system's time over all threads relative to its time
/// on one; `fork` is the time to distribute a loop. Both are measured up to the number of cores. Beyond it, cost is
/// constant and fork grows with log₂(n), as a tree that wakes threads does: speedups there are upper bounds.
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

/// Returns the median seconds from distributing a body to each thread until all are done, minus the time of a body.
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

/// Returns the number of ticks, fewer if each takes long.
int ticks_for(const BenchRun& run, std::size_t count) {
  return run.quick ? 5 : static_cast<int>(std::clamp<std::size_t>(2'000'000 / count, 20, 200));
}

/// Measures the processor time of a person's tick by one thread, us.
double measure_cost(BenchRun& run, BenchScene& scene, const std::string& ending) {
  BenchTick tick;
  scene.measure(1, ticks_for(run, scene.size()), tick);
  BenchResult& result =
      run.add_time(fmt::format("crowd.{}{}.us_per_person_tick", scene.size(), ending),
                   {tick.cpu_s, tick.cpu_median_s, tick.cpu_s}, static_cast<double>(scene.size()), 1e-6, "us");
  result.bound = fmt::format("processor time; the tick {:.2f} ms by the wall's clock, {:.0f} bytes of tables each",
                             tick.wall_median_s * 1e3, scene.bytes_per_person());
  return result.value;
}

}  // namespace

void bench_threads(BenchRun& run) {
  BenchScene scene(bench_modal_muscles());
  scene.grow_to(run.people);
  measure_scene(run, scene, "unseen");
  scene.compact();
  measure_scene(run, scene, "compact");
}

void bench_crowds(BenchRun& run) {
  const std::array sizes = {std::max<std::size_t>(16, run.people / 10), run.people,
                            std::min<std::size_t>(10 * run.people, 200'000)};
  std::array<double, 3> whole_us{}, compact_us{};
  BenchScene scene(bench_modal_muscles());
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    scene.grow_to(sizes[i]);
    whole_us[i] = measure_cost(run, scene, "");
    scene.compact();
    compact_us[i] = measure_cost(run, scene, ".compact");
    scene.expand();
  }
  run.add_figure("crowd.us_per_spawn", scene.spawn_s() * 1e6, "us",
                 "with eight muscles, a thousand at a time; processor time, what they share made before");
  const std::string among = fmt::format("a person's cost among {} over that among {}", sizes[2], sizes[0]);
  run.add_figure("crowd.large_over_small", whole_us[2] / whole_us[0], "1", among);
  run.add_figure("crowd.compact.large_over_small", compact_us[2] / compact_us[0], "1", among + ", everybody compact");
}

}  // namespace mobil
