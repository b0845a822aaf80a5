// `mobil fit-accuracy`: the table of errors and costs by which methods are chosen, measured anew.

#include <fmt/format.h>

#include <string>

#include "demo/lab/effects/accuracy_living.h"
#include "demo/lab/effects/accuracy_measure.h"
#include "demo/program/commands.h"
#include "demo/program/progress.h"

namespace mobil {
namespace {

/// The rows of systems/relevance/accuracy_table.cpp, and its costs.
Result<void> print_accuracy() {
  std::string rows, costs;
  for (const bool inertia : {false, true}) {
    AccuracyPlan plan = accuracy_plan();
    plan.progress = [&](double part) { show_part(inertia ? "errors with inertia" : "errors without inertia", part); };
    const auto errors = measure_errors(plan, inertia);
    if (!errors) return tl::unexpected(errors.error());
    rows += accuracy_source(*errors);
  }
  for (AccuracyPlan plan : living_plans()) {
    plan.progress = [](double part) { show_part("errors of muscles that pull", part); };
    const auto errors = measure_living_errors(plan);
    if (!errors) return tl::unexpected(errors.error());
    rows += accuracy_source(*errors);
  }
  for (const bool living : {false, true}) {
    for (const bool inertia : {false, true}) {
      show("costs");
      const auto cost = measure_costs(1024, inertia, living);
      if (!cost) return tl::unexpected(cost.error());
      costs += cost_source(*cost);
    }
  }
  show("");
  fmt::print("{}\n{}", rows, costs);
  return {};
}

}  // namespace

Subcommand fit_accuracy_command() {
  Subcommand command{.name = "fit-accuracy"};
  command.footer =
      "For those who change the library: prints rows and costs as systems/relevance/accuracy_table.cpp has them. "
      "Minutes.\n"
      "Example: mobil fit-accuracy > accuracy.txt";
  command.run = [] { return exit_status_of("fit-accuracy", print_accuracy()); };
  return command;
}

}  // namespace mobil
