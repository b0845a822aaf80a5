#include "demo/lab/frontier/frontier_active.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include <mobil/anthropometry.h>
#include <mobil/assets/muscles/muscle_plan.h>
#include <mobil/components/leg_muscles.h>
#include <mobil/muscle_table.h>
#include "assets/finite/control_points.h"
#include "assets/finite/shape_tables.h"
#include "demo/lab/effects/accuracy_active.h"
#include "demo/measure/measure.h"
#include "demo/program/must.h"
#include "systems/bellies/belly_library.h"
#include "systems/deformation/deformation.h"
#include "systems/deformation/finite.h"
#include "systems/deformation/finite_shape.h"
#include "systems/deformation/modal.h"

namespace mobil {
namespace {

inline constexpr double active_tick_s = 1.0 / 60;

inline constexpr Cells active_points = {2, 2, 8};

struct ActiveWay {
  std::string name;
  LegMuscles choice;
};

/// Control points at the end of each tick: three displacements a point, m.
using ActivePoints = std::vector<std::vector<double>>;

using Words = std::vector<Lanes<float>>;

Words alike_words(const std::vector<float>& row) {
  Words words(row.size());
  for (std::size_t w = 0; w < row.size(); ++w) std::ranges::fill(words[w].lane, row[w]);
  return words;
}

void set_lanes(Lanes<float>& lanes, double x) {
  std::ranges::fill(lanes.lane, static_cast<float>(x));
}

Belly active_belly(Muscle muscle, const ActiveWay& way, BellyLibrary& library) {
  auto plan = must(make_muscle_plan(*make_body({}), muscle));
  plan.scale = {1, 1};
  return must(library.belly(plan, way.choice, active_tick_s));
}

/// Sixteen identical bellies.
class ActiveBellies {
 public:
  ActiveBellies(const Belly& belly, const LegMuscles& choice)
      : belly_(belly),
        choice_(choice),
        length_m_(belly.shape->shape->mesh.node.back().z - belly.shape->shape->mesh.node.front().z),
        points_(nodal_width(choice.cells)),
        shown_(points_.size()) {
    set_lanes(scale_.across, 1), set_lanes(scale_.along, 1);
    if (choice.method == Method::modal) {
      motion_ = alike_words(belly.motion);
      shape_ = alike_words(belly.rest_shape);
      state_.resize(modal_state_width(belly.basis->modes));
    } else {
      velocity_.resize(points_.size());
      scratch_.resize(scratch_floats(*belly.shape->shape, choice.method) / lane_count + 1);
    }
  }

  void tick(const WalkLoad& to) {
    constexpr auto tick_s = static_cast<float>(active_tick_s);
    end_.from = end_.to;
    set_lanes(end_.to, -to.shortening * length_m_);
    frame_.constant_from = frame_.constant_to;
    set_lanes(frame_.constant_to.x, to.push.constant_m_s2[0]);
    set_lanes(frame_.constant_to.y, to.push.constant_m_s2[1]);
    set_lanes(frame_.constant_to.z, to.push.constant_m_s2[2]);
    set_lanes(activation_, to.activation);
    const FarFaceDrive drive(FarEnd::held, end_);
    if (choice_.method == Method::modal) {
      const ModalBlock block{*belly_.basis, scale_, state_[0].lane, motion_[0].lane, &frame_};
      const ControlPoints points{shape_[0].lane, points_[0].lane};
      if (!choice_.modal.moving) {
        place_static(block, points, drive);
      } else {
        if (choice_.modal.tuned) {
          deform_tuned(block, drive, activation_, tick_s);
        } else {
          deform_modal(block, drive, tick_s);
        }
        place_control_points(block, points, drive);
      }
    } else {
      BellyReport<Lanes<float>> unused;
      const BellyBlock block{*belly_.shape->shape,
                             scale_,
                             points_[0].lane,
                             velocity_[0].lane,
                             unused,
                             Stiffness::individual,
                             &frame_,
                             false};
      if (choice_.method == Method::finite) {
        deform_finite(block, drive, &activation_, belly_.steps, tick_s, scratch_[0].lane);
      } else {
        deform_explicit(block, drive, belly_.steps, tick_s, scratch_[0].lane);
      }
    }
    if (!has_finite_shape(choice_)) return;
    const ShapeBlock block{*belly_.finite, scale_, end_.to, &activation_};
    add_shape(block, blend_of(block), true, points_[0].lane, shown_[0].lane);
  }

  std::vector<double> shown() const {
    std::vector<double> points;
    for (const auto& u : has_finite_shape(choice_) ? shown_ : points_) points.push_back(double{u[0]});
    return choice_.cells == active_points ? points : sampled_points(choice_.cells, active_points, points);
  }

