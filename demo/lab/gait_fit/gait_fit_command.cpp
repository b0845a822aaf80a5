// `mobil fit-gait`: fits the table of steps to measured walking and writes it as source.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>

#include <mobil/assets/files/output_file.h>
#include <mobil/engine/error.h>
#include "demo/lab/gait_fit/excitation_fit.h"
#include "demo/lab/gait_fit/step_grid.h"
#include "demo/program/commands.h"
#include "demo/program/console.h"
#include "demo/program/must.h"
#include "demo/program/progress.h"

namespace mobil {
namespace {

using namespace step_table;

struct FitText {
  std::string out, kind = "man";
  bool styles = false, excitation = false;
  std::string without;
  std::size_t threads = 0;
};

void append(const TabledShape& shape, int digits, std::size_t a_line, std::string& text) {
  const auto out = std::back_inserter(text);
  const bool one_line = a_line == shape.size();
  text += "    {";
  for (std::size_t i = 0; i < shape.size(); ++i)
    fmt::format_to(out, "{}{:#.{}g}F,", i % a_line == 0 && !one_line ? "\n      " : " ", shape[i], digits);
  text += one_line ? " },\n" : "\n    },\n";
}

std::string source(const std::vector<StepNode>& nodes, std::string_view kind) {
  std::string text = fmt::format(
      "// Written by `mobil-lab fit-gait --kind {0} --out assets/gait/step_table_{0}.cpp` (sources: README.md). Do not "
      "edit.\n\n#include \"assets/gait/step_table.h\"\n\nnamespace mobil::inline v0_3 {{\n\n// clang-format off\n",
      kind);
  const auto out = std::back_inserter(text);
  if (kind == "man") {  // the same in all
    text += "const std::array<StepGiven, step_table::speed_count> step_given = {{\n";
    for (std::size_t s = 0; s < speed_count; ++s) {
      const StepTargets& t = nodes[s * length_count].targets;
      fmt::format_to(out, "  {{{:#.6g}, {:#.6g}, {:#.6g}, {:#.6g}, {:#.6g}}},\n", t.step_length, t.double_support,
                     t.pelvis_tilt, t.pelvis_rotation, t.pelvis_list);
    }
    text += "}};\n\n";
  }
  fmt::format_to(out, "const StepShapes step_shapes_{} = {{{{\n", kind);
  for (std::size_t s = 0; s < speed_count; ++s) {
    text += "  {{\n";
    for (std::size_t l = 0; l < length_count; ++l) {
      fmt::format_to(out, "    // speed {:g}, length {:g}\n", speed[s], length[l]);
      append(tabled(nodes[s * length_count + l].shape), 6, 16, text);
    }
    text += "  }},\n";
  }
  return text + "}};\n// clang-format on\n\n}  // namespace mobil::inline v0_3\n";
}

/// Returns the source of style changes, for every usual node of this program's table.
std::string styles_source(const GaitReference& reference, const Jobs& jobs) {
  std::vector<StyleChanges> changes(speed_count);
  in_parallel(jobs, speed_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      StepNode node = step_node({&reference}, s, usual);
      node.shape = fitted(step_shapes(StepKind::man)[s][usual]);
      changes[s] = style_changes(node);
      show(fmt::format("speed {:g}", speed[s]));
    }
  });
  std::string text =
      "// Written by `mobil fit-gait --styles --out assets/gait/step_styles.cpp` from step_table.cpp: README.md. Do "
      "not "
      "edit.\n\n"
      "#include \"assets/gait/step_styles.h\"\n\nnamespace mobil::inline v0_3 {\n\n// clang-format off\n"
      "const std::array<std::array<TabledShape, style_effects.size()>, step_table::speed_count> step_styles = {{\n";
  const auto out = std::back_inserter(text);
  for (std::size_t s = 0; s < speed_count; ++s) {
    text += "  {{\n";
    for (std::size_t k = 0; k < changes[s].size(); ++k) {
      fmt::format_to(out, "    // speed {:g}, {}\n", speed[s], style_effects[k].what);
      append(tabled(changes[s][k]), 4, step_shape::size, text);
    }
    text += "  }},\n";
  }
  return text + "}};\n// clang-format on\n\n}  // namespace mobil::inline v0_3\n";
}

