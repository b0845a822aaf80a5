// `mobil compare`: walks at the speeds of measured people, and a comparison with them.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <utility>

#include <mobil/anthropometry.h>
#include <mobil/assets/files/output_file.h>
#include <mobil/body_composition.h>
#include "demo/lab/compare/compare_muscles.h"
#include "demo/lab/compare/compare_verdicts.h"
#include "demo/pictures/cycle_plot.h"
#include "demo/pictures/svg_plot.h"
#include "demo/program/commands.h"
#include "demo/program/console.h"
#include "demo/program/must.h"
#include "demo/walk/walk_options.h"

namespace mobil {
namespace {

struct NamedPlot {
  std::string file, text;  // name without folder; the whole SVG
};

std::string set_colour(std::size_t set) {
  return set == 0 ? first_colour : second_colour;
}

struct Row {
  GaitQuantity quantity;
  const char* axis;
};

/// Ends the axis of a row where a curve leaves the measured range by far, because it would make all others flat.
void limit_row(std::span<PlotPanel> row) {
  constexpr double spare = 0.8;
  double low = INFINITY, high = -INFINITY, least = INFINITY, most = -INFINITY;
  for (const auto& panel : row) {
    for (const auto& band : panel.bands) {
      low = std::min(low, std::ranges::min(band.low));
      high = std::max(high, std::ranges::max(band.high));
    }
    for (const auto& line : panel.lines) {
      least = std::min(least, std::ranges::min(line.y));
      most = std::max(most, std::ranges::max(line.y));
    }
  }
  const double air = spare * (high - low);
  if (least < low - air) row.front().y.low = low - air;
  if (most > high + air) row.front().y.high = high + air;
}

/// Returns a grid: a row per quantity, a column per walk. Hips are drawn only over the set that measures them alike.
PlotFigure cycle_figure(const Comparison& comparison, const char* title, std::span<const Row> rows) {
  const GaitReference& reference = comparison.reference;
  PlotFigure figure{title, "", comparison.walks.size(), comparison.walks.size() > 3 ? 175.0 : 230.0, 140, true};
  for (const auto& row : rows) {
    for (const auto& walk : comparison.walks) {
      const MeasuredSet& own = reference.sets[walk.set];
      PlotPanel panel;
      if (&row == &rows.front()) {
        panel.title = fmt::format("{}, {:.2f} m/s", compared_class_name[walk.speed_class], walk.speed_m_s);
        if (reference.sets.size() > 1) panel.title += fmt::format(" ({})", own.name.substr(0, own.name.find(' ')));
      }
      if (&row == &rows.back()) panel.x.label = "% of the gait cycle";
      panel.x.low = 0;
      panel.x.high = 100;
      panel.y.label = row.axis;
      for (std::size_t s = 0; s < reference.sets.size(); ++s) {
        const bool other = s != walk.set;
        if (!reference.sets[s].measured[walk.speed_class][index(row.quantity)]) continue;
        if (other && row.quantity == GaitQuantity::hip) continue;
        add_measured(panel, reference.sets[s].scaled(walk.speed_class, row.quantity, walk.stride.leg_m),
                     reference.sets[s].name, set_colour(s), other);
      }
      if (const auto* curve = walk.stride.curve(row.quantity, own.hip_from_vertical)) {
        panel.lines.push_back({cycle_percents(), cycle_values(*curve), ours_colour, "mobil", 1.8, false});
      } else {
        figure.footnote = "Not simulated: what was measured alone.";
      }
      figure.panels.push_back(std::move(panel));
    }
    limit_row(std::span(figure.panels).last(comparison.walks.size()));
  }
  return figure;
}

constexpr Row angle_rows[] = {{GaitQuantity::hip, "hip flexion (deg)"},
                              {GaitQuantity::knee, "knee flexion (deg)"},
                              {GaitQuantity::ankle, "ankle dorsiflexion (deg)"}};
constexpr Row force_rows[] = {{GaitQuantity::vertical, "vertical (body weights)"},
                              {GaitQuantity::fore_aft, "forward (body weights)"}};
constexpr Row moment_rows[] = {{GaitQuantity::hip_moment, "hip extensor (N m/kg)"},
                               {GaitQuantity::knee_moment, "knee extensor (N m/kg)"},
                               {GaitQuantity::ankle_moment, "plantarflexor (N m/kg)"}};

/// Returns step length (m) or cadence (steps/min) of a person of that height.
double step_value(const StepNorm& step, bool cadence, double height, double deviations = 0) {
  return cadence ? 60 * (step.cadence + deviations * step.cadence_sd) * std::sqrt(gravity_m_s2 / height)
                 : (step.length + deviations * step.length_sd) * height;
}

/// Adds every band for people of these heights who walk at these speeds.
void add_step_bands(PlotPanel& panel, const GaitReference& reference, bool cadence, std::span<const double> x,
                    std::span<const double> speed, std::span<const double> height) {
  for (std::size_t b = 0; b < reference.steps.size(); ++b) {
    PlotBand band{{}, {}, {}, series_colour[b], reference.steps[b].name + " ± 1 SD", 0.22};
    for (std::size_t i = 0; i < x.size(); ++i) {
      const auto norm = reference.steps[b].at(speed[i] / std::sqrt(gravity_m_s2 * height[i]));
      if (!norm) continue;
      band.x.push_back(x[i]);
      band.low.push_back(step_value(*norm, cadence, height[i], -1));
      band.high.push_back(step_value(*norm, cadence, height[i], 1));
    }
    panel.bands.push_back(std::move(band));
  }
}

PlotLine step_line(const std::vector<VariedWalk>& walks, bool cadence) {
  PlotLine line{{}, {}, ours_colour, "mobil", 1.8, false};
  for (const auto& walk : walks) {
    line.x.push_back(walk.value);
    line.y.push_back(step_value(step_of(walk.stride), cadence, walk.stride.height_m));
  }
  return line;
}

/// Returns `count` values from `low` to `high`.
std::vector<double> between(double low, double high, std::size_t count) {
  std::vector<double> all;
  for (std::size_t i = 0; i < count; ++i) {
    all.push_back(low + (high - low) * static_cast<double>(i) / static_cast<double>(count - 1));
  }
  return all;
}

PlotFigure step_figure(const Comparison& comparison) {
  const double height = static_cast<double>(comparison.body.height_m);
  const double speed = comparison.by_height.front().stride.speed_m_s;
  PlotFigure figure{"Step length and cadence", "", 2, 300, 170};
  const auto speeds = between(comparison.by_speed.front().value, comparison.by_speed.back().value, 60);
  const auto heights = between(comparison.by_height.front().value, comparison.by_height.back().value, 60);
  for (const bool cadence : {false, true}) {
    PlotPanel by_speed{fmt::format("a person of {:.2f} m", height), {"speed (m/s)"}, {}, {}, {}, {}};
    by_speed.y.label = cadence ? "cadence (steps/min)" : "step length (m)";
    add_step_bands(by_speed, comparison.reference, cadence, speeds, speeds, std::vector<double>(60, height));
    by_speed.lines.push_back(step_line(comparison.by_speed, cadence));
    PlotPanel by_height{fmt::format("at {:.2f} m/s", speed), {"height (m)"}, {}, {}, {}, {}};
    by_height.y.label = by_speed.y.label;
    add_step_bands(by_height, comparison.reference, cadence, heights, std::vector<double>(60, speed), heights);
    by_height.lines.push_back(step_line(comparison.by_height, cadence));
    figure.panels.push_back(std::move(by_speed));
    figure.panels.push_back(std::move(by_height));
  }
  return figure;
}

PlotPanel height_panel(const char* title, const std::vector<VariedWalk>& walks, const char* unit) {
  PlotPanel panel{title, {"% of the gait cycle", 0, 100}, {"height over the ground (mm)"}, {}, {}, {}, true};
  for (std::size_t i = 0; i < walks.size(); ++i) {
    const auto y = cycle_values(walks[i].stride.com_height, 1000);
    const char* colour = series_colour[i % std::size(series_colour)];
    panel.lines.push_back({cycle_percents(), y, colour, fmt::format("{:.3g} {}", walks[i].value, unit), 1.6, false});
  }
  return panel;
}

PlotFigure centre_of_mass_figure(const Comparison& comparison) {
  PlotFigure figure{"Centre of mass",
                    "Longer steps and heavier people: at the same speed. Orendurff: in proportion to the leg, straight between speeds.",
                    2, 370, 170};
  PlotPanel cycle{"height (m/s)", {"% of the gait cycle", 0, 100}, {"over its mean (mm)"}, {}, {}, {}, true};
  PlotPanel excursion{"rise", {"speed (m/s)"}, {"excursion (mm)"}, {}, {}, {}, true};
  for (const auto& walk : comparison.walks) {
    if (walk.set != 0) continue;
    cycle.lines.push_back({cycle_percents(), cycle_values(walk.stride.com_height, 1000, walk.stride.com_mean_m),
                           series_colour[walk.speed_class], fmt::format("{:.2f}", walk.speed_m_s), 1.6, false});
  }
  PlotBand band{{}, {}, {}, first_colour, "Orendurff 2004 ± 1 SD", 0.28};
  for (const VariedWalk& walk : comparison.by_speed) {
    const ExcursionNorm norm = excursion_of(comparison.reference, walk.stride);
    band.x.push_back(norm.speed_m_s);
    band.low.push_back(1000 * (norm.mean_m - norm.sd_m));
    band.high.push_back(1000 * (norm.mean_m + norm.sd_m));
  }
  excursion.bands.push_back(std::move(band));
  PlotLine line{{}, {}, ours_colour, "mobil", 1.8, false};
  for (const auto& walk : comparison.by_speed) {
    line.x.push_back(walk.value);
    line.y.push_back(1000 * (walk.stride.com_highest_m - walk.stride.com_lowest_m));
  }
  excursion.lines.push_back(std::move(line));
  figure.panels = {std::move(cycle), std::move(excursion), height_panel("longer steps", comparison.by_step_length, "m"),
                   height_panel("heavier people", comparison.by_mass, "kg")};
  return figure;
}

/// Draws angles.svg, ground_reaction.svg, moments.svg, steps.svg, centre_of_mass.svg.
std::vector<NamedPlot> comparison_plots(const Comparison& comparison) {
  PlotFigure angles = cycle_figure(comparison, "Joint angles", angle_rows);
  angles.footnote = "Hip: from the tilted pelvis";
  for (const auto& set : comparison.reference.sets) {
    if (set.hip_from_vertical) angles.footnote += fmt::format("; in {} from the vertical", set.name);
  }
  angles.footnote += ".";
  return {{"angles.svg", svg(angles)},
          {"ground_reaction.svg", svg(cycle_figure(comparison, "Ground reaction of one foot", force_rows))},
          {"moments.svg", svg(cycle_figure(comparison, "Joint moments", moment_rows))},
          {"steps.svg", svg(step_figure(comparison))},
          {"centre_of_mass.svg", svg(centre_of_mass_figure(comparison))}};
}

struct CompareText {
  WalkText walk;
  std::string reference, out = "out";
  bool check = false;
};

// Speeds and sizes for a man of 1.75 m and 75 kg. Those of other people are in proportion.
constexpr float varied_speed = 5 / 3.6F;     // the paper's natural step
constexpr float varied_height_speed = 1.3F;  // within every height's published range
constexpr float slowest = 0.7F, fastest = 1.9F, shortest = 1.5F / 1.75F, tallest = 1.9F / 1.75F;

/// Settings common to all walks of a comparison.
struct Walker {
  BodyRequest body;
  GaitStyle style;

