#pragma once
// Repeated timing by this thread's processor time, because wall-clock time includes other load on the machine.

#include <algorithm>
#include <ctime>
#include <string>
#include <vector>

#include "demo/lab/rivals/rival.h"

namespace rivals {

inline constexpr int repeats = 40;

inline double cpu_now_s() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Runs `work`, which does `steps` steps of one muscle each, once unmeasured and then `repeats` times or for `limit_s`.
template <class F>
Variant timed(std::string name, double steps, double limit_s, F&& work) {
  work();
  std::vector<double> us;
  const double start = cpu_now_s();
  while (us.size() < 2 || (static_cast<int>(us.size()) < repeats && cpu_now_s() - start < limit_s)) {
    const double before = cpu_now_s();
    work();
    us.push_back((cpu_now_s() - before) / steps * 1e6);
  }
  std::sort(us.begin(), us.end());
  return {std::move(name), us.front(), us[us.size() / 2]};
}

}  // namespace rivals
