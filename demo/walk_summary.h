#pragma once
// summary.json: what was asked for, what came of it, and what it cost.

#include <string>
#include <vector>

#include "assets/export/gltf_writer.h"
#include "demo/walk_options.h"
#include "systems/simulation.h"

namespace mobil {

struct WalkCost {
  double simulation_s = 0;  // wall time of the ticks alone
  double wall_s = 0;        // of the whole command
};

/// The whole file as text.
std::string summary_json(const WalkOptions& options, const Simulation& simulation, const Human& human,
                         const WalkCost& cost, const std::vector<MuscleFidelity>& exported);

}  // namespace mobil
