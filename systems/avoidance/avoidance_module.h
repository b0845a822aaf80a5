#pragma once
// What Avoidance keeps on people's rows, as a module: no system of its own; it chooses between ticks.

#include <mobil/engine/module.h>

namespace mobil::inline v0_3 {

/// The module; Simulation has it among its own.
Module avoidance_module();

}  // namespace mobil::inline v0_3
