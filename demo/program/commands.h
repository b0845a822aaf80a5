#pragma once
// The subcommands of `mobil`. Each adds itself to the program and, when chosen, runs and sets the exit status: 0 done,
// 1 ran but did not hold, 2 bad usage or input.

#include <string_view>

#include "engine/error.h"

namespace CLI {
class App;
}

namespace mobil {

/// 0; or 2, and the error told in one line on stderr: "mobil command: …".
int exit_status_of(std::string_view command, const Result<void>& done);

void add_walk_command(CLI::App& app, int& exit_status);
void add_body_command(CLI::App& app, int& exit_status);
void add_muscle_command(CLI::App& app, int& exit_status);
void add_bench_command(CLI::App& app, int& exit_status);
void add_compare_command(CLI::App& app, int& exit_status);
void add_stress_command(CLI::App& app, int& exit_status);
void add_paper_command(CLI::App& app, int& exit_status);
void add_frontier_command(CLI::App& app, int& exit_status);
void add_effects_command(CLI::App& app, int& exit_status);
void add_crowd_command(CLI::App& app, int& exit_status);

}  // namespace mobil
