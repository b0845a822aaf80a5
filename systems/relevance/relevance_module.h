#pragma once
// What Relevance keeps on people's rows, as a module: no system of its own; it chooses between ticks.

#include "engine/module.h"

namespace mobil {

Module relevance_module();

}  // namespace mobil
