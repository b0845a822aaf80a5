#pragma once
// How long something takes, on a machine that others use too.

#include <functional>
#include <optional>
#include <vector>

namespace mobil {

/// Seconds (wall clock) of one run of something that was run several times. `cpu_s` is the least time that the thread
/// really had a processor: what wall-clock time has more of is other people's.
struct Measured {
  double best_s = 0, median_s = 0;
  std::optional<double> cpu_s{};
};

/// How often something is measured, and for how long each time: less than a scheduler's turn, so that on a busy machine
/// some of the repeats are left alone.
inline constexpr int bench_repeats = 50;
inline constexpr double bench_repeat_s = 2e-3;

/// Runs `work` once unmeasured, then `repeats` times; wall clock and this thread's time on a processor.
Measured measure(int repeats, const std::function<void()>& work);

/// One run of something short: `bench_repeats` times as many runs as make up `bench_repeat_s`.
Measured measure_short(const std::function<void()>& work);

/// How many runs of `once_s` make up `bench_repeat_s`; at least one.
int runs_a_repeat(double once_s);

/// Seconds since some fixed moment: on the wall's clock, and those that this thread, or all of the process' threads
/// together, have had a processor.
double wall_now_s();
double thread_cpu_now_s();
double process_cpu_now_s();

/// Of an odd number of values the one in the middle, of an even one the upper of the two.
double median(std::vector<double> values);

}  // namespace mobil