 private:
  const Belly& belly_;
  const LegMuscles& choice_;
  double length_m_;
  BellyScale<Lanes<float>> scale_{};
  EndDrive<Lanes<float>> end_{};
  FrameLoad<Lanes<float>> frame_{};
  Lanes<float> activation_{};
  Words points_, shown_, velocity_, scratch_, state_, motion_, shape_;
};

/// Returns statics, the paper's explicit mesh and modal bellies, with and without finite shape and tension.
std::vector<ActiveWay> active_ways() {
  LegMuscles choice;
  choice.inertia = true;
  choice.activation = ExcitationSource::host;
  choice.finite_shape = false;
  choice.method = Method::modal;
  choice.modal.moving = false;
  std::vector<ActiveWay> ways = {{"static", choice}};
  const auto shaped = [&] {
    ways.push_back(ways.back());
    ways.back().name += ", finite shape";
    ways.back().choice.finite_shape = true;
  };
  shaped();
  choice.method = Method::explicit_central;
  ways.push_back({"explicit-central, 81 nodes", choice});
  shaped();
  choice.method = Method::modal;
  choice.modal.moving = true;
  ways.push_back({"modal-12", choice});
  shaped();
  for (const std::uint32_t modes : {4U, 12U, 32U}) {
    choice.modal.modes = modes;
    choice.modal.tuned = true;
    ways.push_back({"modal-" + std::to_string(modes) + ", tuned", choice});
    ways.back().choice.finite_shape = true;
    ways.back().name += ", finite shape";
  }
  choice.method = Method::finite;
  ways.push_back({"finite, 81 nodes", choice});
  choice.cells = close_up_cells;
  ways.push_back({"finite, 425 nodes", choice});
  return ways;
}

/// Returns the points of a belly of the muscle's template size under `loads`, the first of which is at the end of the
/// first tick. It starts at rest, unloaded. Fails as the library does.
ActivePoints active_points_of(Muscle muscle, const ActiveWay& way, std::span<const WalkLoad> loads,
                              BellyLibrary& library) {
  const auto belly = active_belly(muscle, way, library);
  ActiveBellies bellies(belly, way.choice);
  ActivePoints points;
  for (const WalkLoad& load : loads) {
    bellies.tick(load);
    points.push_back(bellies.shown());
  }
  return points;
}

/// Returns the time of a muscle's tick with its control points, µs, among a thousand identical ones.
double active_cost_us(Muscle muscle, const ActiveWay& way, BellyLibrary& library) {
  constexpr std::size_t blocks = 64;
  const auto belly = active_belly(muscle, way, library);
  std::vector<ActiveBellies> all(blocks, ActiveBellies(belly, way.choice));
  double sway = 0.02;
  const Measured ticking = measure_short([&] {
    sway = -sway;
    for (ActiveBellies& one : all) one.tick({sway, 0.3, {{0, 9.8 * sway, 0}, {}}});
  });
  return 1e6 * ticking.best_s / (blocks * lane_count);
}

constexpr int active_ticks = 84, compared_every = 6, steps_a_tick = 8, first_jolt = 33, jolt_apart = 30;
constexpr Cells solved_cells = {4, 4, 16};

/// Returns the load of a tick: shortened by up to 11 % and stretched by 5 while fibres are active for half of the time.
/// With `shaken` also twice 34 m/s² for a twentieth of a second, fully active and relaxed.
WalkLoad load_at(int tick, bool shaken) {
  const double time_s = tick * active_tick_s, turn = 2 * std::numbers::pi * 0.9 * time_s;
  WalkLoad load;
  const double sway = 0.1 * std::sin(turn) + 0.03 * (std::sin(2 * turn + 1) - std::sin(1.0));
  load.shortening = -0.7 * std::min(1.0, time_s / 0.3) * sway;
  const double wave = std::sin(turn - 0.5);
  load.activation = 0.02 + (wave > 0 ? 0.6 * wave * wave : 0);
  const int since = tick - first_jolt;
  if (shaken && since >= 0 && (since % jolt_apart == 1 || since % jolt_apart == 2))
    load.push.constant_m_s2 = {25, 10, 20};
  return load;
}

std::vector<WalkLoad> loads_of(bool shaken) {
  std::vector<WalkLoad> loads;
  for (int tick = 1; tick <= active_ticks; ++tick) loads.push_back(load_at(tick, shaken));
  return loads;
}

ActivePoints nonlinear_motion(Muscle muscle, double foundation_hz, bool shaken) {
  const auto belly = must(make_finite_belly(finite_mesh(muscle, solved_cells), {}, 0));
  FiniteScratch scratch = make_scratch(belly);
  FiniteMotion motion = motion_at_rest(belly);
  ActivePoints moved;
  for (int tick = 1; tick <= active_ticks; ++tick) {
    const WalkLoad from = load_at(tick - 1, shaken), to = load_at(tick, shaken);
    follow_tick(belly, active_tick_s, foundation_hz, from, to, steps_a_tick, scratch, motion);
    moved.push_back(sampled_points(solved_cells, active_points, motion.displacement_m));
  }
  return moved;
}

/// Effect of jolts in each tick, and the whole displacement in the compared ticks.
struct Truth {
  ActivePoints jolts, whole;  // empty in ticks that are not compared
};

Truth truth_of(Muscle muscle, double foundation_hz) {
  const auto still = nonlinear_motion(muscle, foundation_hz, false);
  auto shaken = nonlinear_motion(muscle, foundation_hz, true);
  Truth truth{std::move(shaken), ActivePoints(active_ticks)};
  const SampledBelly belly = sampled_belly(muscle);
  for (std::size_t t = 0; t < truth.jolts.size(); ++t) {
    for (std::size_t i = 0; i < truth.jolts[t].size(); ++i) truth.jolts[t][i] -= still[t][i];
    if ((t + 1) % compared_every != 0) continue;
    const WalkLoad load = load_at(static_cast<int>(t) + 1, true);
    const auto shape = must(shape_samples(belly, 1, std::array{load.shortening}, std::array{load.activation}));
    truth.whole[t] = shape.front().displacement_m;
    for (std::size_t i = 0; i < truth.whole[t].size(); ++i) truth.whole[t][i] += truth.jolts[t][i];
  }
  return truth;
}

/// Sums of squares, and the largest value.
struct Squares {
  double all = 0, across = 0, worst = 0;