void print(const std::vector<StepNode>& nodes) {
  print_note("\n{:>5} {:>6} {:>7}  {:<14} {:<11} {:<17} {:<14} {:>5} {:>5} {:>5} {:>5} {:>5} {:>5}\n", "speed",
             "length", "cost", "angles, deg", "forces, r", "moments, r", "rates", "CoP", "aside", "slack", "clear",
             "pad", "rise");
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const StepNode& node = nodes[i];
    const StepQuality q = step_quality(node.task, node.targets, fitted(tabled(node.shape)));
    print_note(
        "{:>5.2f} {:>6.2f} {:>7.2f}  {:.1f} {:.1f} {:.1f}    {:.3f} {:.3f} {:.3f} {:.3f} {:.3f} {:.2f} {:.2f} {:.2f} ",
        speed[i / length_count], length[i % length_count], node.cost, q.rms[0], q.rms[1], q.rms[2], q.correlation[3],
        q.correlation[4], q.correlation[5], q.correlation[6], q.correlation[7], q.rate[0], q.rate[1], q.rate[2]);
    for (const double m : {q.lacking_m, q.aside_m, q.slack_m, q.clearance_m, q.pad_m, q.rise_m})
      print_note("{:>5.1f} ", 1000 * m);
    print_note("\n");
  }
  print_note("rates: the fastest change of hip, knee and ankle over the measured one's\n");
  print_note("CoP: most that the centre of pressure is moved for exact balance, and the like, mm\n");
}

void run_fit(const FitText& text) {
  if (text.excitation && (text.styles || !text.without.empty()))
    throw Stopped("--excitation is a table of its own; give it without --styles and --without");
  if (text.styles && !text.without.empty())
    throw Stopped("--styles and --without: styles change the table that this program has; give one of the two");
  if (text.excitation) {
    const auto fit = fit_excitation();
    must(write_file(text.out, fit.source));
    print_note("correlation with what was measured, or shared\n{}", fit.quality);
    say_where(fmt::format("look at {}", text.out));
    return;
  }
  const auto reference = must(read_gait_reference({}));
  constexpr std::array<std::string_view, step_kinds> kinds = {"man", "woman", "child"};
  const auto kind = std::ranges::find(kinds, text.kind);
  if (kind == kinds.end()) throw Stopped(fmt::format("--kind {}: choose man, woman or child", text.kind));
  FitData data{&reference, static_cast<StepKind>(kind - kinds.begin())};
  if (!text.without.empty()) {
    const auto named = std::ranges::find(compared_class_name, text.without);
    if (named == compared_class_name.end() || named == compared_class_name.begin() ||
        named + 1 == compared_class_name.end())
      throw Stopped(fmt::format("--without {}: name a speed between others: slow, free or fast", text.without));
    data.without = static_cast<std::size_t>(named - compared_class_name.begin());
  }
  const Threads threads(static_cast<int>(text.threads));
  if (text.styles) {
    const std::string styles = styles_source(reference, threads.jobs());
    show("");
    return must(write_file(text.out, styles));
  }
  auto nodes = fit_grid(data, threads.jobs(), [](const char* stage, double cost) {
    show(fmt::format("{}: sum of squares {:.2f}", stage, cost));
  });
  show("");
  must(write_file(text.out, source(nodes, text.kind)));
  for (StepNode& node : nodes)  // judged by all speeds
    node.targets = step_targets(reference, data.set, node.targets.speed, node.task.body.leg);
  print(nodes);
  say_where(fmt::format("look at {}", text.out));
}

}  // namespace

Subcommand gait_fit_command() {
  auto text = std::make_shared<FitText>();
  Subcommand command{.name = "fit-gait"};
  command.footer =
      "For those who change the library: some minutes. Prints how near each step is to what it was fitted to.\n"
      "Example: mobil fit-gait --kind woman --out assets/gait/step_table_woman.cpp";
  add_options(command,
              {{"--out", &text->out, "Source file to write"},
               {"--kind", &text->kind, "man, woman or child: whose steps are fitted"},
               {"--styles", &text->styles, "Write how this program's table changes with the posture of a walk instead"},
               {"--excitation", &text->excitation, "Write how muscles are excited instead: a second"},
               {"--without", &text->without,
                "slow, free or fast: leave this measured speed out and be judged by it all the same"},
               {"--threads", &text->threads, "0: as many as the machine has"}});
  command.run = [text] { return exit_status_of("fit-gait", attempt([&] { run_fit(*text); })); };
  return command;
}

}  // namespace mobil
