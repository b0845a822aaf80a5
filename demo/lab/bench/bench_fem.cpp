// Finite-element kernels: explicit central differences on the paper's 81 nodes. They are compared with this core's
// peak, with other libraries on the same work, and with two threads.

#include <fmt/format.h>
#include <sched.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <thread>

#include <mobil/engine/jobs.h>
#include "demo/lab/bench/bench.h"
#include "demo/lab/bench/bench_fem_bellies.h"

namespace mobil {
namespace {

/// Results that one rival reports; times are its processor's.
struct RivalTime {
  double us_per_step = 0, median_us = 0, dt_s = 0;
  double far_z_m = 0;  // far face of its first muscle after 248 steps, if reported
  std::string variant, check;
  bool holds = false;
};

namespace fs = std::filesystem;

fs::path program() {
  std::error_code ignored;
  return fs::read_symlink("/proc/self/exe", ignored).parent_path() / "mobil_rivals";
}

/// Returns a text as one word of the shell.
std::string quoted(const std::string& text) {
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? "'\\''" : std::string(1, c);
  return word + "'";
}

/// Returns true if the comparison program exists.
bool rivals_found() {
  return access(program().c_str(), X_OK) == 0;
}

/// Runs the program once for the measurement `name`; `quick` runs it for a moment only, regardless of other load. Fails
/// with the program's message.
RivalTime measure_rival(const std::string& name, bool quick) {
  const std::string command = quoted(program().string()) + (quick ? " --quick " : " ") + quoted(name) + " 2>&1";
  const auto close = [](FILE* f) { return pclose(f); };
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) throw Stopped("mobil_rivals could not be started");
  std::string said;
  std::array<char, 4096> part{};
  for (std::size_t got = 0; (got = std::fread(part.data(), 1, part.size(), pipe)) > 0;) said.append(part.data(), got);
  const int status = close(pipe);
  const auto json = nlohmann::json::parse(said, nullptr, false);
  if (status != 0 || !json.is_object()) {
    throw Stopped(fmt::format("mobil_rivals {}: {}", name, said.substr(0, said.find('\n'))));
  }
  RivalTime time;
  try {
    time.us_per_step = json.at("us_per_step").get<double>();
    time.median_us = json.at("median_us_per_step").get<double>();
    time.dt_s = json.at("dt_s").get<double>();
    time.far_z_m = json.at("far_z_m").get<double>();
    time.variant = json.at("variant").get<std::string>();
    time.check = fmt::format("{}: {:.1e}", json.at("check").get<std::string>(), json.at("check_error").get<double>());
    time.holds = json.at("holds").get<bool>();
  } catch (const nlohmann::json::exception& error) {
    throw Stopped(fmt::format("mobil_rivals {}: {}; build it again with mobil", name, error.what()));
  }
  return time;
}

/// Best of several rounds, by the name of the measurement.
class RivalRounds {
 public:
  /// Adds one more round of each of `names`.
  void add(const std::vector<std::string>& names, bool quick) {
    for (const std::string& name : names) {
      const RivalTime time = measure_rival(name, quick);
      const std::string stem = name.substr(0, name.find('@'));
      auto& medians = medians_[stem];
      medians.push_back(time.median_us);
      auto [known, is_new] = best_.try_emplace(stem, time);
      if (!is_new && time.us_per_step < known->second.us_per_step) known->second = time;
      known->second.median_us = median(medians);
    }
  }
  /// Returns null if it was not measured.
  const RivalTime* find(const std::string& name) const {
    const auto known = best_.find(name);
    return known == best_.end() ? nullptr : &known->second;
  }

