// `mobil effects`: what can be simulated, what each effect costs, and what a scene that asks for little pays.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>

#include "demo/lab/effects/accuracy_living.h"
#include "demo/lab/effects/accuracy_measure.h"
#include "demo/lab/effects/effects.h"
#include "demo/lab/effects/finite_tables.h"
#include "demo/lab/effects/relevance_show.h"
#include "demo/program/commands.h"
#include "demo/program/progress.h"

namespace mobil {
namespace {

constexpr std::size_t most_humans = 100000, least_shown = 100;

struct EffectsCommand {
  std::size_t humans = 300, crowd = 0;
  std::string json, shapes;
  bool measure = false;
};

Result<void> list_effects(const EffectsCommand& text) {
  const auto account = measure_effects(text.humans, show);
  show("");
  if (!account) return tl::unexpected(account.error());
  fmt::print("{}", effects_table(*account));
  if (text.json.empty()) return {};
  return write_result("--json", text.json, effects_json(*account));
}

/// The rows of systems/relevance/accuracy_table.cpp, and its costs.
Result<void> measure_table() {
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

int run_effects(const EffectsCommand& text) {
  if (text.humans < 1 || text.humans > most_humans)
    return exit_status_of("effects", fail(fmt::format("--humans {}: give 1 to {}", text.humans, most_humans)));
  if (!text.shapes.empty()) return exit_status_of("effects", write_finite_tables(text.shapes));
  if (text.measure) return exit_status_of("effects", measure_table());
  if (text.crowd == 0) return exit_status_of("effects", list_effects(text));
  if (text.crowd < least_shown || text.crowd > most_humans)
    return exit_status_of("effects",
                          fail(fmt::format("--crowd {}: give {} to {}", text.crowd, least_shown, most_humans)));
  CrowdShow asked;
  asked.humans = text.crowd;
  asked.switching_muscles = text.crowd;
  asked.progress = show;
  const auto figures = show_crowd(asked);
  show("");
  if (!figures) return exit_status_of("effects", tl::unexpected(figures.error()));
  fmt::print("{}", figures_table(*figures));
  return std::ranges::all_of(*figures, &ShownFigure::held) ? 0 : 1;
}

}  // namespace

Subcommand effects_command() {
  auto text = std::make_shared<EffectsCommand>();
  Subcommand command{.name = "effects"};
  command.footer =
      "Every effect is switched on in a crowd of its own and its systems' time read off the simulation's report: what "
      "a\n"
      "scene does not ask for costs nothing. Columns: microseconds a human and tick of 1/60 s on one core (of the "
      "least\n"
      "busy moment), what it adds to what one sees, what it needs. Muscles come in rungs: a few vectors of a fine "
      "mesh\n"
      "(reduced-N), their static answer alone, or the paper's explicit mesh (full); `mobil frontier` shows how far "
      "off\n"
      "each is. A Relevance (systems/relevance/relevance.h) chooses among them: from a tolerance in metres, "
      "a\n"
      "camera and a tolerance in pixels, or a time budget a tick; its why() tells for each muscle what was chosen and "
      "why.\n"
      "--crowd N shows that: N people with eight muscles each, near and far; a camera's flight under a budget; "
      "methods\n"
      "changed at random. Exit status 1 where a bound did not hold. --measure prints the table of errors and costs "
      "that\n"
      "choices are made by, as systems/relevance/accuracy_table.cpp has it: minutes. --shapes DIR solves the shapes "
      "of\n"
      "all muscles at finite strain and writes them as assets/finite/tables has them: minutes.\n"
      "\nExamples: mobil effects\n"
      "          mobil effects --json effects.json\n"
      "          mobil effects --crowd 10000";
  command.options = {{"--humans", &text->humans, "How many walk while effects are measured"},
                     {"--json", &text->json, "File for the figures"},
                     {"--crowd", &text->crowd, "Show what relevance makes of a crowd of that many"},
                     {.name = "--measure",
                      .target = &text->measure,
                      .help = "Print the accuracy table, measured anew",
                      .excludes = "--crowd"},
                     {"--shapes", &text->shapes, "Folder to write the tables of finite strain to, made anew"}};
  command.run = [text] { return run_effects(*text); };
  return command;
}

}  // namespace mobil
