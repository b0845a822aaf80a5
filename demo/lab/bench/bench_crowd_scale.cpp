// Crowds as a whole: whether a human costs more in a larger crowd, what a second thread is worth, how far the two
// largest systems are from what the machine can do, and what others' code takes for the muscles of a hundred.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <mobil/relevance.h>
#include <mobil/schedule.h>
#include "demo/lab/bench/bench.h"
#include "demo/lab/bench/bench_crowd_scene.h"
#include "demo/lab/bench/bench_fem.h"
#include "demo/lab/bench/bench_fem_rivals.h"

namespace mobil {
namespace {

constexpr std::size_t humans_beside_rivals = 100;

std::string stem_of(std::string_view system) {
  std::string stem;
  for (const char c : system) {
    if (c != ',') stem += c == ' ' ? '_' : c;
  }
  return stem;
}

/// Few ticks where each is long.
int ticks_for(const BenchRun& run, std::size_t humans) {
  return run.quick ? 5 : static_cast<int>(std::clamp<std::size_t>(2'000'000 / humans, 20, 200));
}

/// µs of processor time a human and tick, by one thread.
BenchTick measure_cost(BenchRun& run, BenchScene& scene, const std::string& name) {
  BenchTick tick;
  scene.measure(1, ticks_for(run, scene.size()), tick);
  const auto humans = static_cast<double>(scene.size());
  BenchResult& result = run.add_time(fmt::format("crowd.{}.us_per_human_tick", name),
                                     {tick.cpu_s, tick.cpu_median_s, tick.cpu_s}, humans, 1e-6, "us");
  result.bound = fmt::format("processor time; the tick {:.2f} ms by the wall's clock, {:.0f} bytes of tables each",
                             tick.wall_median_s * 1e3, scene.bytes_per_human());
  return tick;
}

/// The same of a crowd of whom nothing is seen.
Result<BenchTick> measure_compact(BenchRun& run, BenchScene& scene) {
  if (auto done = scene.compact(); !done) return tl::unexpected(done.error());
  const BenchTick tick = measure_cost(run, scene, fmt::format("{}.compact", scene.size()));
  if (auto done = scene.expand(); !done) return tl::unexpected(done.error());
  return tick;
}

/// Systems by what they take, the largest first.
std::vector<std::size_t> by_size(const BenchTick& tick) {
  std::vector<std::size_t> order(tick.system_s.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return tick.system_s[a] > tick.system_s[b]; });
  return order;
}

/// Arithmetic of one human and tick, with eight muscles: multiply-adds, and additions, products, quotients and roots
/// that are none. Counted instruction by instruction as the AVX-512 code of a steady tick runs.
struct Counted {
  std::string_view system;
  double fused, others;
};
constexpr std::array counted = {Counted{"lines of action", 2584, 3800}, Counted{"kinematics", 1943, 2092},
                                Counted{"centre of mass", 576, 864}, Counted{"deformation, reduced", 480, 400}};

/// Where the time goes, and the two largest systems against what bounds them.
void tell_systems(BenchRun& run, const BenchScene& scene, const Schedule& schedule, const BenchTick& tick,
                  const BenchTick& in_caches, double humans_in_caches) {
  const auto humans = static_cast<double>(scene.size());
  const double all_s = std::accumulate(tick.system_s.begin(), tick.system_s.end(), 0.0);
  const auto order = by_size(tick);
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const System& system = schedule.systems()[order[rank]];
    const double seconds = tick.system_s[order[rank]] / humans;
    if (tick.system_s[order[rank]] < 0.01 * all_s) break;
    const double bytes = scene.bytes_moved(system);
    BenchResult& result = run.results.emplace_back();
    result.name = fmt::format("crowd.system.{}.us_per_human_tick", stem_of(system.name));
    result.value = seconds * 1e6;
    result.unit = "us";
    result.bound = fmt::format("{:.0f} % of the systems; {:.0f} bytes", 100 * seconds * humans / all_s, bytes);
    if (rank >= 2) continue;
    result.of_bandwidth = bytes / seconds * 1e-9 / run.machine.bandwidth_gbps;
    const double cached_s = in_caches.system_s[order[rank]] / humans_in_caches;
    result.bound += fmt::format("; {:.2f} of it where the caches hold the crowd", cached_s / seconds);
    const auto* count = std::ranges::find(counted, std::string_view(system.name), &Counted::system);
    if (count == counted.end()) continue;
    result.of_peak = (2 * count->fused + count->others) / seconds * 1e-9 / run.machine.fma_peak_gflops;
    // what is not fused takes the unit as long as what is
    const double busy_s = (count->fused + count->others) * 2e-9 / run.machine.fma_peak_gflops;
    result.bound +=
        fmt::format("; {:.0f} multiply-adds and {:.0f} other operations, {:.0f} % of what the unit can issue",
                    count->fused, count->others, 100 * busy_s / seconds);
  }
}

