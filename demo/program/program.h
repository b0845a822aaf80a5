#pragma once
// The `mobil` program as data: what it says of itself, its subcommands and their options.

#include "demo/program/options.h"

namespace mobil {

/// Made anew at every call, options at their usual values.
Program mobil_program();

}  // namespace mobil
