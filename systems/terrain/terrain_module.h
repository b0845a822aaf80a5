#pragma once
// The module of terrain: the ground under walkers' feet as a part of their rows.

#include <mobil/engine/module.h>

namespace mobil::inline v0_3 {

Module terrain_module();

/// Returns the phase before the systems in which the host's function gives heights under new footholds (Terrain).
Phase ground_under_feet();
/// Resets the counts of Terrain::report to 0.
void begin_terrain_report(const Frame& frame);

}  // namespace mobil::inline v0_3