  void add(std::size_t component, double x) {
    all += x * x;
    if (component % 3 < 2) across += x * x;
    worst = std::max(worst, std::abs(x));
  }
};

ActiveFrontier measure_one(Muscle muscle, const std::vector<ActiveWay>& ways) {
  BellyLibrary library;
  const auto truth = truth_of(muscle, foundation_of(ways.front().choice, muscle));
  const HexahedralMesh mesh = finite_mesh(muscle, active_points);
  ActiveFrontier found{std::string(muscle_name(muscle)), 0, 0, {}};
  for (const ActiveWay& way : ways) {
    const auto still = active_points_of(muscle, way, loads_of(false), library);
    const auto shaken = active_points_of(muscle, way, loads_of(true), library);
    ActiveError error{way.name};
    Squares of, off, jolts, jolts_off;
    std::size_t compared = 0;
    for (std::size_t t = 0; t < shaken.size(); ++t) {
      const auto &now = shaken[t], &real = truth.whole[t];
      for (std::size_t i = 0; i < now.size(); ++i) {
        jolts.add(i, truth.jolts[t][i]);
        jolts_off.add(i, now[i] - still[t][i] - truth.jolts[t][i]);
        if (real.empty()) continue;
        of.add(i, real[i]);
        off.add(i, now[i] - real[i]);
      }
      if (real.empty()) continue;
      ++compared;
      error.volume = std::max(error.volume, std::abs(enclosed_volume(mesh, now) - 1));
    }
    error.all = std::sqrt(off.all / of.all);
    error.across = std::sqrt(off.across / of.across);
    error.worst_m = off.worst;
    error.jolts_all = std::sqrt(jolts_off.all / jolts.all);
    error.jolts_across = std::sqrt(jolts_off.across / jolts.across);
    found.ways.push_back(error);
    found.jolts_m = std::sqrt(jolts.all / static_cast<double>(active_ticks * node_count(active_points)));
    found.bulge_m = std::sqrt(of.across / static_cast<double>(compared * node_count(active_points)));
  }
  return found;
}

/// Returns roots of the mean squares, and the worst, over all muscles.
ActiveFrontier together(const std::vector<ActiveFrontier>& muscles) {
  const auto count = static_cast<double>(muscles.size());
  const auto mean = [&](auto&& number) {
    double sum = 0;
    for (const ActiveFrontier& one : muscles) sum += number(one) * number(one) / count;
    return std::sqrt(sum);
  };
  ActiveFrontier all{"all",
                     mean([](const ActiveFrontier& one) { return one.jolts_m; }),
                     mean([](const ActiveFrontier& one) { return one.bulge_m; }),
                     {}};
  for (std::size_t w = 0; w < muscles.front().ways.size(); ++w) {
    const auto of = [&](double ActiveError::*number) {
      return mean([&](const ActiveFrontier& one) { return one.ways[w].*number; });
    };
    ActiveError sum{muscles.front().ways[w].way, of(&ActiveError::all),         of(&ActiveError::across), 0, 0,
                    of(&ActiveError::jolts_all), of(&ActiveError::jolts_across)};
    for (const ActiveFrontier& one : muscles) {
      sum.worst_m = std::max(sum.worst_m, one.ways[w].worst_m);
      sum.volume = std::max(sum.volume, one.ways[w].volume);
    }
    all.ways.push_back(sum);
  }
  return all;
}

}  // namespace

std::vector<ActiveFrontier> measure_active(std::span<const Muscle> rows,
                                           void (*progress)(std::string_view what, double part)) {
  const std::vector<ActiveWay> ways = active_ways();
  std::vector<ActiveFrontier> all;
  for (const Muscle muscle : rows) {
    const std::string name(muscle_name(muscle));
    progress("shaken " + name, static_cast<double>(all.size()) / static_cast<double>(rows.size()));
    all.push_back(measure_one(muscle, ways));
  }
  all.push_back(together(all));
  BellyLibrary library;
  for (std::size_t w = 0; w < ways.size(); ++w) {
    all.back().ways[w].cost_us = active_cost_us(rows.front(), ways[w], library);
  }
  return all;
}

std::string active_text(const std::vector<ActiveFrontier>& muscles) {
  const ActiveFrontier& all = muscles.back();
  std::string text = fmt::format(
      "Pulling and shaken: 81 control points against nonlinear statics and what two jolts of 34 m/s^2 add to "
      "nonlinear\n"
      "dynamics; shortened by -5 to 11 %, activation 0.02 to 0.62; {} muscles, {:.2f} mm across, jolts add {:.2f} mm.\n"
      "Off, of the reference's own: rms of all, and across; at worst; volume off; and of what jolts add\n\n"
      "{:<32}{:>8}{:>8}{:>9}{:>10}{:>9}{:>11}{:>9}\n",
      muscles.size() - 1, 1e3 * all.bulge_m, 1e3 * all.jolts_m, "way", "us", "all", "across", "worst mm", "volume",
      "jolts all", "across");
  for (const ActiveError& way : all.ways) {
    fmt::format_to(std::back_inserter(text),
                   "{:<32}{:>8.3f}{:>6.0f} %{:>7.0f} %{:>10.1f}{:>7.1f} %{:>9.0f} %{:>7.0f} %\n", way.way, way.cost_us,
                   100 * way.all, 100 * way.across, 1e3 * way.worst_m, 100 * way.volume, 100 * way.jolts_all,
                   100 * way.jolts_across);
  }
  return text;
}

std::string active_csv(const std::vector<ActiveFrontier>& muscles) {
  std::string text = "muscle,way,cost_us,all_off,across_off,worst_m,volume_off,jolts_all_off,jolts_across_off\n";
  for (const ActiveFrontier& one : muscles) {
    for (const ActiveError& way : one.ways) {
      fmt::format_to(std::back_inserter(text), "{},\"{}\",{},{:.5f},{:.5f},{:.6f},{:.6f},{:.5f},{:.5f}\n", one.muscle,
                     way.way, way.cost_us > 0 ? fmt::format("{:.4f}", way.cost_us) : "", way.all, way.across,
                     way.worst_m, way.volume, way.jolts_all, way.jolts_across);
    }
  }
  return text;
}

PlotFigure active_figure(const std::vector<ActiveFrontier>& muscles) {
  PlotFigure figure{"What accuracy costs where muscles pull",
                    "Against tissue at finite strain, shaken by two jolts; one core.",
                    1,
                    640,
                    400,
                    true};
  PlotPanel panel;
  panel.title = "displacement across, all muscles";
  double least = 1e9, most = 0;
  PlotPoints linear{{}, {}, {}, "#1f77b4", "linear"}, shaped{{}, {}, {}, "#2ca02c", "finite strain"};
  for (const ActiveError& way : muscles.back().ways) {
    const bool finite = way.way.find("finite") != std::string::npos;  // in shape or method
    PlotPoints& points = finite ? shaped : linear;
    points.x.push_back(way.cost_us);
    points.y.push_back(100 * way.across);
    points.text.push_back(way.way.substr(0, way.way.rfind(", finite")));
    least = std::min(least, way.cost_us);
    most = std::max(most, way.cost_us);
  }
  panel.x = {"µs a muscle and tick of 1/60 s, control points placed", least / 1.6, 2.5 * most, true};
  panel.y = {"error, % of the displacement across (rms)", {}, {}, true};
  panel.points = {linear, shaped};
  figure.panels.push_back(std::move(panel));
  return figure;
}

}  // namespace mobil
