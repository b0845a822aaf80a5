#pragma once
// The ground under walkers' feet as a part of their rows.

#include <mobil/engine/module.h>

namespace mobil::inline v0_3 {

Module terrain_module();

/// Before the systems: the host's function answers how high the ground is under new footholds (Terrain).
Phase ground_under_feet();
/// Counts of Terrain::report begin at 0.
void begin_terrain_report(const Frame& frame);

}  // namespace mobil::inline v0_3