void tell_threads(BenchRun& run, const Schedule& schedule, std::size_t humans, const BenchTick& one,
                  const BenchTick& two) {
  const double speedup = one.wall_s / two.wall_s;
  add_figure(
      run, "crowd.threads2_speedup", speedup, "1",
      fmt::format("{} humans, the best tick by the wall's clock: {:.2f} ms by one thread, {:.2f} by two; medians "
                  "{:.2f} and {:.2f}",
                  humans, one.wall_s * 1e3, two.wall_s * 1e3, one.wall_median_s * 1e3, two.wall_median_s * 1e3));
  add_figure(run, "crowd.threads2_cpu_ratio", two.cpu_mean_s / one.cpu_mean_s, "1",
             "processor time of both over that of one: what sharing costs");
  const double all_s = std::accumulate(one.system_s.begin(), one.system_s.end(), 0.0);
  for (const std::size_t s : by_size(one)) {
    if (one.system_s[s] < 0.02 * all_s) break;
    add_figure(run, fmt::format("crowd.threads2.{}.speedup", stem_of(schedule.systems()[s].module)),
               2 * one.system_s[s] / two.system_s[s], "1", "by processor time, both threads at work");
  }
}

/// The muscles of a hundred, by ours and by Bullet, in turns.
Result<void> beside_rivals(BenchRun& run) {
  struct Ours {
    const char* name;
    LegMuscles choice;
    std::optional<double> muscles_us{}, all_us{};  // a tick of everybody
  };
  std::array<Ours, 2> ours = {Ours{"ecd81", LegMuscles{}}, Ours{"reduced", bench_reduced_muscles(true)}};
  RivalRounds rivals;
  const std::string rival = "bullet_crowd", asked = fmt::format("bullet_crowd@{}", humans_beside_rivals);
  std::optional<std::string> missing;
  if (!rivals_found()) missing = "mobil_rivals is not beside this program; build the CMake target mobil_rivals";
  std::vector<std::unique_ptr<BenchScene>> scenes;
  for (const Ours& o : ours) {
    scenes.push_back(std::make_unique<BenchScene>(o.choice));
    if (auto done = scenes.back()->grow_to(humans_beside_rivals); !done) return done;
  }
  for (int round = 0; round < run.rounds(3); ++round) {
    for (std::size_t i = 0; i < ours.size(); ++i) {
      BenchTick tick;
      scenes[i]->measure(1, run.quick ? 5 : 100, tick);
      const auto systems = scenes[i]->simulation().schedule().systems();
      double muscles_s = 0;
      for (std::size_t s = 0; s < systems.size(); ++s) {
        if (is_deformation(systems[s].module)) muscles_s += tick.system_s[s];
      }
      ours[i].muscles_us = std::min(ours[i].muscles_us.value_or(1e9), muscles_s * 1e6);
      ours[i].all_us = std::min(ours[i].all_us.value_or(1e9), tick.cpu_s * 1e6);
    }
    if (missing) continue;
    if (const auto done = rivals.add({asked}, run.quick); !done) missing = done.error().message;
  }
  const double theirs_us =
      missing ? 0 : rivals.find(rival)->us_per_step * static_cast<double>(humans_beside_rivals * muscles_a_human);
  for (const Ours& o : ours) {
    add_figure(run, fmt::format("crowd.{}.{}.muscles_us_per_tick", humans_beside_rivals, o.name), *o.muscles_us, "us",
               fmt::format("deformation of {} muscles, processor time; the whole tick with gait, skeleton and lines "
                           "{:.0f} us",
                           humans_beside_rivals * muscles_a_human, *o.all_us));
  }
  if (missing) {
    run.notes.push_back("crowd.*.ratio_to_bullet: " + *missing);
    return {};
  }
  const RivalTime& theirs = *rivals.find(rival);
  add_figure(run, fmt::format("crowd.{}.bullet.muscles_us_per_tick", humans_beside_rivals), theirs_us, "us",
             fmt::format("{}; {}", theirs.variant, theirs.check));
  for (const Ours& o : ours) {
    add_figure(run, fmt::format("crowd.{}.{}.ratio_to_bullet", humans_beside_rivals, o.name), theirs_us / *o.muscles_us,
               "1", "Bullet's processor time over ours, one thread each");
  }
  run.notes.emplace_back(
      "Bullet: deformable bodies of the paper's block, 81 nodes and 160 linear corotated tetrahedra, pulled at the far "
      "face, explicit at the fewest equal steps a tick that stay stable; large rotations are within it, and contact, "
      "gravity, its own damping and sleeping are switched off. Ours: bellies of everybody's own length and section, "
      "small strains about the line's frame, far ends moved by the lines, no contact; ecd81 the paper's 81 nodes and "
      "explicit steps, reduced 12 vectors of 425 nodes with the 81 placed.");
  if (!theirs.holds) run.notes.push_back("mobil_rivals bullet_crowd: TOO FAR OFF: " + theirs.check);
  return {};
}

}  // namespace

