#pragma once
// Muscles of compact people as a module: what their rows have of them, and how they go on.

#include <mobil/engine/module.h>

namespace mobil::inline v0_3 {

Module compact_module();

}  // namespace mobil::inline v0_3
