#pragma once
// Pages of the manual, as `man` reads them (troff, its macros "man"), from the same tables as the command line.

#include <string>

#include "demo/program/options.h"

namespace mobil {

/// mobil(1): the program, and every option of every subcommand. ASCII, whatever the tables hold.
std::string manual(const Program& program);

/// mobil-walk(1): one subcommand with all that its --help says.
std::string manual(const Program& program, const Subcommand& command);

}  // namespace mobil
