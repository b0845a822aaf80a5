// `mobil paper`: the paper's figures 14 to 17 and its four questions, each by one name.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <memory>
#include <system_error>

#include <mobil/assets/files/output_file.h>
#include <mobil/png.h>
#include <mobil/schedule.h>
#include "demo/lab/paper/paper.h"
#include "demo/program/commands.h"
#include "demo/program/console.h"
#include "demo/program/named_entries.h"
#include "demo/program/progress.h"

namespace mobil {
namespace {

struct Entry {
  std::string_view name, about;
  void (*make)(PaperRun&);
  bool needs_anatomy = false;
};

constexpr std::array entries = {
    Entry{"figure14", "hamstring mesh of 525 nodes at three moments, force in, displacement out (svg, csv)",
          &paper_figure14},
    Entry{"figure15", "muscle lengths over the cycle against published ones (svg, csv)", &paper_figure15},
    Entry{"figure16", "skeleton with hamstrings: a still and a sequence over a cycle (png)", &paper_figure16},
    Entry{"figure17", "hamstrings as mesh, as surface, and both (png)", &paper_figure17},
    Entry{"weight", "How do persons of different weights walk at the same speed? (svg, csv, png)", &paper_weight},
    Entry{"step-length", "How does the centre of mass's path change with step length? (svg, csv)", &paper_step_length},
    Entry{"quadriceps", "How does a walker's quadriceps deform, at other steps too? (svg, csv, png)",
          &paper_quadriceps},
    Entry{"stature", "What if the person is taller or thinner? (svg, csv, png)", &paper_stature},
    Entry{"contraction", "muscles that pull: activation, fibres and tendons; relaxed and contracted (svg, csv, png)",
          &paper_contraction},
    Entry{"anatomy", "real meshes beside built-in ones over a cycle (png; needs --anatomy)", &paper_anatomy, true},
};

struct PaperText {
  std::vector<std::string> names;
  std::string out = "out", anatomy;
};

std::string help_footer() {
  std::string text = "Entries:\n";
  for (const Entry& entry : entries) text += fmt::format("  {:<12} {}\n", entry.name, entry.about);
  return text +
         "\nThe paper: S. Baldassarri, F. Seron, Coordinated System for Real Time Muscle Deformation during\n"
         "Locomotion. Unless an entry says otherwise a man of 1.80 m and 80 kg walks at 5 km/h. Cycles are the right\n"
         "leg's, from heel strike to heel strike; forces are the paper's visual ones (equations 2 and 3), not\n"
         "physiological. Files are named for their entries; pictures need a graphics device or a software driver, and "
         "are\nleft out without.\n"
         "Examples: mobil paper\n"
         "          mobil paper figure15 weight --out gallery\n"
         "          mobil paper anatomy --anatomy DIR";
}

/// Returns the named entries, or all that can be made if none was named.
Result<std::vector<Entry>> choose(const PaperText& text) {
  auto chosen = choose_named(entries, text.names, "entry");
  if (!chosen || !text.anatomy.empty()) return chosen;
  if (!text.names.empty()) {
    const auto lacking = std::ranges::find(*chosen, true, &Entry::needs_anatomy);
    if (lacking == chosen->end()) return chosen;
    return fail(fmt::format("{} needs --anatomy DIR, a folder of real meshes with manifest.csv and landmarks.csv",
                            lacking->name));
  }
  std::erase_if(*chosen, [](const Entry& entry) { return entry.needs_anatomy; });
  return chosen;
}

Result<void> make(const Entry& entry, const std::string& folder, PaperRun& run) {
  auto results = OutputFolder::make(folder);
  if (!results) return tl::unexpected(results.error());
  run.entry = entry.name;
  run.out = results->inside();
  run.text.clear();
  run.written.clear();
  run.progress("walking", 0);
  const auto done = attempt([&] { entry.make(run); }).and_then([&] { return results->put(); });
  show("");
  if (!done) return fail(fmt::format("{}: {}", entry.name, done.error().message));
  print_note("{}: {}\n\n{}", entry.name, entry.about.substr(0, entry.about.rfind(" (")), run.text);
  if (!run.written.empty()) say_where(fmt::format("written: {}", fmt::join(run.written, " ")));
  print_note("\n");
  return {};
}

Result<void> run_paper(const PaperText& text) {
  const auto chosen = choose(text);
  if (!chosen) return tl::unexpected(chosen.error());
  std::optional<std::filesystem::path> anatomy;
  if (!text.anatomy.empty()) anatomy = text.anatomy;
  std::error_code ignored;
  if (anatomy && !std::filesystem::exists(*anatomy / "manifest.csv", ignored)) {
    return fail(fmt::format("--anatomy {}: there is no manifest.csv; name a folder with manifest.csv and landmarks.csv",
                            anatomy->string()));
  }
  PaperRun run(anatomy);
  for (const Entry& entry : *chosen) {
    if (auto done = make(entry, text.out, run); !done) return done;
  }
  say_where(fmt::format("look at {}", text.out));
  return {};
}

}  // namespace

Subcommand paper_command() {
  auto text = std::make_shared<PaperText>();
  Subcommand command{.name = "paper"};
  command.footer = help_footer();
  command.options = {named_option(entries, text->names, "make"),
                     {"--out", &text->out, "Folder for the results, made if missing"},
                     {"--anatomy", &text->anatomy, "Folder of real meshes with manifest.csv and landmarks.csv"}};
  command.empty_refused = true;
  command.run = [text] { return exit_status_of("paper", run_paper(*text)); };
  return command;
}

void PaperRun::progress(std::string_view what, double part) const {
  show_part(fmt::format("{}: {}", entry, what), part);
}

void PaperRun::write(const PlotFigure& figure) {
  written.push_back(entry + ".svg");
  must(write_file(out / written.back(), svg(figure)));
}

void PaperRun::write_csv(const std::string& csv_text) {
  written.push_back(entry + ".csv");
  must(write_file(out / written.back(), csv_text));
}

void PaperRun::write_picture(std::string_view caption, const std::function<Image()>& make) {
  if (blind_) return;
  progress("pictures", 0.9);
  const auto image = attempt(make);
  if (!image) {
    blind_ = true;
    text += fmt::format("No pictures: {}\n", image.error().message);
    return;
  }
  text += fmt::format("{}{}\n", text.empty() ? "" : "\n", caption);
  written.push_back(entry + ".png");
  must(write_png((out / written.back()).string(), *image, PngEffort::small));
}

BodyRequest paper_body() {
  BodyRequest body;
  body.height_m = paper_height_m;
  body.mass_kg = paper_mass_kg;
  return body;
}

GaitRequest paper_gait() {
  GaitRequest gait;
  gait.speed_m_s = paper_speed_m_s;
  return gait;
}

LegMuscles only(std::initializer_list<Muscle> muscles) {
  LegMuscles choice;
  choice.muscles.reset();
  for (const Muscle muscle : muscles) choice.muscles.set(static_cast<std::size_t>(muscle));
  return choice;
}

}  // namespace mobil
