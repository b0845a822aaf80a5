#pragma once
// The library's own modules, in data-flow order. A simulation runs only these unless the host adds modules.

#include <vector>

#include <mobil/engine/module.h>

namespace mobil::inline v0_3 {

std::vector<Module> standard_modules();

}  // namespace mobil::inline v0_3
