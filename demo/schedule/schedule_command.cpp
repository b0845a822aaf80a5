// `mobil schedule`: what a tick does, system by system, as text and as a picture.

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>

#include <mobil/simulation.h>
#include "demo/program/commands.h"
#include "demo/schedule/schedule_picture.h"

namespace mobil {
namespace {

Result<void> show_schedule(const std::optional<std::string>& svg) {
  const Simulation simulation;
  if (svg) {
    if (auto place = check_result_place("--svg", *svg); !place) return place;
    return write_result("--svg", *svg, schedule_picture(simulation.schedule()));
  }
  fmt::print("{}", simulation.schedule().describe());
  return {};
}

}  // namespace

Subcommand schedule_command() {
  auto svg = std::make_shared<std::optional<std::string>>();
  Subcommand command{.name = "schedule"};
  command.footer =
      "Made from the schedule itself, whose order follows from what systems read and write. A system without rows\n"
      "takes no time. A host's own schedule: simulation.schedule().describe().\n"
      "\nExamples: mobil schedule\n"
      "          mobil schedule --svg schedule.svg";
  add_options(command, {{"--svg", svg.get(), "A picture, written to this FILE in place of the text"}});
  command.run = [svg] { return exit_status_of("schedule", show_schedule(*svg)); };
  return command;
}

}  // namespace mobil
