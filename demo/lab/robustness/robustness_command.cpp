// `mobil robustness`: hard cases, the promise of each, and the result.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <utility>

#include "demo/lab/robustness/robustness.h"
#include "demo/program/commands.h"
#include "demo/program/console.h"
#include "demo/program/json.h"
#include "demo/program/named_entries.h"
#include "demo/program/progress.h"

namespace mobil {

void RobustnessRun::at_most(std::string tried, std::string quantity, double bound, double value, std::string reason,
                            std::string detail) {
  rows.push_back({std::move(tried), std::move(quantity), Promise::at_most, bound, std::move(reason), value,
                  std::move(detail), entry});
}

void RobustnessRun::at_least(std::string tried, std::string quantity, double bound, double value, std::string reason,
                             std::string detail) {
  at_most(std::move(tried), std::move(quantity), bound, value, std::move(reason), std::move(detail));
  rows.back().promise = Promise::at_least;
}

namespace {

struct RobustnessCase {
  std::string_view name, about;
  void (*run)(RobustnessRun&);
};

constexpr std::array robustness_cases = {
    RobustnessCase{"slivers", "elements with a corner almost in the plane of its neighbours", &robustness_slivers},
    RobustnessCase{"aspect", "elements a hundred times longer than wide, and wider than long", &robustness_aspect},
    RobustnessCase{"inverted", "elements turned inside out", &robustness_inverted},
    RobustnessCase{"poisson", "nearly incompressible material", &robustness_poisson},
    RobustnessCase{"young", "Young's modulus over eight decades", &robustness_young},
    RobustnessCase{"damping", "no damping, and too much of it", &robustness_damping},
    RobustnessCase{"steps", "explicit steps just below and just above the critical one", &robustness_steps},
    RobustnessCase{"newmark", "constant average acceleration at absurd steps", &robustness_newmark},
    RobustnessCase{"step-load", "a load that is suddenly there", &robustness_step_load},
    RobustnessCase{"resonance", "a load at the lowest resonance", &robustness_resonance},
    RobustnessCase{"energy-single", "ten million steps in single precision", &robustness_energy_single},
    RobustnessCase{"denormals", "a ring that dies away below the smallest normal number", &robustness_denormals},
    RobustnessCase{"nan", "not-a-number and infinity in every input of a block", &robustness_nan},
    RobustnessCase{"explosion", "one exploding lane beside fifteen sound ones", &robustness_explosion},
    RobustnessCase{"excitation", "muscles excited by no numbers, on and off, and for minutes", &robustness_excitation},
    RobustnessCase{"contraction", "squats at full activation, and another method in every tick",
                   &robustness_contraction},
    RobustnessCase{"ways", "every method with every effect, shaken as no body can be", &robustness_ways},
    RobustnessCase{"walkers", "one person whose state is NaN among sixteen who walk", &robustness_walkers},
    RobustnessCase{"lod", "cameras that flicker, and a budget of nothing", &robustness_lod},
    RobustnessCase{"ticks", "from ten to a thousand ticks a second", &robustness_ticks},
    RobustnessCase{"far", "up to 999 km from the origin", &robustness_far},
    RobustnessCase{"day", "a day of walking, awake and asleep", &robustness_day},
};

struct RobustnessText {
  std::vector<std::string> names;
  std::optional<std::string> json, csv;
  bool list = false, quick = false;
};

std::string_view words(Promise promise) {
  return promise == Promise::at_most ? "at most" : "at least";
}

std::string promised(const RobustnessRow& row) {
  return fmt::format("{} {} {:.4g}", row.quantity, words(row.promise), row.bound);
}

std::string happened(const RobustnessRow& row) {
  return fmt::format("{:.4g}{}{}", row.value, row.detail.empty() ? "" : ", ", row.detail);
}

void print_row(const RobustnessRow& row) {
  print_output("{:<5} {:<13} {}: {} ({}): {}\n", row.held() ? "held" : "BROKE", row.entry, row.tried, promised(row),
             row.reason, happened(row));
}

Json number_or_name(double value) {
  if (std::isfinite(value)) return value;
  return std::isnan(value) ? "nan" : value > 0 ? "infinity" : "-infinity";
}

std::string to_json(const RobustnessRun& run, double seconds) {
  Json json;
  json["quick"] = run.quick;
  json["seconds"] = seconds;
  json["held"] = std::ranges::count_if(run.rows, &RobustnessRow::held);
  json["broken"] = std::ranges::count_if(run.rows, [](const RobustnessRow& row) { return !row.held(); });
  auto& rows = json["rows"] = Json::array();
  for (const RobustnessRow& row : run.rows) {
    rows.push_back({{"name", row.entry},
                    {"tried", row.tried},
                    {"promised", promised(row)},
                    {"reason", row.reason},
                    {"happened", happened(row)},
                    {"quantity", row.quantity},
                    {"promise", words(row.promise)},
                    {"bound", row.bound},
                    {"value", number_or_name(row.value)},
                    {"held", row.held()}});
  }
  return json.dump(2) + "\n";
}

std::string quoted(std::string text) {
  if (text.find_first_of(",\"") == std::string::npos) return text;
  for (std::size_t at = 0; (at = text.find('"', at)) != std::string::npos; at += 2) text.insert(at, 1, '"');
  return '"' + text + '"';
}

std::string to_csv(const RobustnessRun& run) {
  std::string text = "entry,tried,quantity,promise,bound,value,detail\n";
  for (const RobustnessRow& row : run.rows)
    text += fmt::format("{},{},{},{},{:.4g},{:.4g},{}\n", row.entry, quoted(row.tried), quoted(row.quantity),
                        words(row.promise), row.bound, row.value, quoted(row.detail));
  return text;
}

void print_list() {
  for (const RobustnessCase& one : robustness_cases) print_output("{:<13} {}\n", one.name, one.about);
}

void try_one(const RobustnessCase& one, RobustnessRun& run) {
  const std::size_t before = run.rows.size();
  run.entry = one.name;
  run.progress(0);
  if (const auto done = attempt([&] { one.run(run); }); !done) {
    run.at_most(std::string(one.about), "failures before anything could be tried", 0, 1, "all of this is within range",
                done.error().message);
  }
  show("");
  for (std::size_t i = before; i < run.rows.size(); ++i) print_row(run.rows[i]);
}

int robustness(const RobustnessText& text) {
  const auto chosen = choose_named(robustness_cases, text.names, "robustness");
  if (!chosen) return complain("robustness", chosen.error().message);
  const std::pair<const char*, const std::optional<std::string>&> files[] = {{"--json", text.json},
                                                                             {"--csv", text.csv}};
  for (const auto& [option, file] : files) {
    if (!file) continue;
    if (auto ok = check_result_place(option, *file); !ok) return complain("robustness", ok.error().message);
  }
  if (text.list) {
    print_list();
    return 0;
  }
  RobustnessRun run;
  run.quick = text.quick;
  run.show = &show_part;
  const auto start = std::chrono::steady_clock::now();
  for (const RobustnessCase& one : *chosen) try_one(one, run);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const auto broken = std::ranges::count_if(run.rows, [](const RobustnessRow& row) { return !row.held(); });
  print_output("{} of {} hold, in {:.0f} s\n", static_cast<std::ptrdiff_t>(run.rows.size()) - broken, run.rows.size(),
             seconds);
  for (const auto& [option, file] : files) {
    if (!file) continue;
    const std::string written = std::string_view(option) == "--json" ? to_json(run, seconds) : to_csv(run);
    if (auto ok = write_result(option, *file, written); !ok) return exit_status_of("robustness", ok);
  }
  return broken == 0 ? 0 : 1;
}

}  // namespace

Subcommand robustness_command() {
  auto text = std::make_shared<RobustnessText>();
  Subcommand command{.name = "robustness"};
  command.footer =
      "A line each: held or BROKE, the entry, what was tried: what is promised with its bound (why that bound): what\n"
      "was measured. Exit status 0 where all hold, 1 where some do not, 2 for bad usage.\n"
      "Example: mobil robustness slivers nan --csv robustness.csv";
  command.options = {named_option(robustness_cases, text->names, "try"),
                     {"--list", &text->list, "Say what there is to try, and try nothing"},
                     {"--quick", &text->quick, "Shorter long runs, some seconds in all"},
                     {"--csv", &text->csv, "File for the rows, one a promise"},
                     {"--json", &text->json, "The same with the reasons of the bounds"}};
  command.run = [text] { return robustness(*text); };
  return command;
}

}  // namespace mobil
