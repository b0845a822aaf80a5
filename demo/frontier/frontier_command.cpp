// `mobil frontier`: what accuracy costs.

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "assets/files/output_file.h"
#include "demo/frontier/frontier.h"
#include "demo/program/body_options.h"
#include "demo/program/commands.h"

namespace mobil {
namespace {

struct FrontierText {
  std::string out = "out", loads = "both";
  bool short_form = false, long_form = false, check = false;
};

/// On a terminal: what is being done and how far it is. Gone when the results are told.
void show(std::string_view what, double part) {
  if (isatty(STDERR_FILENO) == 0) return;
  fmt::print(stderr, "\r\033[K{} {:.0f} %", what, 100 * part);
  std::fflush(stderr);
}

Result<void> run_frontier(const FrontierText& text) {
  if (text.short_form && text.long_form) return fail("--short and --long are both asked for; give one of them");
  if (auto made = make_output_folder(text.out); !made) return made;
  FrontierRequest request = text.long_form ? long_frontier() : short_frontier();
  if (text.loads != "both") request.scenes = {text.loads == "frame"};
  if (text.check) request.checks = {{8, 8, 32}, {16, 16, 64}};
  request.progress = &show;
  const auto frontier = measure_frontier(request);
  if (isatty(STDERR_FILENO) != 0) std::fputs("\r\033[K", stderr);
  if (!frontier) return tl::unexpected(frontier.error());
  const std::filesystem::path out = text.out;
  if (auto done = write_file(out / "frontier.csv", frontier_csv(*frontier)); !done) return done;
  if (auto done = write_file(out / "frontier.svg", svg(frontier_figure(*frontier))); !done) return done;
  if (auto done = write_file(out / "frontier.json", frontier_json(*frontier)); !done) return done;
  fmt::print("{}\nwritten {}: frontier.csv frontier.svg frontier.json\n", frontier_text(*frontier), text.out);
  return {};
}

}  // namespace

void add_frontier_command(CLI::App& app, int& exit_status) {
  auto text = std::make_shared<FrontierText>();
  CLI::App* command =
      app.add_subcommand("frontier", "What accuracy costs: every way to deform a muscle, error and time");
  command->footer(
      "Sixteen walks by six bodies and speeds move four muscle groups; every method, mesh, step and number of vectors\n"
      "gets the same line of action (and once more with gravity and the frame's motion), tick by tick, and is held\n"
      "against a reference refined until it hardly moves. How much it still moves is told, and what is nearer than "
      "ten\n"
      "times that is marked uncertain. Costs are processor time of one thread with thousands of muscles, all ways in\n"
      "turn; ratios are to the paper's choice, 81 nodes stepped explicitly by 2 ms.\n"
      "On the frontier is what nothing else beats in both: nearer and cheaper. A reduced muscle that nobody looks at\n"
      "has a state but no control points; its cost with them is told beside.\n"
      "Methods (mobil muscle --help says what they are): static, ecd, icd, caa; reduced: so many vectors of a finer\n"
      "mesh, its error extrapolated away (reduced-plain: left in; reduced-static: without motion of its own).\n"
      "Examples: mobil frontier\n"
      "          mobil frontier --long --loads line --out frontier");
  command->option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  command->add_flag("--short", text->short_form, "A minute at most on two cores; the default");
  command->add_flag("--long", text->long_form, "All meshes, and a reference twice as fine: twenty minutes");
  command->add_option("--loads", text->loads, "line: of the line of action alone; frame: with the frame's too; or both")
      ->check(CLI::IsMember({"line", "frame", "both"}))
      ->capture_default_str();
  command->add_flag("--check", text->check,
                    "Hold the reference against plain explicit meshes too, up to 18785 nodes: four minutes more for "
                    "each muscle and kind of load");
  command->add_option("--out", text->out, "Folder for frontier.csv, .svg and .json, made if missing")
      ->capture_default_str();
  refuse_empty_values(*command);
  command->callback([text, &exit_status] { exit_status = exit_status_of("frontier", run_frontier(*text)); });
}

}  // namespace mobil
