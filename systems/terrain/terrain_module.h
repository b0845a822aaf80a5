#pragma once
// The ground under walkers' feet as a part of their rows.

#include <mobil/engine/module.h>

namespace mobil::inline v0_3 {

Module terrain_module();

}  // namespace mobil::inline v0_3
