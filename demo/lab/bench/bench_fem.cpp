// The finite-element kernels: explicit central differences on the paper's 81 nodes against this core's peak, against
// what others' code needs for the same work, and against itself on two threads.

#include "demo/lab/bench/bench_fem.h"

#include <fmt/format.h>
#include <sched.h>

#include <atomic>
#include <cmath>
#include <optional>
#include <thread>

#include <mobil/engine/jobs.h>
#include "demo/lab/bench/bench_fem_rivals.h"

namespace mobil {
namespace {

constexpr int fem_rounds = 5;

struct Comparison {
  Rounds shared, individual;
  RivalRounds rivals;
};

/// Ours and theirs in turn, so that a busy moment hits all alike.
Result<Comparison> compare(const BenchRun& run, const MuscleTemplate& muscle, bool with_rivals) {
  BenchBellies shared(muscle, Stiffness::shared, crowd_blocks);
  BenchBellies individual(muscle, Stiffness::individual, crowd_blocks);
  Comparison found;
  std::optional<double> bullet_dt_s;
  for (int round = 0; round < run.rounds(fem_rounds); ++round) {
    found.shared.add(measure(run.rounds(20), [&] { shared.tick(steps_a_tick, paper_tick_s); }));
    found.individual.add(measure(run.rounds(20), [&] { individual.tick(steps_a_tick, paper_tick_s); }));
    if (!with_rivals) continue;
    if (auto done = found.rivals.add({"eigen", "eigen_individual", "eigen_batched"}, run.quick); !done) {
      return tl::unexpected(done.error());
    }
    if (round > 0 && !bullet_dt_s) continue;  // it was not there
    if (found.rivals.add({bullet_dt_s ? fmt::format("bullet@{:.9g}", *bullet_dt_s) : "bullet"}, run.quick)) {
      bullet_dt_s = found.rivals.find("bullet")->dt_s;
    }
  }
  if (!shared.finite() || !individual.finite()) return fail("a belly's displacement is not a number");
  return found;
}

/// The 248 steps that the comparison program checks itself by, of its first muscle.
float far_face_after_check(const MuscleTemplate& muscle) {
  BenchBellies bellies(muscle, Stiffness::shared, 1);
  for (int n = 0; n < 248; ++n) bellies.tick(1, static_cast<float>(paper_step_s));
  return bellies.elongation_m()[0];
}

void add_rivals(BenchRun& run, const MuscleTemplate& muscle, const Comparison& found) {
  constexpr double steps = static_cast<double>(crowd_blocks * lane_count) * steps_a_tick;
  const Measured shared = found.shared.all(), individual = found.individual.all();
  const double shared_us = *shared.cpu_s / steps * 1e6, individual_us = *individual.cpu_s / steps * 1e6;
  const auto add = [&](const char* name, const char* figure, double ours_us, bool by_second) {
    const RivalTime* theirs = found.rivals.find(name);
    if (theirs == nullptr) return;
    BenchResult& time = run.add_figure(fmt::format("fem.rivals.{}.us_per_step", name), theirs->us_per_step, "us",
                                       fmt::format("{}; step {:.4g} ms", theirs->variant, theirs->dt_s * 1e3));
    time.cpu = theirs->us_per_step;
    time.median = theirs->median_us;
    const double ratio =
        by_second ? theirs->us_per_step / theirs->dt_s / (ours_us / paper_step_s) : theirs->us_per_step / ours_us;
    run.add_figure(figure, ratio, "1",
                   by_second
                       ? fmt::format("processor time per simulated second, ours at 2 ms, theirs at {:.4g} ms, its "
                                     "largest stable step",
                                     theirs->dt_s * 1e3)
                       : "processor time of a step, the best of interleaved rounds");
    run.notes.push_back(
        fmt::format("mobil_rivals {}: {}{}", name, theirs->check, theirs->holds ? "" : ", TOO FAR OFF"));
  };
  add("eigen", "fem.ecd81.ratio_to_eigen", shared_us, false);
  add("eigen_batched", "fem.ecd81.ratio_to_eigen_batched", shared_us, false);
  add("eigen_individual", "fem.ecd81.individual.ratio_to_eigen", individual_us, false);
  add("bullet", "fem.ecd81.ratio_to_bullet", shared_us, true);
  const float ours_m = far_face_after_check(muscle);
  const double theirs_m = found.rivals.find("eigen")->far_z_m;
  run.notes.push_back(fmt::format(
      "the same 248 steps by mobil and by Eigen in double precision: far face at {:.6f} and "
      "{:.6f} mm, {:.1e} of it apart",
      static_cast<double>(ours_m) * 1e3, theirs_m * 1e3, std::abs(static_cast<double>(ours_m) / theirs_m - 1)));
  if (found.rivals.find("bullet") == nullptr) {
    run.notes.emplace_back(
        "fem.ecd81.ratio_to_bullet: mobil_rivals was built without Bullet; install libbullet-dev, configure and build "
        "again");
  }
}

/// Gives the caller and the pool's second thread a core each, or (`apart` false) all of `allowed` again: on a busy
/// machine the system may keep both on one.
void place_threads(const Jobs& jobs, const cpu_set_t& allowed, bool apart) {
  struct Meeting {
    const cpu_set_t& allowed;
    bool apart;
    std::atomic<int> here = 0;
  };
  Meeting meeting{allowed, apart};
  jobs.parallel_for(
      jobs.user, 2,
      [](void* context, std::size_t begin, std::size_t end) {
        if (end - begin != 1) return;  // nobody came to help
        Meeting& all = *static_cast<Meeting*>(context);
        int core = all.here++;
        const double start_s = wall_now_s();
        while (all.here < 2 && wall_now_s() - start_s < 0.5) std::this_thread::yield();
        cpu_set_t mine = all.allowed;
        for (int cpu = 0; all.apart && all.here == 2 && cpu < CPU_SETSIZE; ++cpu) {
          if (CPU_ISSET(cpu, &mine) && core-- != 0) CPU_CLR(cpu, &mine);
        }
        sched_setaffinity(0, sizeof(mine), &mine);
      },
      &meeting);
}

/// Blocks of a crowd that fits the caches, one after the other and shared out between two threads.
Result<void> bench_two_threads(BenchRun& run, const MuscleTemplate& muscle) {
  const Threads pool(2);
  if (pool.count() < 2) {
    run.notes.emplace_back("fem.threads2_speedup: this machine has one core");
    return {};
  }
  BenchBellies bellies(muscle, Stiffness::shared, crowd_blocks);
  struct Work {
    BenchBellies& bellies;
    int ticks;
  };
  // Short turns and long ones: among other work the second thread may be a while getting its core.
  const auto time_a_tick = [&](const Jobs& by, int repeats, int ticks) {
    Work work{bellies, ticks};
    Measured time = measure(repeats, [&] {
      by.parallel_for(
          by.user, bellies.blocks(),
          [](void* context, std::size_t begin, std::size_t end) {
            const FlushDenormals flushed;
            const Work& given = *static_cast<const Work*>(context);
            for (std::size_t block = begin; block < end; ++block) {
              for (int n = 0; n < given.ticks; ++n) given.bellies.tick_block(block, steps_a_tick, paper_tick_s);
            }
          },
          &work);
    });
    time.best_s /= ticks;
    time.median_s /= ticks;
    return time;
  };
  const Jobs jobs = pool.jobs(), alone{};
  cpu_set_t allowed{};
  sched_getaffinity(0, sizeof(allowed), &allowed);
  place_threads(jobs, allowed, true);
  Rounds one, two;
  for (int round = 0; round < run.rounds(40); ++round) {
    one.add(time_a_tick(alone, 5, 1));
    two.add(time_a_tick(jobs, 10, 1));
    two.add(time_a_tick(jobs, 2, 10));
  }
  place_threads(jobs, allowed, false);
  const double once_s = one.all().best_s, twice_s = two.all().best_s;
  run.add_figure(
      "fem.threads2_speedup", once_s / twice_s, "1",
      fmt::format("{} muscles, a tick of {} steps: {:.3f} ms by one thread, {:.3f} by two, each on a core; wall clock",
                  bellies.muscles(), steps_a_tick, once_s * 1e3, twice_s * 1e3));
  if (once_s / twice_s < 1.8) {
    run.notes.emplace_back(
        "fem.threads2_speedup: the second core had other work throughout; measure again when it is free");
  }
  return {};
}

/// Adds the time of one muscle's step from that of all muscles' steps of a tick, and its share of the peak.
void add_step_time(BenchRun& run, const std::string& stem, const Measured& time, const Cells& cells) {
  constexpr double steps = static_cast<double>(crowd_blocks * lane_count) * steps_a_tick;
  BenchResult& result = run.add_time(stem + ".us_per_step", time, steps, 1e-6, "us");
  const double useful = useful_multiply_adds(cells);
  result.of_peak = 2 * useful / (result.value * 1e-6) * 1e-9 / run.machine.fma_peak_gflops;
  result.bound = fmt::format("{:.0f} useful multiply-adds", useful);
}

}  // namespace

Result<void> bench_fem(BenchRun& run) {
  const FlushDenormals flushed;
  const auto muscle = paper_block({2, 2, 8});
  if (!muscle) return tl::unexpected(muscle.error());
  const Cells& cells = muscle->mesh.cells;
  const bool with_rivals = rivals_found();
  if (!with_rivals) {
    run.notes.emplace_back(
        "fem.ecd81.ratio_to_*: mobil_rivals is not beside this program; build the CMake target mobil_rivals");
  }
  const auto found = compare(run, *muscle, with_rivals);
  if (!found) return tl::unexpected(found.error());
  const Measured shared = found->shared.all(), individual = found->individual.all();
  add_step_time(run, "fem.ecd81.shared", shared, cells);
  add_step_time(run, "fem.ecd81.individual", individual, cells);
  run.add_figure("fem.ecd81.individual_over_shared", individual.best_s / shared.best_s, "1",
                 "everybody's own length and section against one stiffness for all");
  if (with_rivals) add_rivals(run, *muscle, *found);
  if (auto done = bench_two_threads(run, *muscle); !done) return done;
  return bench_fem_implicit(run);
}

}  // namespace mobil
