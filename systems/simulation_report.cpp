// What simulating cost.
#include "systems/simulation.h"

namespace mobil {

StepReport Simulation::report() const {
  StepReport report{tick_, {}};
  const auto systems = schedule_->systems();
  const auto timings = schedule_->timings();
  report.systems.reserve(systems.size());
  for (std::size_t s = 0; s < systems.size(); ++s) {
    const Timing& t = timings[s];
    report.systems.push_back({systems[s].name, systems[s].module, t.last_seconds, t.last_rows, t.seconds, t.rows});
  }
  return report;
}

}  // namespace mobil
