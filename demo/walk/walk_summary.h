#pragma once
// summary.json: what was asked for, what came of it, and what it cost.

#include <mobil/gltf_writer.h>
#include <mobil/schedule.h>
#include <mobil/simulation.h>
#include <mobil/systems/limits/limit_monitor.h>
#include <mobil/systems/limits/style_limits.h>
#include <mobil/systems/muscles/person.h>
#include "demo/walk/walk_options.h"

namespace mobil {

/// A limit of joints, ground or pelvis that the walk went beyond as it changed: furthest, and when.
struct LimitPassed {
  LimitViolation furthest;
  double first_s, last_s;
  std::uint32_t ticks;
};

struct WalkOutcome {
  decltype(Person::gait) gait{};           // at the start
  std::size_t changes = 0;                 // of the script that fell within the walk
  std::uint32_t clamped_steps = 0;         // that no forces within bounds make as asked
  std::vector<StyleChange> style_changes;  // what of the styles asked for, the script's too, was moved
  std::vector<LimitPassed> limits_passed;
  std::uint32_t ticks = 0;
  double simulated_s = 0;
  std::vector<Timing> stages;  // one a system
  double simulation_s = 0;     // wall time of the ticks alone
  double wall_s = 0;           // of the whole command
  std::vector<std::string> anatomy_said;
};

/// The whole file as text.
std::string summary_json(const WalkOptions& options, const Simulation& simulation, const Person& person,
                         const WalkOutcome& outcome, const std::vector<MuscleFidelity>& exported);

}  // namespace mobil
