// Figures 16 and 17: the hamstrings in a walking skeleton, and as mesh and surface. Also a comparison of real meshes
// with built-in ones. How does the quadriceps of a person of 1.80 m, 80 kg and athletic constitution deform when he
// walks at 5 km/h? And with a specific step length or step frequency?

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include <mobil/engine/geometry.h>
#include "demo/lab/paper/paper.h"
#include "demo/pictures/contact_sheet.h"
#include "demo/pictures/cycle_plot.h"

namespace mobil {
namespace {

using namespace geometry;

constexpr std::size_t sequence = 8;
constexpr double still_at = 0.9;  // the thigh swung forward, the hamstrings stretched

std::vector<double> evenly(std::size_t count) {
  std::vector<double> at;
  for (std::size_t i = 0; i < count; ++i) at.push_back(static_cast<double>(i) / static_cast<double>(count));
  return at;
}

/// Draws a person's legs from the side at every moment, as a row of pictures.
std::vector<Image> row_of(const ShownWalk& walk) {
  std::vector<Image> row;
  for (std::size_t frame = 0; frame < walk.recording.frames.size(); ++frame) {
    const Actor actor{&walk, frame};
    row.push_back(take_picture({camera_at({0, 0.55F, 0}, 1.22F, 20, 4), 145, 180}, {&actor, 1}));
  }
  return row;
}

/// Draws the frames of a sequence, and the still as the last.
Image figure16(const ShownWalk& walk) {
  constexpr float apart_m = 0.92F;
  const Actor actor{&walk, sequence};
  auto left = take_picture({camera_at({0, 0.66F, 0}, 1.42F, -42, 4), 200, 305}, {&actor, 1});
  const Camera camera = camera_at({0, 0.93F, 0}, 1.98F, 6, 3);
  std::vector<Actor> actors;
  for (std::size_t i = 0; i < sequence; ++i) {
    const float place = apart_m * (static_cast<float>(i) - (static_cast<float>(sequence) - 1) / 2);
    actors.push_back({.walk = &walk, .frame = i, .at = place * across(camera)});
  }
  auto right = take_picture({camera, 1165, 305}, actors);
  const std::vector<Image> row = {std::move(left), std::move(right)};
  return contact_sheet({&row, 1}, 4);
}

Image figure17(const ShownWalk& walk) {
  std::vector<Image> row;
  for (const auto& [surface, mesh] : {std::pair{false, true}, {true, false}, {true, true}}) {
    const Actor actor{&walk, 0, {}, Actor::Bones::right_leg, surface ? Actor::Muscles::right : Actor::Muscles::none,
                      mesh};
    row.push_back(take_picture({camera_at({-0.09F, 0.68F, 0.03F}, 0.66F, -50, 3), 300, 540, false}, {&actor, 1}));
  }
  return contact_sheet({&row, 1}, 4);
}

CycleRequest hamstrings_alone(std::vector<double> shown_at) {
  return {paper_body(), paper_gait(), only({Muscle::hamstrings}), std::move(shown_at), {}};
}

constexpr float asked_length_m = 0.85F, asked_frequency_hz = 2.1F;
/// Phases of the pictures: heel strike, mid-stance, toe-off, maximum flexion in swing.
const std::vector<double> shown_at = {0.02, 0.30, 0.60, 0.72};

struct Variant {
  std::string label;
  PaperCycle walk;
  const MuscleCycle& quadriceps() const { return walk.muscle(Muscle::quadriceps); }
};

std::vector<Variant> walk_variants(PaperRun& run) {
  CycleRequest request{paper_body(), paper_gait(), only({Muscle::quadriceps}), shown_at, {}};
  request.body.constitution = Constitution::athletic;
  std::vector<Variant> variants;
  for (const char* kind : {"natural", "length", "frequency"}) {
    run.progress("walking", static_cast<double>(variants.size()) / 3);
    request.gait = paper_gait();
    if (kind[0] == 'l') request.gait.step_length_m = asked_length_m;
    if (kind[0] == 'f') request.gait.step_frequency_hz = asked_frequency_hz;
    auto walk = walk_cycle(request);
    std::string label = kind[0] == 'l'   ? fmt::format("steps of {:.2f} m", asked_length_m)
                        : kind[0] == 'f' ? fmt::format("{:.1f} steps a second", asked_frequency_hz)
                                         : "natural steps";
    variants.push_back({std::move(label), std::move(walk)});
    request.shown_at.clear();
  }
  return variants;
}

PaperTable quadriceps_table(const std::vector<Variant>& variants) {
  PaperTable table{"over the cycle",
                   {{"step_length_m", "step length, m", 3},
                    {"step_frequency_hz", "step frequency, Hz", 3},
                    {"line_rest_mm", "line of action at rest, mm", 1},
                    {"line_shortest_mm", "  shortest, mm", 1},
                    {"line_longest_mm", "  longest, mm", 1},
                    {"longest_at_percent", "  longest at, % of the cycle", 0},
                    {"elongation_mm", "belly longer than at rest by up to, mm", 1},
                    {"pull_least_n", "force on its end from, N", 2},
                    {"pull_most_n", "  to, N", 2},
                    {"volume_ratio_least", "volume over that at rest from", 3},
                    {"volume_ratio_most", "  to", 3},
                    {"thickness_rest_mm", "thickness at rest, mm", 1},
                    {"thickness_least_mm", "  from, mm", 1},
                    {"thickness_most_mm", "  to, mm", 1}},
                   {}};
  for (const Variant& variant : variants) {
    const MuscleCycle& muscle = variant.quadriceps();
    const CycleRange line = range_of(muscle.length_m), pull = range_of(muscle.pull_n),
                     volume = range_of(muscle.volume_ratio), thick = range_of(muscle.thickness_m);
    table.row.push_back(
        {variant.label,
         {static_cast<double>(variant.walk.gait.step_length_m),
          static_cast<double>(variant.walk.gait.step_frequency_hz), millimetres * muscle.rest_length_m,
          millimetres * line.low, millimetres * line.high, line.high_percent,
          millimetres * range_of(muscle.elongation_m).high, pull.low, pull.high, volume.low, volume.high,
          millimetres * muscle.rest_thickness_m, millimetres * thick.low, millimetres * thick.high}});
  }
  return table;
}

PlotFigure quadriceps_figure(const std::vector<Variant>& variants) {
  PlotFigure figure{"The quadriceps of an athletic man of 1.80 m and 80 kg at 5 km/h",
                    "Force: the paper's visual one, k (L - L0). Thickness: diameter of a round bar of its volume and "
                    "length, as the mesh's widest section changes. Dashed: at rest.",
                    3, 240, 150};
  figure.panels = {cycle_panel("knee", "flexion (deg)"),       cycle_panel("line of action", "length (mm)"),
                   cycle_panel("belly", "elongation (mm)"),    cycle_panel("force", "pull on its end (N)"),
                   cycle_panel("volume", "over that at rest"), cycle_panel("thickness", "diameter (mm)")};
  for (std::size_t i = 0; i < variants.size(); ++i) {
    const MuscleCycle& muscle = variants[i].quadriceps();
    const auto add = [&](std::size_t panel, const CycleCurve& curve, double scale) {
      figure.panels[panel].lines.push_back(
          {cycle_percents(), cycle_values(curve, scale), series_colour[i], variants[i].label, 1.8, false});
    };
    add(0, variants[i].walk.knee_flexion_deg, 1);
    add(1, muscle.length_m, millimetres);
    add(2, muscle.elongation_m, millimetres);
    add(3, muscle.pull_n, 1);
    add(4, muscle.volume_ratio, 1);
    add(5, muscle.thickness_m, millimetres);
  }
  const MuscleCycle& any = variants[0].quadriceps();
  const auto at_rest = [&figure](std::size_t panel, double y) {
    figure.panels[panel].lines.push_back({{0, 100}, {y, y}, "#999", "", 1, true});
  };
  at_rest(1, millimetres * any.rest_length_m);
  at_rest(5, millimetres * any.rest_thickness_m);
  return figure;
}

std::vector<double> percents(const std::vector<double>& cycles) {
  std::vector<double> all;
  all.reserve(cycles.size());
  for (const double c : cycles) all.push_back(100 * c);
  return all;
}

/// Draws the right leg at each of the phases.
Image quadriceps_picture(const PaperCycle& walk) {
  std::vector<Image> strip;
  for (std::size_t frame = 0; frame < shown_at.size(); ++frame) {
    const Actor actor{&walk.shown, frame, {}, Actor::Bones::right_leg, Actor::Muscles::right, false};
    strip.push_back(take_picture({camera_at({-0.1F, 0.69F, 0.06F}, 0.86F, 25, 3), 300, 400}, {&actor, 1}));
  }
  return contact_sheet({&strip, 1}, 6);
}

}  // namespace

void paper_figure16(PaperRun& run) {
  std::vector<double> shown_at = evenly(sequence);
  shown_at.push_back(still_at);
  const auto walk = walk_cycle(hamstrings_alone(std::move(shown_at)));
  run.write_picture(
      "The legs from behind at 90 % of the cycle; from the side every eighth of it, beginning with the right heel "
      "strike.",
      [&] { return figure16(walk.shown); });
}

void paper_figure17(PaperRun& run) {
  CycleRequest request = hamstrings_alone({0.3});
  request.muscles->cells = paper_mesh;
  const auto walk = walk_cycle(request);
  run.write_picture(
      "The right thigh from behind in mid-stance: the mesh of 525 nodes, the surface that follows it, both.",
      [&] { return figure17(walk.shown); });
}

void paper_anatomy(PaperRun& run) {
  std::array<PaperCycle, 2> walks;  // real, built-in
  for (std::size_t i = 0; i < walks.size(); ++i) {
    run.progress(i == 0 ? "real meshes" : "built-in meshes", 0.4 * static_cast<double>(i));
    CycleRequest request{paper_body(), paper_gait(), LegMuscles{}, evenly(sequence), {}};
    if (i == 0) request.anatomy = run.anatomy;
    walks[i] = walk_cycle(request);
  }
  run.write_picture("Above real meshes, below built-in ones, every eighth of the cycle from the right heel strike on.",
                    [&] {
                      std::vector<std::vector<Image>> rows;
                      for (const PaperCycle& walk : walks) rows.push_back(row_of(walk.shown));
                      return contact_sheet(rows, 3);
                    });
}

void paper_quadriceps(PaperRun& run) {
  const auto variants = walk_variants(run);
  const PaperTable table = quadriceps_table(variants);
  const auto& v = table.row[0].value;
  run.text = turned_table_text(table) +
             fmt::format(
                 "\nIts line of action is longest at {:.0f} % of the cycle, {:.1f} mm beyond rest, and the belly\nup "
                 "to {:.1f} mm thinner "
                 "than at rest; forces are {:.1f} to {:.1f} N. With {} it stretches by up to {:.1f} mm, with\n{} by "
                 "{:.1f}.\n",
                 v[5], v[4] - v[2], v[11] - v[12], v[7], v[8], table.row[1].label, table.row[1].value[6],
                 table.row[2].label, table.row[2].value[6]);
  run.write_csv(table_csv(table));
  run.write(quadriceps_figure(variants));
  const std::string caption =
      fmt::format("The picture: natural steps, {:.0f} % of the cycle.", fmt::join(percents(shown_at), ", "));
  run.write_picture(caption, [&] { return quadriceps_picture(variants[0].walk); });
}

}  // namespace mobil
