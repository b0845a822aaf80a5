#pragma once
// Shell scripts that complete command lines of the program, from the same tables as the command line.

#include <string>

#include "demo/program/options.h"

namespace mobil {

/// Return scripts for subcommands, options, and values if the tables list them; otherwise for files.
std::string bash_completion(const Program& program);
std::string zsh_completion(const Program& program);
std::string fish_completion(const Program& program);

}  // namespace mobil
