// `mobil effects`: what can be simulated, what each effect costs, and what a scene that asks for little pays.

#include <fmt/format.h>

#include <memory>
#include <string>

#include "demo/lab/effects/effects.h"
#include "demo/program/commands.h"
#include "demo/program/progress.h"

namespace mobil {
namespace {

constexpr std::size_t most_humans = 100000;

struct EffectsCommand {
  std::size_t humans = 300;
  std::string json;
};

Result<void> list_effects(const EffectsCommand& text) {
  const auto account = measure_effects(text.humans, show);
  show("");
  if (!account) return tl::unexpected(account.error());
  fmt::print("{}", effects_table(*account));
  if (text.json.empty()) return {};
  return write_result("--json", text.json, effects_json(*account));
}

Result<void> run_effects(const EffectsCommand& text) {
  if (text.humans < 1 || text.humans > most_humans)
    return fail(fmt::format("--humans {}: give 1 to {}", text.humans, most_humans));
  if (!text.json.empty()) {
    if (auto ok = check_result_place("--json", text.json); !ok) return ok;
  }
  return list_effects(text);
}

}  // namespace

Subcommand effects_command() {
  auto text = std::make_shared<EffectsCommand>();
  Subcommand command{.name = "effects"};
  command.footer =
      "Every effect is switched on in a crowd of its own and its systems' time read off the simulation's report: what\n"
      "a scene does not ask for costs nothing. Columns: microseconds a human and tick of 1/60 s on one core (of the\n"
      "least busy moment), what it adds to what one sees, what it needs. Muscles come in rungs: a few vectors of a\n"
      "fine mesh (reduced-N), their static answer alone, or the paper's explicit mesh (full); `mobil frontier` shows\n"
      "how far off each is. A Relevance (mobil/relevance.h) chooses among them: from a tolerance in metres, a\n"
      "camera and a tolerance in pixels, or a time budget a tick; its why() tells for each muscle what was chosen and "
      "why.\n"
      "\n"
      "Examples: mobil effects\n"
      "          mobil effects --json effects.json";
  command.options = {{"--humans", &text->humans, "How many walk while effects are measured"},
                     {"--json", &text->json, "File for the figures"}};
  command.run = [text] { return exit_status_of("effects", run_effects(*text)); };
  return command;
}

}  // namespace mobil
