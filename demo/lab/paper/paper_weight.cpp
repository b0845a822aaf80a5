// How can persons be represented who walk with the same speed but with different weights?

#include <fmt/format.h>

#include <array>

#include "demo/lab/compare/compare_reference.h"
#include "demo/lab/paper/paper.h"
#include "demo/pictures/cycle_plot.h"

namespace mobil {
namespace {

constexpr std::array masses_kg = {65.0F, 80.0F, 120.0F};

std::string label(const PaperCycle& walk) {
  return fmt::format("{:.0f} kg", walk.body.request.mass_kg);
}

double weight_n(const PaperCycle& walk) {
  return static_cast<double>(walk.body.request.mass_kg) * gravity_m_s2;
}

PaperTable weight_table(const std::vector<PaperCycle>& walks) {
  PaperTable table{"mass",
                   {{"step_length_m", "step\nlength m", 3},
                    {"step_frequency_hz", "frequency\nHz", 3},
                    {"com_mean_height_mm", "centre of mass\nmean height mm", 1},
                    {"com_excursion_mm", "rises by\nmm", 1},
                    {"com_sideways_mm", "sways by\nmm", 1},
                    {"pelvis_height_mm", "pelvis\nheight mm", 1},
                    {"stance_s", "stance\ns", 3},
                    {"peak_vertical_n", "peak vertical\nforce N", 0},
                    {"peak_vertical_weights", "body\nweights", 3}},
                   {}};
  for (const PaperCycle& walk : walks) {
    const double peak = range_of(walk.ground_n).high;
    table.row.push_back(
        {label(walk),
         {static_cast<double>(walk.gait.step_length_m), static_cast<double>(walk.gait.step_frequency_hz),
          millimetres * mean_of(walk.com_height_m), millimetres * range_of(walk.com_height_m).span(),
          millimetres * range_of(walk.com_sideways_m).span(), millimetres * mean_of(walk.pelvis_height_m),
          walk.stance_s, peak, peak / weight_n(walk)}});
  }
  return table;
}

PlotFigure weight_figure(const std::vector<PaperCycle>& walks) {
  PlotFigure figure{"Same speed, different weights: 1.80 m, 5 km/h", "", 2, 320, 170};
  figure.panels = {cycle_panel("centre of mass, height over the ground", "mm"),
                   cycle_panel("centre of mass, to the left of the line walked", "mm"),
                   cycle_panel("pelvis, height over the ground", "mm"), cycle_panel("right foot, vertical force", "N")};
  for (std::size_t i = 0; i < walks.size(); ++i) {
    const auto add = [&](std::size_t panel, const CycleCurve& curve, double scale) {
      figure.panels[panel].lines.push_back(
          {cycle_percents(), cycle_values(curve, scale), series_colour[i], label(walks[i]), 1.8, false});
    };
    add(0, walks[i].com_height_m, millimetres);
    add(1, walks[i].com_sideways_m, millimetres);
    add(2, walks[i].pelvis_height_m, millimetres);
    add(3, walks[i].ground_n, 1);
  }
  return figure;
}

Result<Image> weight_picture(const std::vector<PaperCycle>& walks) {
  const Camera camera = camera_at({0, 0.93F, 0}, 1.98F, 32, 3);
  return take_picture({camera, 780, 480}, side_by_side(walks, camera, 1.0F));
}

}  // namespace

Result<void> paper_weight(PaperRun& run) {
  std::vector<PaperCycle> walks;
  for (std::size_t i = 0; i < masses_kg.size(); ++i) {
    run.progress("walking", static_cast<double>(i) / static_cast<double>(masses_kg.size()));
    CycleRequest request{paper_body(), paper_gait(), LegMuscles{}, {0.0}, {}};
    request.body.mass_kg = masses_kg[i];
    auto walk = walk_cycle(request);
    if (!walk) return tl::unexpected(walk.error());
    walks.push_back(std::move(*walk));
  }
  const PaperTable table = weight_table(walks);
  const auto& lightest = table.row.front().value;
  const auto& heaviest = table.row.back().value;
  const std::string stance = std::abs(heaviest[6] - lightest[6]) < 0.0005
                                 ? fmt::format("stays {:.3f} s", heaviest[6])
                                 : fmt::format("lasts {:.3f} s instead of {:.3f}", heaviest[6], lightest[6]);
  run.text = table_text(table) +
             fmt::format(
                 "\nFrom {} to {} at the same speed the centre of mass is {:.0f} mm {} in the mean and rises by {:.1f} "
                 "mm\ninstead of {:.1f}; stance {}, and the peak force under a foot grows {:.2f} times, "
                 "weight {:.2f} times.\n",
                 table.row.front().label, table.row.back().label, std::abs(heaviest[2] - lightest[2]),
                 heaviest[2] < lightest[2] ? "lower" : "higher", heaviest[3], lightest[3], stance,
                 heaviest[7] / lightest[7], weight_n(walks.back()) / weight_n(walks.front()));
  if (auto done = run.write_csv(table_csv(table)); !done) return done;
  if (auto done = run.write(weight_figure(walks)); !done) return done;
  return run.write_picture("The picture: from left to right, all at the right heel strike.",
                           [&] { return weight_picture(walks); });
}

}  // namespace mobil
