#pragma once
// The programs `mobil`, `mobil-crowd` and `mobil-lab` as data: what they say of themselves, their subcommands.

#include <string_view>

#include <mobil/engine/error.h>
#include "demo/program/options.h"

namespace mobil {

/// Fails unless `commands` are those that the table of subcommands gives to a program of that name; to any, where it is
/// empty. Subcommands of other programs are in it by name and help alone.
Result<Program> make_program(std::string_view name, std::vector<Subcommand> commands);

/// All subcommands, as if they were one program's: what the manual and shells' completion are made of. Made anew at
/// every call, options at their usual values.
Program mobil_program();

/// Runs the subcommand that is asked for, or the program beside this one that has it. The exit status.
int run_own(std::string_view name, std::vector<Subcommand> commands, int argc, char** argv);

}  // namespace mobil
