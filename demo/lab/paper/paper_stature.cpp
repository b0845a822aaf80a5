// Three of the paper's questions. What is the difference if the person is taller or thinner? How can persons be
// represented who walk with the same speed but with different weights? How does the trajectory of the centre of mass
// change if the step length varies?

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "demo/lab/compare/compare_reference.h"
#include "demo/lab/compare/compare_walk.h"
#include "demo/lab/paper/paper.h"
#include "demo/pictures/cycle_plot.h"
#include "demo/program/body_options.h"

namespace mobil {
namespace {

struct StaturePerson {
  const char* what;
  float height_m, mass_kg;
  Constitution constitution;
};
constexpr std::array people = {StaturePerson{"reference", 1.80F, 80, Constitution::athletic},
                               StaturePerson{"taller", 1.95F, 80, Constitution::athletic},
                               StaturePerson{"shorter", 1.65F, 80, Constitution::athletic},
                               StaturePerson{"thinner", 1.80F, 65, Constitution::thin},
                               StaturePerson{"heavier", 1.80F, 100, Constitution::heavy}};

std::string label(std::size_t person) {
  const StaturePerson& p = people[person];
  return fmt::format("{}: {:.2f} m, {:.0f} kg, {}", p.what, p.height_m, p.mass_kg,
                     constitution_name[static_cast<std::size_t>(p.constitution)]);
}

void add_muscle_columns(const std::string& name, PaperTable& table) {
  const auto add = [&](const char* column, const std::string& head) {
    table.column.push_back({name + "_" + column, head, 1});
  };
  add("belly_mm", name + ": belly at rest, mm");
  add("thickness_mm", "  thickness at rest, mm");
  add("elongation_least_mm", "  longer by from, mm");
  add("elongation_most_mm", "  to, mm");
  add("bulge_mm", "  thicker by up to, mm");
}

/// Adds length and thickness at rest, elongation, and the increase of thickness over rest.
void add_muscle_cells(const MuscleCycle& muscle, std::vector<double>& cells) {
  const CycleRange elongation = range_of(muscle.elongation_m);
  const double bulge = range_of(muscle.thickness_m).high - muscle.rest_thickness_m;
  for (const double metres :
       {muscle.plan.belly_length_m, muscle.rest_thickness_m, elongation.low, elongation.high, std::max(bulge, 0.0)}) {
    cells.push_back(millimetres * metres);
  }
}

PaperTable stature_table(const std::vector<PaperCycle>& walks) {
  PaperTable table{"person",
                   {{"step_length_m", "step length, m", 3},
                    {"step_frequency_hz", "step frequency, Hz", 3},
                    {"com_excursion_mm", "centre of mass rises by, mm", 1}},
                   {}};
  add_muscle_columns("quadriceps", table);
  add_muscle_columns("hamstrings", table);
  for (std::size_t i = 0; i < walks.size(); ++i) {
    const PaperCycle& walk = walks[i];
    PaperTable::Row row{fmt::format("{}\n{:.2f} m {:.0f} kg\n{}", people[i].what, people[i].height_m, people[i].mass_kg,
                                    constitution_name[static_cast<std::size_t>(people[i].constitution)]),
                        {static_cast<double>(walk.gait.step_length_m), static_cast<double>(walk.gait.step_frequency_hz),
                         millimetres * range_of(walk.com_height_m).span()}};
    add_muscle_cells(walk.muscle(Muscle::quadriceps), row.value);
    add_muscle_cells(walk.muscle(Muscle::hamstrings), row.value);
    table.row.push_back(std::move(row));
  }
  return table;
}

PlotFigure stature_figure(const std::vector<PaperCycle>& walks) {
  PlotFigure figure{
      "Taller, shorter, thinner, heavier, all at 5 km/h",
      "Thickness: diameter of a round bar of the muscle's volume and length, as its mesh's widest section changes.", 3,
      250, 155};
  figure.panels = {cycle_panel("centre of mass", "height over its mean (mm)"),
                   cycle_panel("quadriceps", "elongation (mm)"),
                   cycle_panel("quadriceps", "thickness (mm)"),
                   cycle_panel("right foot", "vertical force (N)"),
                   cycle_panel("hamstrings", "elongation (mm)"),
                   cycle_panel("hamstrings", "thickness (mm)")};
  for (std::size_t i = 0; i < walks.size(); ++i) {
    const auto add = [&](std::size_t panel, const CycleCurve& curve, double scale, double from = 0) {
      figure.panels[panel].lines.push_back(
          {cycle_percents(), cycle_values(curve, scale, from), series_colour[i], label(i), 1.7, false});
    };
    const MuscleCycle& quadriceps = walks[i].muscle(Muscle::quadriceps);
    const MuscleCycle& hamstrings = walks[i].muscle(Muscle::hamstrings);
    add(0, walks[i].com_height_m, millimetres, mean_of(walks[i].com_height_m));
    add(1, quadriceps.elongation_m, millimetres);
    add(2, quadriceps.thickness_m, millimetres);
    add(3, walks[i].ground_n, 1);
    add(4, hamstrings.elongation_m, millimetres);
    add(5, hamstrings.thickness_m, millimetres);
  }
  return figure;
}

/// Returns, for example, "12.3 mm longer" or "as long".
std::string by(double difference_mm, const char* more, const char* less, const char* alike) {
  if (std::abs(difference_mm) < 0.05) return alike;
  return fmt::format("{:.1f} mm {}", std::abs(difference_mm), difference_mm > 0 ? more : less);
}

std::string answer(const PaperTable& table) {
  const auto& first = table.row[0].value;
  std::string text;
  for (const std::size_t other : {std::size_t{1}, std::size_t{3}}) {
    const auto& v = table.row[other].value;
    const auto muscle = [&](const char* is, const char* stretches, std::size_t at) {
      return fmt::format("the {} {} and {} at rest and {} {}", is,
                         by(v[at] - first[at], "longer", "shorter", "as long"),
                         by(v[at + 1] - first[at + 1], "thicker", "thinner", "as thick"), stretches,
                         by(v[at + 3] - first[at + 3], "more", "less", "as far"));
    };
    text += fmt::format("\nWho is {}: steps are {}, the centre of mass rises {};\n{};\n{}.\n", people[other].what,
                        by(millimetres * (v[0] - first[0]), "longer", "shorter", "as long"),
                        by(v[2] - first[2], "more", "less", "as far"), muscle("quadriceps is", "stretches", 3),
                        muscle("hamstrings are", "stretch", 8));
  }
  return text;
}

Image stature_picture(const std::vector<PaperCycle>& walks) {
  const Camera camera = camera_at({0, 1.0F, 0}, 2.12F, 32, 3);
  return take_picture({camera, 940, 395}, side_by_side(walks, camera, 0.98F));
}

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

Image weight_picture(const std::vector<PaperCycle>& walks) {
  const Camera camera = camera_at({0, 0.93F, 0}, 1.98F, 32, 3);
  return take_picture({camera, 780, 480}, side_by_side(walks, camera, 1.0F));
}

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

void paper_stature(PaperRun& run) {
  std::vector<PaperCycle> walks;
  for (const StaturePerson& person : people) {
    run.progress("walking", static_cast<double>(walks.size()) / people.size());
    CycleRequest request{{}, paper_gait(), only({Muscle::quadriceps, Muscle::hamstrings}), {0.0}, {}};
    request.body.height_m = person.height_m;
    request.body.mass_kg = person.mass_kg;
    request.body.constitution = person.constitution;
    walks.push_back(walk_cycle(request));
  }
  const PaperTable table = stature_table(walks);
  run.text = turned_table_text(table) + answer(table);
  run.write_csv(table_csv(table));
  run.write(stature_figure(walks));
  run.write_picture("The picture: as in the table, all at the right heel strike.",
                    [&] { return stature_picture(walks); });
}

void paper_weight(PaperRun& run) {
  std::vector<PaperCycle> walks;
  for (std::size_t i = 0; i < masses_kg.size(); ++i) {
    run.progress("walking", static_cast<double>(i) / static_cast<double>(masses_kg.size()));
    CycleRequest request{paper_body(), paper_gait(), LegMuscles{}, {0.0}, {}};
    request.body.mass_kg = masses_kg[i];
    walks.push_back(walk_cycle(request));
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
  run.write_csv(table_csv(table));
  run.write(weight_figure(walks));
  run.write_picture("The picture: from left to right, all at the right heel strike.",
                    [&] { return weight_picture(walks); });
}

void paper_step_length(PaperRun& run) {
  CycleRequest request{paper_body(), paper_gait(), {}, {}, {}};
  // Steps 1.2 times as long as those in shoes would break the walk's limits.
  const float natural_m = *barefoot(request.body, request.gait).step_length_m;
  std::vector<PaperCycle> walks;
  for (const float times : times_natural) {
    run.progress("walking", static_cast<double>(walks.size() + 1) / (times_natural.size() + 1));
    request.gait.step_length_m = times * natural_m;
    walks.push_back(walk_cycle(request));
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
  run.write_csv(table_csv(table));
  run.write(step_length_figure(walks));
}

}  // namespace mobil
