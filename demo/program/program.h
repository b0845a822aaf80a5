#pragma once
// The `mobil` program as data: what it says of itself, its subcommands and their options.

#include <string>
#include <vector>

#include "demo/program/options.h"

namespace mobil {

/// Made anew at every call, options at their usual values.
Program mobil_program();

/// `mobil man`, which a shell completes by the names of the others and its own.
Subcommand man_command(std::vector<std::string> others);

}  // namespace mobil
