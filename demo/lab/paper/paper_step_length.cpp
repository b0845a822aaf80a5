// How does the trajectory of the centre of mass change if the step length varies?

#include <fmt/format.h>

#include <array>

#include "demo/lab/paper/paper.h"
#include "demo/pictures/cycle_plot.h"

namespace mobil {
namespace {

constexpr std::array times_natural = {0.8F, 1.0F, 1.2F};

std::string label(float times) {
  return times == 1 ? "natural" : fmt::format("{:+.0f} %", 100 * (times - 1));
}

PaperTable step_length_table(const std::vector<PaperCycle>& walks) {
  PaperTable table{"step length",
                   {{"step_length_m", "step\nlength m", 3},
                    {"step_frequency_hz", "frequency\nHz", 3},
                    {"com_mean_height_mm", "centre of mass\nmean height mm", 1},
                    {"com_lowest_mm", "lowest\nmm", 1},
                    {"com_highest_mm", "highest\nmm", 1},
                    {"com_excursion_mm", "rises by\nmm", 1},
                    {"com_sideways_mm", "sways by\nmm", 1},
                    {"peak_vertical_n", "peak vertical\nforce N", 0}},
                   {}};
  for (std::size_t i = 0; i < walks.size(); ++i) {
    const PaperCycle& walk = walks[i];
    const CycleRange height = range_of(walk.com_height_m);
    table.row.push_back({label(times_natural[i]),
                         {static_cast<double>(walk.gait.step_length_m),
                          static_cast<double>(walk.gait.step_frequency_hz), millimetres * mean_of(walk.com_height_m),
                          millimetres * height.low, millimetres * height.high, millimetres * height.span(),
                          millimetres * range_of(walk.com_sideways_m).span(), range_of(walk.ground_n).high}});
  }
  return table;
}

PlotFigure step_length_figure(const std::vector<PaperCycle>& walks) {
  PlotFigure figure{"Same speed, other steps: 1.80 m, 80 kg, 5 km/h", "", 3, 260, 180};
  figure.panels = {cycle_panel("height over the ground", "mm"), cycle_panel("to the left of the line walked", "mm"),
                   cycle_panel("seen from behind", "height (mm)")};
  figure.panels[2].x = {"to the right (mm)"};
  for (std::size_t i = 0; i < walks.size(); ++i) {
    const PaperCycle& walk = walks[i];
    const std::string name = fmt::format("{}, {:.3f} m", label(times_natural[i]), walk.gait.step_length_m);
    const auto height = cycle_values(walk.com_height_m, millimetres);
    const auto left = cycle_values(walk.com_sideways_m, millimetres);
    const auto rightward = cycle_values(walk.com_sideways_m, -millimetres);
    figure.panels[0].lines.push_back({cycle_percents(), height, series_colour[i], name, 1.8, false});
    figure.panels[1].lines.push_back({cycle_percents(), left, series_colour[i], name, 1.8, false});
    figure.panels[2].lines.push_back({rightward, height, series_colour[i], name, 1.8, false});
  }
  return figure;
}

}  // namespace

Result<void> paper_step_length(PaperRun& run) {
  CycleRequest request{paper_body(), paper_gait(), {}, {}, {}};
  const auto natural = walk_cycle(request);
  if (!natural) return tl::unexpected(natural.error());
  std::vector<PaperCycle> walks;
  for (const float times : times_natural) {
    run.progress("walking", static_cast<double>(walks.size() + 1) / (times_natural.size() + 1));
    request.gait.step_length_m = times * natural->gait.step_length_m;
    auto walk = walk_cycle(request);
    if (!walk) return tl::unexpected(walk.error());
    walks.push_back(std::move(*walk));
  }
  const PaperTable table = step_length_table(walks);
  const auto &short_steps = table.row.front().value, &usual = table.row[1].value, &long_steps = table.row.back().value;
  run.text = table_text(table) +
             fmt::format(
                 "\nSteps of {:.2f}, {:.2f} and {:.2f} m at the same speed let the centre of mass rise by {:.0f}, "
                 "{:.0f} and {:.0f} mm,\nabout a mean height of {:.0f}, {:.0f} and {:.0f} mm; it sways by {:.0f}, "
                 "{:.0f} and {:.0f} mm.\n",
                 short_steps[0], usual[0], long_steps[0], short_steps[5], usual[5], long_steps[5], short_steps[2],
                 usual[2], long_steps[2], short_steps[6], usual[6], long_steps[6]);
  if (auto done = run.write_csv(table_csv(table)); !done) return done;
  return run.write(step_length_figure(walks));
}

}  // namespace mobil
