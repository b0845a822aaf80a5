#pragma once
// The library's own modules, in the order of their data: all that a simulation does unless a host adds to it.

#include <vector>

#include <mobil/engine/module.h>

namespace mobil::inline v0_3 {

std::vector<Module> standard_modules();

}  // namespace mobil::inline v0_3
