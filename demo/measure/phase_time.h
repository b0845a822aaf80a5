#pragma once
// Time of one phase of a tick.

#include <string_view>

#include <mobil/schedule.h>
#include <mobil/simulation.h>

namespace mobil {

/// Returns the seconds that a phase before the systems took in the last tick; 0 if no phase has that name.
inline double phase_s(const Simulation& simulation, std::string_view name) {
  for (const TimedPhase& one : simulation.schedule().before())
    if (one.phase.name == name) return one.last_seconds;
  return 0;
}

}  // namespace mobil
