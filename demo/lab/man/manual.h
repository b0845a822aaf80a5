#pragma once
// Pages of the manual, as `man` reads them (troff, its macros "man"), from the same tables as the command line.

#include <string>

#include "demo/program/options.h"

namespace mobil {

/// Returns mobil(1): the program, and every option of every subcommand. Always ASCII, whatever the tables contain.
std::string manual(const Program& program);

/// Returns mobil-walk(1), for example: one subcommand with the whole text of its --help.
std::string manual(const Program& program, const Subcommand& command);

}  // namespace mobil
