#pragma once
// State of a Simulation. Its address does not change when the Simulation is moved.

#include <memory>
#include <optional>
#include <vector>

#include <mobil/schedule.h>
#include <mobil/simulation.h>
#include "systems/bellies/belly_library.h"

namespace mobil::inline v0_3 {

struct Simulation::Core {
  Core(const SimulationOptions& options, const Clock& clock, std::vector<Module> modules, Schedule schedule);

  World world;
  Clock clock;
  std::optional<Threads> threads;
  Jobs jobs;
  std::vector<Module> modules;           // the library's, then the host's, then step_memory_module()
  std::vector<std::uint64_t> our_parts;  // component ids of the library's modules, ascending
  Schedule schedule;
  std::shared_ptr<BellyLibrary> library;
  Workspace workspace;
  Tick tick;
  Frame frame{world, jobs, tick, workspace, schedule};
};

}  // namespace mobil::inline v0_3
