#pragma once
// What simulating costs, phase by phase and system by system.

#include <cstdint>
#include <string_view>
#include <vector>

namespace mobil::inline v0_3 {

/// What one system cost: time of all threads together, and entities that it worked on.
struct SystemReport {
  std::string_view name, module;  // good as long as the simulation
  double seconds = 0;             // in the last tick
  std::uint64_t entities = 0;
  double total_seconds = 0;  // in all ticks since the schedule's timings were last reset
  std::uint64_t total_entities = 0;
};

/// Time of one phase of a tick (mobil/engine/phase.h), of the thread that ticks.
struct PhaseReport {
  std::string_view name, module;  // good as long as the simulation
  bool after = false;             // the systems; else before them
  double seconds = 0;             // in the last tick
  double total_seconds = 0;       // in all ticks since the schedule's timings were last reset
};

/// All of a tick, in the order of running. A system that matches no table reports 0 entities and 0 s.
struct StepReport {
  std::uint32_t ticks = 0;  // run so far
  std::vector<SystemReport> systems;
  /// Bellies that were not finite at a tick's end and began anew, usually because a system of the host wrote NaN or
  /// infinity: in the last tick, and in all since timings were last reset.
  std::uint64_t restarted_bellies = 0, total_restarted_bellies = 0;
  /// People beyond a limit of joints, ground or pelvis while they change their walk, sleepers left out
  /// (mobil/systems/limits/limit_monitor.h): in the last tick, and summed over all ticks since timings were last reset.
  /// `limit_violations` tells which limits.
  std::uint64_t limit_violations = 0, total_limit_violations = 0;
  std::vector<PhaseReport> phases{};
};

}  // namespace mobil::inline v0_3
