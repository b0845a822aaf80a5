#include "demo/lab/compare/steady_cycle.h"

#include <mobil/components/pose.h>

namespace mobil {
namespace {

constexpr int settling_cycles = 3;
constexpr double longest_s = 60;  // no gait within range takes as long for five strides
constexpr double margin_cycles = 0.1;

}  // namespace

Result<void> over_steady_cycle(Simulation& simulation, Entity human, const std::function<void(double)>& row) {
  int cycles = -settling_cycles;
  double last = 0;
  while (simulation.time_s() < longest_s) {
    simulation.tick();
    const double phase = static_cast<double>(simulation.get<Feet>(human)->phase[Side::right]);
    if (phase < last - 0.5) ++cycles;
    last = phase;
    const double total = cycles + phase;
    if (total < -margin_cycles) continue;
    row(total);
    if (total > 1 + margin_cycles) return {};
  }
  return fail("the walk takes too long to get through five strides; ask for a quicker one");
}

}  // namespace mobil
