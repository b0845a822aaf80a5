#pragma once
// The programs `mobil`, `mobil-crowd` and `mobil-lab` as data: descriptions and subcommands.

#include <string_view>

#include <mobil/engine/error.h>
#include "demo/program/options.h"

namespace mobil {

/// Returns the program of that name, or a program of all if the name is empty. Fails unless `commands` match the table
/// of subcommands. Subcommands of other programs are included with name and help only.
Result<Program> make_program(std::string_view name, std::vector<Subcommand> commands);

/// Returns all subcommands as one program, for the manual and shell completion. Each call creates a new one, with
/// options at their default values.
Program mobil_program();

/// Runs the requested subcommand, or the program in the same folder that contains it. Returns the exit status.
int run_own(std::string_view name, std::vector<Subcommand> commands, int argc, char** argv);

}  // namespace mobil
