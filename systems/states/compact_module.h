#pragma once
// Muscles of compact people as a module: their fields on the person's row, and the system that advances them.

#include <mobil/engine/module.h>

namespace mobil::inline v0_3 {

Module compact_module();

}  // namespace mobil::inline v0_3
