#pragma once
// What Avoidance keeps on people's rows, as a module: no system of its own; it chooses between ticks.

#include "engine/module.h"

namespace mobil {

/// The module; Simulation has it among its own.
Module avoidance_module();

}  // namespace mobil
