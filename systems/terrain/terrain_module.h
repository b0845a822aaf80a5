#pragma once
// The ground under walkers' feet as a part of their rows.

#include "engine/module.h"

namespace mobil {

Module terrain_module();

}  // namespace mobil
