// `mobil frontier`: accuracy and cost of methods.

#include <fmt/format.h>

#include <memory>

#include <mobil/assets/files/output_file.h>
#include <mobil/muscle_table.h>
#include "demo/lab/frontier/frontier.h"
#include "demo/lab/frontier/frontier_active.h"
#include "demo/program/commands.h"
#include "demo/program/console.h"
#include "demo/program/must.h"
#include "demo/program/progress.h"

namespace mobil {
namespace {

struct FrontierText {
  std::string out = "out", loads = "both";
  bool short_form = false, long_form = false, finite = false;
};

void run_finite(const std::string& out) {
  auto results = must(OutputFolder::make(out));
  std::vector<Muscle> all;
  for (std::size_t m = 0; m < muscles().size(); ++m) all.push_back(static_cast<Muscle>(m));
  const auto active = measure_active(all, &show_part);
  show("");
  const auto& folder = results.inside();
  must(write_file(folder / "active.csv", active_csv(active)));
  must(write_file(folder / "active.svg", svg(active_figure(active))));
  must(results.put());
  write_note(active_text(active));
  say_where(fmt::format("\nwritten {}: active.csv active.svg", out));
}

void run_frontier(const FrontierText& text) {
  if (text.finite) return run_finite(text.out);
  if (text.short_form && text.long_form) throw Stopped("--short and --long are both asked for; give one of them");
  auto results = must(OutputFolder::make(text.out));
  FrontierRequest request = text.long_form ? long_frontier() : short_frontier();
  if (text.loads != "both") request.scenes = {text.loads == "frame"};
  request.progress = &show_part;
  const auto frontier = measure_frontier(request);
  show("");
  const auto& out = results.inside();
  must(write_file(out / "frontier.csv", frontier_csv(frontier)));
  must(write_file(out / "frontier.svg", svg(frontier_figure(frontier))));
  must(results.put());
  write_note(frontier_text(frontier));
  say_where(fmt::format("\nwritten {}: frontier.csv frontier.svg", text.out));
}

}  // namespace

Subcommand frontier_command() {
  auto text = std::make_shared<FrontierText>();
  Subcommand command{.name = "frontier"};
  command.footer =
      "Sixteen walks by six bodies and speeds move four muscle groups; every method, mesh, step and number of modes\n"
      "gets the same line of action (and once more with gravity and the frame's motion), tick by tick, and is held\n"
      "against a reference refined until it hardly moves. How much it still moves is told, and what is nearer than\n"
      "ten times that is marked uncertain. Costs are processor time of one thread with thousands of muscles, all ways\n"
      "in turn; ratios are to the paper's choice, 81 nodes stepped explicitly by 2 ms.\n"
      "On the frontier is what nothing else beats in both: nearer and cheaper. A modal muscle that nobody looks at\n"
      "has a state but no control points; its cost with them is given as well.\n"
      "Methods (mobil muscle --help says what they are): static, explicit-central, implicit-central, newmark; modal: "
      "so many modes of a finer\n"
      "mesh, its error extrapolated away (modal-plain: left in; modal-static: without motion of its own).\n"
      "Examples: mobil frontier\n"
      "          mobil frontier --long --loads line --out frontier";
  command.options = {
      {"--short", &text->short_form, "A minute at most on two cores; the default"},
      {"--long", &text->long_form, "All meshes, and a reference twice as fine: twenty minutes"},
      {.name = "--loads",
       .target = &text->loads,
       .help = "line: of the line of action alone; frame: with the frame's too; or both",
       .choices = {"line", "frame", "both"}},
      {"--finite", &text->finite,
       "Instead: what accuracy costs where muscles pull and are shaken, against tissue that keeps its volume "
       "(active.csv, active.svg): three minutes"},
      {"--out", &text->out, "Folder for frontier.csv and .svg, made if missing"}};
  command.empty_refused = true;
  command.run = [text] { return exit_status_of("frontier", attempt([&] { run_frontier(*text); })); };
  return command;
}

}  // namespace mobil
