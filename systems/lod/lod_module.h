#pragma once
// What level of detail keeps, as a module, and when it chooses.

#include <mobil/engine/module.h>

namespace mobil::inline v0_3 {

/// The module; Simulation has it among its own.
Module lod_module();

/// Before the systems: methods are chosen, people wake and fall asleep (Lod).
Phase detail_chosen();
/// Counts of Lod::report begin at 0.
void begin_lod_report(const Frame& frame);

}  // namespace mobil::inline v0_3
