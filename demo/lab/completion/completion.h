#pragma once
// What a shell needs to complete command lines of the program, from the same tables as the command line.

#include <string>

#include "demo/program/options.h"

namespace mobil {

/// Scripts: subcommands, options, and values where the tables know them; files elsewhere.
std::string bash_completion(const Program& program);
std::string zsh_completion(const Program& program);
std::string fish_completion(const Program& program);

}  // namespace mobil
