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

/// Runs `work` once unmeasured, then `repeats` times; wall clock and this thread's time on a processor.
Measured measure(int repeats, const std::function<void()>& work);

/// How many runs of `once_s` seconds each make up `seconds`; at least one, at most a million.
int runs_within(double seconds, double once_s);

/// Seconds since some fixed moment: on the wall's clock, and those that this thread has had a processor.
double wall_now_s();
double thread_cpu_now_s();

/// Of an odd number of values the one in the middle, of an even one the upper of the two.
double median(std::vector<double> values);

}  // namespace mobil
