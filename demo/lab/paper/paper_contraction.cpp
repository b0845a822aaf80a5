// The paper's future work: muscles that contract. Excitation, fibre and tendon over a stride; and legs relaxed and at
// full activation, with short and thick bellies.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include <mobil/components/activation.h>
#include <mobil/each.h>
#include <mobil/systems/muscles/person.h>
#include "assets/body/bent_legs.h"
#include "demo/lab/compare/compare_walk.h"
#include "demo/lab/paper/paper.h"
#include "demo/pictures/contact_sheet.h"
#include "demo/pictures/cycle_plot.h"
#include "demo/walk/figure.h"

namespace mobil {
namespace {

constexpr double contraction_tick_s = 1.0 / 240;

LegMuscles pulling(ExcitationSource source, Method method) {
  LegMuscles choice;
  choice.muscles = muscle_members();
  choice.method = method;
  choice.activation = source;
  return choice;
}

/// Returns a man standing on his toes or straight, with all leg muscles excited at that level for a second.
ShownWalk standing(const LegBend& bend, float level) {
  Simulation simulation;
  const auto entity = must(simulation.spawn_posed(paper_body()));
  const Body body = simulation.person(entity)->body;
  must(simulation.set_pose(entity, with_bent_legs(body, bend)));
  simulation.tick();
  LegMuscles choice = pulling(ExcitationSource::host, Method::modal);
  choice.modal.moving = false;
  must(simulation.set_muscles(entity, choice));
  for (const MuscleRef& own : simulation.muscles(entity)) {
    for (const Side side : {Side::right, Side::left}) must(simulation.set_excitation(entity, own.muscle, side, level));
  }
  for (int tick = 0; tick < 60; ++tick) simulation.tick();
  const Person person = *simulation.person(entity);
  const auto figure = must(make_figure(person));
  ShownWalk shown{begin_recording(figure, 1), {}};
  record_frame(figure, simulation, person, shown.recording);
  return shown;
}

Image leg(const ShownWalk& shown, const Camera& camera) {
  const Actor actor{&shown, 0, {}, Actor::Bones::right_leg, Actor::Muscles::right};
  return take_picture({camera, 260, 440, false}, {&actor, 1});
}

/// Draws calf from behind and thigh from the front, each relaxed and contracted; and push-off, linear and contracting.
Image legs(const CycleRequest& push_off) {
  struct View {
    LegBend bend;
    Camera camera;
  };
  const std::array views = {View{{0, 0, -25}, camera_at({-0.09F, 0.35F, 0}, 0.44F, -75, 4)},
                            View{{0, 0, 0}, camera_at({-0.10F, 0.70F, 0}, 0.54F, 60, 4)}};
  std::vector<Image> row;
  for (const View& view : views) {
    for (const float level : {0.0F, 1.0F}) {
      const auto shown = standing(view.bend, level);
      row.push_back(leg(shown, view.camera));
    }
  }
  for (const bool pulls : {false, true}) {
    CycleRequest request = push_off;
    if (!pulls) request.muscles->activation = ExcitationSource::none;
    const auto walk = walk_cycle(request);
    row.push_back(leg(walk.shown, camera_at({-0.09F, 0.42F, -0.24F}, 0.46F, -30, 4)));
  }
  return contact_sheet({&row, 1}, 4);
}

struct ShownMuscle {
  std::string_view name, label;
};
constexpr std::array shown_muscles = {
    ShownMuscle{"tibialis_anterior", "tibialis anterior"}, ShownMuscle{"soleus", "soleus"},
    ShownMuscle{"gastrocnemius_medial", "gastrocnemius medialis"}, ShownMuscle{"vastus_lateralis", "vastus lateralis"},
    ShownMuscle{"biceps_femoris_long_head", "biceps femoris"}};

/// Curves over the right leg's cycle.
struct MuscleCurves {
  CycleCurve activation{}, line_mm{}, fibre_mm{}, tendon_mm{}, force_n{};
};

std::vector<MuscleCurves> stride() {
  SimulationOptions options;
  options.tick_s = contraction_tick_s;
  Simulation simulation(options);
  const auto entity = must(simulation.spawn(paper_body(), paper_gait()));
  const LegMuscles choice = pulling(ExcitationSource::phase, Method::none);
  must(simulation.set_muscles(entity, choice));
  struct Rows {
    std::vector<double> activation, line, fibre, tendon, force;
  };
  std::vector<double> phases;
  std::array<Rows, shown_muscles.size()> rows;
  over_steady_cycle(simulation, entity, [&](double phase) {
    phases.push_back(phase);
    for (std::size_t m = 0; m < rows.size(); ++m) {
      const Entity muscle = simulation.muscle(entity, *find_muscle(shown_muscles[m].name), Side::right);
      const auto pull = *simulation.get<Musculotendon>(muscle);
      const auto line = *simulation.get<LineOfAction>(muscle);
      rows[m].activation.push_back(double{simulation.get<Activation>(muscle)->activation});
      rows[m].line.push_back(millimetres * double{line.length_m - line.rest_length_m});
      rows[m].fibre.push_back(millimetres * double{pull.fibre_m});
      rows[m].tendon.push_back(millimetres * double{pull.tendon_m});
      rows[m].force.push_back(double{pull.force_n});
    }
  });
  std::vector<MuscleCurves> curves;
  curves.reserve(rows.size());
  for (const Rows& own : rows) {
    curves.push_back({sample_cycle(phases, own.activation), sample_cycle(phases, own.line),
                      sample_cycle(phases, own.fibre), sample_cycle(phases, own.tendon),
                      sample_cycle(phases, own.force)});
  }
  return curves;
}

PlotFigure plot(const std::vector<MuscleCurves>& curves) {
  PlotFigure figure;
  figure.title = "Muscles that contract, over the right leg's cycle";
  figure.footnote =
      "Excitation: EMG of Bovi et al. 2011, scaled. Calf: gastrocnemius medialis, lengths beside those at heel strike.";
  figure.columns = 3;
  PlotPanel activation = cycle_panel("activation", "share of the most"),
            force = cycle_panel("force on the tendon", "N");
  const auto line = [](const CycleCurve& curve, std::string_view colour, std::string_view label, double from = 0) {
    return PlotLine{cycle_percents(), cycle_values(curve, 1, from), std::string(colour), std::string(label)};
  };
  for (std::size_t m = 0; m < curves.size(); ++m) {
    activation.lines.push_back(line(curves[m].activation, series_colour[m], shown_muscles[m].label));
    force.lines.push_back(line(curves[m].force_n, series_colour[m], shown_muscles[m].label));
  }
  PlotPanel lengths = cycle_panel("calf", "mm");
  lengths.own_legend = true;
  const MuscleCurves& calf = curves[2];
  for (const auto& [curve, colour, label] : {std::tuple{&calf.line_mm, ours_colour, "both"},
                                             {&calf.tendon_mm, first_colour, "tendon"},
                                             {&calf.fibre_mm, second_colour, "fibres"}})
    lengths.lines.push_back(line(*curve, colour, label, curve->front()));
  figure.panels = {activation, force, lengths};
  return figure;
}

}  // namespace

void paper_contraction(PaperRun& run) {
  run.progress("stride", 0.1);
  const auto curves = stride();
  std::string csv = "percent_gait";
  for (const ShownMuscle& muscle : shown_muscles)
    csv += fmt::format(",{0}_activation,{0}_fibre_mm,{0}_tendon_mm,{0}_force_n", muscle.name);
  csv += '\n';
  for (std::size_t i = 0; i < cycle_points; ++i) {
    csv += fmt::format("{:.6g}", 100.0 * static_cast<double>(i) / static_cast<double>(cycle_points - 1));
    for (const MuscleCurves& c : curves)
      csv += fmt::format(",{:.4f},{:.3f},{:.3f},{:.2f}", c.activation[i], c.fibre_mm[i], c.tendon_mm[i], c.force_n[i]);
    csv += '\n';
  }
  run.write_csv(csv);
  run.write(plot(curves));
  const auto at = [](const CycleCurve& curve, double part) {
    return curve[static_cast<std::size_t>(std::lround(part * static_cast<double>(cycle_points - 1)))];
  };
  const MuscleCurves& calf = curves[2];
  run.text += fmt::format(
      "From 10 to 42 % of the cycle gastrocnemius medialis and its tendon lengthen by {:.1f} mm: the tendon by {:.1f}, "
      "the fibres by {:.1f}.\n",
      at(calf.line_mm, 0.42) - at(calf.line_mm, 0.10), at(calf.tendon_mm, 0.42) - at(calf.tendon_mm, 0.10),
      at(calf.fibre_mm, 0.42) - at(calf.fibre_mm, 0.10));
  run.progress("legs", 0.3);
  const CycleRequest push_off{paper_body(), paper_gait(), pulling(ExcitationSource::phase, Method::modal), {0.45}, {}};
  run.write_picture(
      "The calf on tiptoe and the thigh, each relaxed and at full activation; push-off at 45 % of the cycle, linear "
      "and "
      "contracting.",
      [&] { return legs(push_off); });
}

}  // namespace mobil