Result<void> bench_crowds(BenchRun& run) {
  const std::size_t middle = run.humans, few = std::max<std::size_t>(16, middle / 10),
                    many = std::min<std::size_t>(10 * middle, 200'000);
  BenchScene scene(bench_reduced_muscles(false));
  const Schedule& schedule = scene.simulation().schedule();
  if (auto done = scene.grow_to(few); !done) return done;
  const BenchTick small = measure_cost(run, scene, std::to_string(few));
  const auto small_compact = measure_compact(run, scene);
  if (!small_compact) return tl::unexpected(small_compact.error());
  if (auto done = scene.grow_to(middle); !done) return done;
  const BenchTick one = measure_cost(run, scene, std::to_string(middle));
  tell_systems(run, scene, schedule, one, small, static_cast<double>(few));

  if (const auto done = measure_compact(run, scene); !done) return tl::unexpected(done.error());

  BenchTick alone, both;
  for (int round = 0; round < run.rounds(20); ++round) {
    scene.measure(1, 10, alone);
    scene.measure(2, 20, both);
  }
  if (Threads(2).count() < 2) {
    run.notes.emplace_back("crowd.threads2_speedup: this machine has one core");
  } else {
    tell_threads(run, schedule, middle, alone, both);
    add_figure(run, "crowd.threads2.bandwidth_ratio", run.machine.all_cores_bandwidth_gbps / run.machine.bandwidth_gbps,
               "1", fmt::format("of {} cores over one, triad: what memory allows", run.machine.cores));
  }

  if (auto done = scene.change(bench_reduced_muscles(true)); !done) return done;
  measure_cost(run, scene, fmt::format("{}.seen", middle));
  if (auto done = scene.change(bench_reduced_muscles(false)); !done) return done;
  if (auto done = scene.grow_to(many); !done) return done;
  const BenchTick large = measure_cost(run, scene, std::to_string(many));
  add_figure(run, "crowd.us_per_spawn", scene.spawn_s() * 1e6, "us",
             "with eight muscles, a thousand at a time; processor time, what they share made before");
  const auto grown = [&](const BenchTick& last, const BenchTick& first) {
    return last.cpu_s / static_cast<double>(many) / (first.cpu_s / static_cast<double>(few));
  };
  const std::string among = fmt::format("a human's cost among {} over that among {}", many, few);
  add_figure(run, "crowd.large_over_small", grown(large, small), "1", among);
  const auto large_compact = measure_compact(run, scene);
  if (!large_compact) return tl::unexpected(large_compact.error());
  add_figure(run, "crowd.compact.large_over_small", grown(*large_compact, *small_compact), "1",
             among + ", everybody compact");
  return beside_rivals(run);
}

}  // namespace mobil
