#pragma once
// The module of level of detail, and its phase.

#include <mobil/engine/module.h>

namespace mobil::inline v0_3 {

/// Returns the module; every Simulation has it.
Module lod_module();

/// Returns the phase before the systems that chooses methods, wakes people and puts them to sleep (Lod).
Phase detail_chosen();
/// Resets the counts of Lod::report to 0.
void begin_lod_report(const Frame& frame);

}  // namespace mobil::inline v0_3