  WalkedStride at(float speed_m_s) const { return walk(body, speed_m_s); }
  WalkedStride walk(const BodyRequest& who, float speed_m_s, std::optional<float> step_length_m = {}) const {
    GaitRequest gait;
    gait.speed_m_s = speed_m_s;
    gait.step_length_m = step_length_m;
    gait.style = style;
    return walk_stride(who, gait);
  }
};

void walk_reference_speeds(const Walker& walker, Comparison& comparison) {
  const auto body = must(make_body(walker.body));
  for (std::size_t s = 0; s < comparison.reference.sets.size(); ++s) {
    for (std::size_t c = 0; c < speed_class_count; ++c) {
      if (!comparison.reference.sets[s].has_class(c)) continue;
      const double speed = comparison.reference.sets[s].speed_m_s(c, static_cast<double>(body.hip_height_m));
      comparison.walks.push_back({s, c, speed, walker.at(static_cast<float>(speed))});
    }
  }
}

float living_mass(const BodyRequest& body, float mass_kg) {
  const MassRange living = living_mass_kg(static_cast<double>(body.height_m), body.age_y);
  return std::clamp(mass_kg, static_cast<float>(living.low_kg), static_cast<float>(living.high_kg));
}

void walk_variations(const Walker& walker, Comparison& comparison) {
  const float pace = pace_of(walker.body);
  for (int i = 0; i <= 6; ++i) {
    const float speed = pace * (slowest + (fastest - slowest) * static_cast<float>(i) / 6);
    comparison.by_speed.push_back({static_cast<double>(speed), walker.at(speed)});
  }
  for (int i = 0; i <= 4; ++i) {
    BodyRequest body = walker.body;
    const StatureRange living = living_height_m(body.sex, body.age_y);
    body.height_m = std::clamp(walker.body.height_m * (shortest + (tallest - shortest) * static_cast<float>(i) / 4),
                               static_cast<float>(living.low_m), static_cast<float>(living.high_m));
    const float ratio = body.height_m / walker.body.height_m;
    body.mass_kg = living_mass(body, walker.body.mass_kg * ratio * ratio);  // the same body mass index
    comparison.by_height.push_back({static_cast<double>(body.height_m), walker.walk(body, pace * varied_height_speed)});
  }
  const auto natural = walker.at(pace * varied_speed);
  for (const float times : {0.9F, 1.0F, 1.1F}) {
    const float length = times * static_cast<float>(natural.step_length_m);
    comparison.by_step_length.push_back(
        {static_cast<double>(length), walker.walk(walker.body, pace * varied_speed, length)});
  }
  for (const float mass : {65.0F, 80.0F, 120.0F}) {
    BodyRequest body = walker.body;
    body.mass_kg = living_mass(body, mass / 75 * walker.body.mass_kg);
    comparison.by_mass.push_back({static_cast<double>(body.mass_kg), walker.walk(body, pace * varied_speed)});
  }
}

void write_all(const std::filesystem::path& out, const Comparison& comparison, const std::vector<Verdict>& verdicts,
               const MuscleComparison& muscles) {
  auto results = must(OutputFolder::make(out));
  const auto& inside = results.inside();
  must(write_file(inside / "compare.json", comparison_json(comparison, verdicts)));
  must(write_file(inside / "muscle_forces.json", muscle_json(muscles)));
  must(write_file(inside / "muscle_forces.svg", muscle_plot(muscles)));
  for (const auto& plot : comparison_plots(comparison)) must(write_file(inside / plot.file, plot.text));
  must(results.put());
}

/// Returns true if every bound held.
bool run_compare(const CompareText& text) {
  const auto options = must(read_walk_options(text.walk));
  const auto folder = text.reference.empty() ? std::nullopt : std::optional<std::filesystem::path>(text.reference);
  auto reference = must(read_gait_reference(folder, static_cast<double>(options.body.age_y)));
  Comparison comparison{options.body, std::move(reference), {}, {}, {}, {}, {}, {}};
  const Walker walker{options.body, options.gait.style};
  walk_reference_speeds(walker, comparison);
  walk_variations(walker, comparison);
  comparison.balance = walk_balance_scenes(options.body, options.gait.style);
  const auto verdicts = judge(comparison);
  const auto muscles = compare_muscles(options.body, options.gait.style);
  write_all(text.out, comparison, verdicts, muscles);
  write_note(comparison_text(comparison, verdicts) + muscle_text(muscles));
  say_where(
      fmt::format("look at {}: compare.json muscle_forces.json angles.svg ground_reaction.svg moments.svg steps.svg "
                  "centre_of_mass.svg muscle_forces.svg",
                  text.out));
  return std::ranges::all_of(verdicts, [](const Verdict& verdict) { return verdict.held.value_or(false); });
}

}  // namespace

Subcommand compare_command() {
  auto text = std::make_shared<CompareText>();
  Subcommand command{.name = "compare"};
  command.footer =
      "Writes compare.json and plots of ours over the measured bands (SVG). The program carries the curves of\n"
      "Schwartz et al. 2008 (for people up to 17 also of Pinzone et al. 2014), the steps of Lencioni et al. 2019,\n"
      "and electromyograms of Santuz and of Bovi et al. 2011.\n"
      "muscle_forces.json and muscle_forces.svg: which moments the muscles make, their activation, and forces in the "
      "joints.\n"
      "Example: mobil compare --height 1.75 --mass 75 --check --out out";
  add_options(command, body_options(text->walk.body));
  add_options(command,
              {{"--set", &text->walk.set,
                "NAME=VALUE: any gait parameter of mobil walk --list-parameters; again for more", "Gait"},
               {"--reference", &text->reference,
                "Folder with winter_joint_angles.csv, _moments.csv, winter_grf.csv (and others that replace what the "
                "program carries)"},
               {"--check", &text->check, "Exit status 1 where a bound does not hold or is not simulated"},
               {"--out", &text->out, "Folder for the results, made if missing"}});
  command.run = [text] {
    const auto held = attempt([&] { return run_compare(*text); });
    if (!held) return complain("compare", held.error().message);
    return text->check && !*held ? 1 : 0;
  };
  return command;
}

}  // namespace mobil
