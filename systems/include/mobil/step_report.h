#pragma once
// Time of a tick by phases and systems.

#include <cstdint>
#include <string_view>
#include <vector>

namespace mobil::inline v0_3 {

/// Time of one system, summed over all threads, and the number of entities that it processed.
struct SystemReport {
  std::string_view name, module;  // valid as long as the simulation
  double seconds = 0;             // in the last tick
  std::uint64_t entities = 0;
  double total_seconds = 0;  // in all ticks since the schedule's timings were last reset
  std::uint64_t total_entities = 0;
};

/// Time of one phase of a tick (mobil/engine/phase.h), on the thread that calls `tick`.
struct PhaseReport {
  std::string_view name, module;  // valid as long as the simulation
  bool after = false;             // true: after the systems; false: before them
  double seconds = 0;             // in the last tick
  double total_seconds = 0;       // in all ticks since the schedule's timings were last reset
};

/// All systems and phases of a tick, in the order of execution. A system that matches no table has 0 entities and 0 s.
struct StepReport {
  std::uint32_t ticks = 0;  // run so far
  std::vector<SystemReport> systems;
  /// Number of bellies that were reset because they were not finite at the end of a tick: in the last tick, and since
  /// timings were last reset. The usual cause is a system of the host that wrote NaN or infinity.
  std::uint64_t restarted_bellies = 0, total_restarted_bellies = 0;
  /// Number of people, except sleepers, who violate a limit of joints, ground or pelvis while they change their walk
  /// (mobil/systems/limits/limit_monitor.h): in the last tick, and summed over all ticks since timings were last reset.
  /// The function `limit_violations` returns the limits of a person.
  std::uint64_t limit_violations = 0, total_limit_violations = 0;
  std::vector<PhaseReport> phases{};
};

}  // namespace mobil::inline v0_3
