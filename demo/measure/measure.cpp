#include "demo/measure/measure.h"

#include <algorithm>
#include <chrono>
#include <ctime>

namespace mobil {

double wall_now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

namespace {

double cpu_now_s(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace

double thread_cpu_now_s() {
  return cpu_now_s(CLOCK_THREAD_CPUTIME_ID);
}

double process_cpu_now_s() {
  return cpu_now_s(CLOCK_PROCESS_CPUTIME_ID);
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

Measured measure(int repeats, const std::function<void()>& work) {
  work();
  std::vector<double> wall, cpu;
  for (int i = 0; i < repeats; ++i) {
    const double cpu_start = thread_cpu_now_s(), wall_start = wall_now_s();
    work();
    wall.push_back(wall_now_s() - wall_start);
    cpu.push_back(thread_cpu_now_s() - cpu_start);
  }
  return {std::ranges::min(wall), median(wall), std::ranges::min(cpu)};
}

int runs_a_repeat(double once_s) {
  return static_cast<int>(std::clamp(bench_repeat_s / std::max(once_s, 1e-9), 1.0, 1e6));
}

Measured measure_short(const std::function<void()>& work) {
  const int runs = runs_a_repeat(measure(3, work).best_s);
  const Measured all = measure(bench_repeats, [&] {
    for (int i = 0; i < runs; ++i) work();
  });
  return {all.best_s / runs, all.median_s / runs, *all.cpu_s / runs};
}

}  // namespace mobil