 private:
  std::map<std::string, RivalTime> best_;
  std::map<std::string, std::vector<double>> medians_;
};

constexpr int fem_rounds = 5;

struct Comparison {
  Rounds shared, individual;
  RivalRounds rivals;
};

/// Measures ours and theirs alternately, so that other load affects all equally.
Comparison compare(const BenchRun& run, const MuscleTemplate& muscle, bool with_rivals) {
  BenchBellies shared(muscle, Stiffness::shared, crowd_blocks);
  BenchBellies individual(muscle, Stiffness::individual, crowd_blocks);
  Comparison found;
  std::optional<double> bullet_dt_s;
  for (int round = 0; round < run.rounds(fem_rounds); ++round) {
    found.shared.add(measure(run.rounds(20), [&] { shared.tick(steps_a_tick, paper_tick_s); }));
    found.individual.add(measure(run.rounds(20), [&] { individual.tick(steps_a_tick, paper_tick_s); }));
    if (!with_rivals) continue;
    found.rivals.add({"eigen", "eigen_individual", "eigen_batched"}, run.quick);
    if (round > 0 && !bullet_dt_s) continue;  // not available
    const std::string bullet = bullet_dt_s ? fmt::format("bullet@{:.9g}", *bullet_dt_s) : "bullet";
    if (attempt([&] { found.rivals.add({bullet}, run.quick); })) bullet_dt_s = found.rivals.find("bullet")->dt_s;
  }
  if (!shared.finite() || !individual.finite()) throw Stopped("a belly's displacement is not a number");
  return found;
}

/// Returns the far face of the first muscle after the 248 steps by which the comparison program checks itself.
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
  add("eigen", "fem.explicit81.ratio_to_eigen", shared_us, false);
  add("eigen_batched", "fem.explicit81.ratio_to_eigen_batched", shared_us, false);
  add("eigen_individual", "fem.explicit81.individual.ratio_to_eigen", individual_us, false);
  add("bullet", "fem.explicit81.ratio_to_bullet", shared_us, true);
  const float ours_m = far_face_after_check(muscle);
  const double theirs_m = found.rivals.find("eigen")->far_z_m;
  run.notes.push_back(fmt::format(
      "the same 248 steps by mobil and by Eigen in double precision: far face at {:.6f} and "
      "{:.6f} mm, {:.1e} of it apart",
      static_cast<double>(ours_m) * 1e3, theirs_m * 1e3, std::abs(static_cast<double>(ours_m) / theirs_m - 1)));
  if (found.rivals.find("bullet") == nullptr) {
    run.notes.emplace_back(
        "fem.explicit81.ratio_to_bullet: mobil_rivals was built without Bullet; install libbullet-dev, configure and "
        "build "
        "again");
  }
}

/// Gives the caller and the pool's second thread a core each, or (`apart` false) all of `allowed` again. On a busy
/// machine the system can keep both on one core.
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
        if (end - begin != 1) return;  // no second thread took part
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

/// Measures blocks of a crowd that fits in the caches, in sequence and shared between two threads.
void bench_two_threads(BenchRun& run, const MuscleTemplate& muscle) {
  const Threads pool(2);
  if (pool.count() < 2) {
    run.notes.emplace_back("fem.threads2_speedup: this machine has one core");
    return;
  }
  BenchBellies bellies(muscle, Stiffness::shared, crowd_blocks);
  struct Work {
    BenchBellies& bellies;
    int ticks;
  };
  // Uses short and long turns: under other load the second thread can wait for its core.
  const auto time_a_tick = [&](const Jobs& by, int repeats, int ticks) {
    Work work{bellies, ticks};
    Measured time = measure(repeats, [&] {
      by.parallel_for(
          by.user, bellies.blocks(),
          [](void* context, std::size_t begin, std::size_t end) {
            const FloatMode mode;
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
}

/// Adds the time of one muscle's step, from all muscles' steps of a tick, and its fraction of the peak.
void add_step_time(BenchRun& run, const std::string& stem, const Measured& time, const Cells& cells) {
  constexpr double steps = static_cast<double>(crowd_blocks * lane_count) * steps_a_tick;
  BenchResult& result = run.add_time(stem + ".us_per_step", time, steps, 1e-6, "us");
  const double useful = useful_multiply_adds(cells);
  result.of_peak = 2 * useful / (result.value * 1e-6) * 1e-9 / run.machine.fma_peak_gflops;
  result.bound = fmt::format("{:.0f} useful multiply-adds", useful);
}

}  // namespace

void bench_fem(BenchRun& run) {
  const FloatMode mode;
  const auto muscle = paper_block({2, 2, 8});
  const Cells& cells = muscle.mesh.cells;
  const bool with_rivals = rivals_found();
  if (!with_rivals) {
    run.notes.emplace_back(
        "fem.explicit81.ratio_to_*: mobil_rivals is not beside this program; build the CMake target mobil_rivals");
  }
  const auto found = compare(run, muscle, with_rivals);
  const Measured shared = found.shared.all(), individual = found.individual.all();
  add_step_time(run, "fem.explicit81.shared", shared, cells);
  add_step_time(run, "fem.explicit81.individual", individual, cells);
  run.add_figure("fem.explicit81.individual_over_shared", individual.best_s / shared.best_s, "1",
                 "everybody's own length and section against one stiffness for all");
  if (with_rivals) add_rivals(run, muscle, found);
  bench_two_threads(run, muscle);
  bench_fem_implicit(run);
}

}  // namespace mobil
