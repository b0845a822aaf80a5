#pragma once
// What one phase of a tick took.

#include <string_view>

#include <mobil/schedule.h>
#include <mobil/simulation.h>

namespace mobil {

/// Seconds of the last tick that the phase of that name took, before the systems; 0 where there is none.
inline double phase_s(const Simulation& simulation, std::string_view name) {
  for (const TimedPhase& one : simulation.schedule().before())
    if (one.phase.name == name) return one.last_seconds;
  return 0;
}

}  // namespace mobil
