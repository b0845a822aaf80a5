#pragma once
// The library's own modules, in the order of their data: all that a simulation does unless a host adds to it.

#include <vector>

#include "engine/module.h"

namespace mobil {

std::vector<Module> standard_modules();

}  // namespace mobil
