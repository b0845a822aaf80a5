#pragma once
// Timing of short work on a shared machine.

#include <functional>
#include <optional>
#include <vector>

namespace mobil {

/// Seconds (wall clock) per run of repeated work. `cpu_s` is the minimum processor time of the thread; the excess of
/// wall clock over it is due to other processes.
struct Measured {
  double best_s = 0, median_s = 0;
  std::optional<double> cpu_s{};
};

/// Number of repeats, and duration of each: shorter than a scheduler's time slice, so that on a busy machine some
/// repeats run without interruption.
inline constexpr int bench_repeats = 50;
inline constexpr double bench_repeat_s = 2e-3;

/// Runs `work` once unmeasured, then `repeats` times. Measures wall clock and processor time of this thread.
Measured measure(int repeats, const std::function<void()>& work);

/// Measures one run of short work, as the mean over a repeat of about `bench_repeat_s`, in `bench_repeats` repeats.
Measured measure_short(const std::function<void()>& work);

/// Returns the number of runs of `once_s` in `bench_repeat_s`; at least one.
int runs_a_repeat(double once_s);

/// Return seconds since a fixed moment: wall clock, processor time of this thread, processor time of all threads of the
/// process.
double wall_now_s();
double thread_cpu_now_s();
double process_cpu_now_s();

/// Returns the median; for an even number of values, the upper of the two in the middle.
double median(std::vector<double> values);

}  // namespace mobil
