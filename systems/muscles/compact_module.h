#pragma once
// Muscles of compact people as a module: what their rows have of them, and how they go on.

#include "engine/module.h"

namespace mobil {

Module compact_module();

}  // namespace mobil
