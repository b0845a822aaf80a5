#include <stdexcept>

#include "demo/program/commands.h"
#include "demo/program/program.h"

namespace mobil {

std::vector<Subcommand> lab_commands() {
  return {body_command(),       muscle_command(),     bench_command(),   compare_command(),  robustness_command(),
          paper_command(),      frontier_command(),   effects_command(), gait_fit_command(), run_fit_command(), fit_accuracy_command(),
          fit_shapes_command(), completion_command(), man_command()};
}

Program mobil_program() {
  std::vector<Subcommand> all = crowd_commands();
  for (Subcommand& command : lab_commands()) all.push_back(std::move(command));
  auto program = make_program("", std::move(all));
  if (!program) throw std::logic_error("demo/program/subcommands.cpp: " + program.error().message);
  return *std::move(program);
}

}  // namespace mobil
