#pragma once
// What avoiding others keeps on people's rows, as a module, and when it chooses.

#include <mobil/engine/module.h>

namespace mobil::inline v0_3 {

/// The module; Simulation has it among its own.
Module avoidance_module();

/// Before the systems: who avoids others and is about to begin a step chooses it (Avoidance).
Phase steps_chosen();
/// Counts of Avoidance::report begin at 0.
void begin_avoidance_report(const Frame& frame);

}  // namespace mobil::inline v0_3
