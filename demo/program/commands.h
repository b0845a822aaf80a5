#pragma once
// The subcommands of `mobil`. Exit status of each: 0 done, 1 ran but did not hold, 2 bad usage or input.

#include <filesystem>
#include <string_view>

#include <mobil/engine/error.h>
#include "demo/program/options.h"

namespace mobil {

/// Returns 0 on success. Otherwise prints the error in one line on stderr, after "mobil command", and returns 2.
int exit_status_of(std::string_view command, const Result<void>& done);

/// Prints such a line and returns `status`.
int complain(std::string_view command, std::string_view message, int status = 2);

/// Checks before minutes of work that the file of `option` can be written. Errors: a path that cannot be written, an
/// empty name.
Result<void> check_result_place(std::string_view option, const std::filesystem::path& file);

/// Prints "written FILE" on stdout, unless --quiet is set.
void say_written(const std::filesystem::path& file);

/// Prints a line about results on stdout, such as "look at FOLDER", unless --quiet is set.
void say_where(std::string_view line);

/// Writes the results file of `option` and prints its name on stdout. Errors begin with the option.
Result<void> write_result(std::string_view option, const std::filesystem::path& file, std::string_view text);

Subcommand crowd_command();
Subcommand city_command();
Subcommand town_command();
Subcommand view_command();
Subcommand bake_command();
Subcommand schedule_command();
Subcommand anatomy_command();
Subcommand body_command();
Subcommand muscle_command();
Subcommand bench_command();
Subcommand compare_command();
Subcommand robustness_command();
Subcommand paper_command();
Subcommand frontier_command();
Subcommand effects_command();
Subcommand gait_fit_command();
Subcommand run_fit_command();
Subcommand fit_accuracy_command();
Subcommand fit_shapes_command();
Subcommand completion_command();
Subcommand man_command();

/// Return the subcommands of `mobil`, `mobil-crowd` and `mobil-lab`.
std::vector<Subcommand> walk_commands();
std::vector<Subcommand> crowd_commands();
std::vector<Subcommand> lab_commands();

}  // namespace mobil
