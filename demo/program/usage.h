#pragma once
// What was wrong with a command line, in one line.

#include <CLI/CLI.hpp>
#include <string>

namespace mobil {

/// One line, with its newline: the subcommand it is about, what was not understood, the nearest known name, where to
/// read on. `app` is the one that threw `error` while it parsed `argv`.
std::string explain_usage(const CLI::App& app, const CLI::ParseError& error, int argc, const char* const* argv);

}  // namespace mobil
