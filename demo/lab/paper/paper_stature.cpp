// What is the difference if the person is taller or thinner?

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "demo/lab/paper/paper.h"
#include "demo/pictures/cycle_plot.h"
#include "demo/program/body_options.h"

namespace mobil {
namespace {

struct Person {
  const char* what;
  float height_m, mass_kg;
  Constitution constitution;
};
constexpr std::array people = {
    Person{"reference", 1.80F, 80, Constitution::athletic}, Person{"taller", 1.95F, 80, Constitution::athletic},
    Person{"shorter", 1.65F, 80, Constitution::athletic}, Person{"thinner", 1.80F, 65, Constitution::thin},
    Person{"heavier", 1.80F, 100, Constitution::heavy}};

std::string label(std::size_t person) {
  const Person& p = people[person];
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

/// Length and thickness at rest, elongation, and by how much it gets thicker than at rest.
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

/// "12.3 mm longer", "as long".
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

Result<Image> stature_picture(const std::vector<PaperCycle>& walks) {
  const Camera camera = camera_at({0, 1.0F, 0}, 2.12F, 32, 3);
  return take_picture({camera, 940, 395}, side_by_side(walks, camera, 0.98F));
}

}  // namespace

Result<void> paper_stature(PaperRun& run) {
  std::vector<PaperCycle> walks;
  for (const Person& person : people) {
    run.progress("walking", static_cast<double>(walks.size()) / people.size());
    CycleRequest request{{}, paper_gait(), only({Muscle::quadriceps, Muscle::hamstrings}), {0.0}, {}};
    request.body.height_m = person.height_m;
    request.body.mass_kg = person.mass_kg;
    request.body.constitution = person.constitution;
    auto walk = walk_cycle(request);
    if (!walk) return tl::unexpected(walk.error());
    walks.push_back(std::move(*walk));
  }
  const PaperTable table = stature_table(walks);
  run.text = turned_table_text(table) + answer(table);
  if (auto done = run.write_csv(table_csv(table)); !done) return done;
  if (auto done = run.write(stature_figure(walks)); !done) return done;
  return run.write_picture("The picture: as in the table, all at the right heel strike.",
                           [&] { return stature_picture(walks); });
}

}  // namespace mobil
