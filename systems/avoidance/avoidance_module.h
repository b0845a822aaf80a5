#pragma once
// The module of avoidance, and its phase.

#include <mobil/engine/module.h>

namespace mobil::inline v0_3 {

/// Returns the module; every Simulation has it.
Module avoidance_module();

/// Returns the phase before the systems in which walkers who avoid others choose their next step (Avoidance).
Phase steps_chosen();
/// Resets the counts of Avoidance::report to 0.
void begin_avoidance_report(const Frame& frame);

}  // namespace mobil::inline v0_3
