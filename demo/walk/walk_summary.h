#pragma once
// summary.json: the request, its results, and their cost.

#include <mobil/gltf_writer.h>
#include <mobil/schedule.h>
#include <mobil/simulation.h>
#include <mobil/systems/limits/limit_monitor.h>
#include <mobil/systems/limits/style_limits.h>
#include <mobil/systems/muscles/person.h>
#include "demo/walk/walk_options.h"

namespace mobil {

/// A limit of joints, ground or pelvis that the walk violated during a change: the largest violation, and its time.
struct LimitPassed {
  LimitViolation furthest;
  double first_s, last_s;
  std::uint32_t ticks;
};

struct WalkOutcome {
  decltype(Person::gait) gait{};           // at the start
  std::size_t changes = 0;                 // of the script, within the walk
  std::uint32_t clamped_steps = 0;         // that bounded forces cannot produce as requested
  std::vector<StyleChange> style_changes;  // corrected parameters of all requested styles, including the script's
  std::vector<LimitPassed> limits_passed;
  std::uint32_t ticks = 0;
  double simulated_s = 0;
  std::vector<Timing> stages;  // one per system
  double simulation_s = 0;     // wall time of the ticks only
  double wall_s = 0;           // of the whole command
  std::vector<std::string> anatomy_said;
};

/// Returns the text of the file.
std::string summary_json(const WalkOptions& options, const Simulation& simulation, const Person& person,
                         const WalkOutcome& outcome, const std::vector<MuscleFidelity>& exported);

}  // namespace mobil
