#include "demo/frontier/frontier_shaken.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <span>
#include <utility>

#include "assets/finite/control_points.h"
#include "assets/finite/finite_motion.h"
#include "assets/finite/shape_tables.h"
#include "assets/muscles/muscle_plan.h"
#include "assets/muscles/muscle_table.h"
#include "assets/reduction/reduced_rows.h"
#include "systems/deformation/reduced.h"
#include "systems/muscles/belly_library.h"

namespace mobil {
namespace {

constexpr double shaken_tick_s = 1.0 / 60;
constexpr int shaken_ticks = 84, steps_a_tick = 8, first_jolt = 33, jolt_apart = 30;
constexpr Cells solved_cells = {4, 4, 16}, shown_cells = {2, 2, 8};

/// At a tick's end; between ticks shortening and jolt go straight, activation stays.
struct Shaking {
  double shortening = 0, activation = 0;
  std::array<double, 3> acceleration_m_s2{};
};

/// Shortened by up to 11 % and stretched by 5 while fibres pull for half of the time; and, where it is shaken, twice
/// 35 m/s² for a twentieth of a second: in full pull and relaxed.
Shaking shaking_at(int tick, bool shaken) {
  const double turn = 2 * std::numbers::pi * 0.9 * tick * shaken_tick_s,
               rise = std::min(1.0, tick * shaken_tick_s / 0.3);
  Shaking shaking;
  shaking.shortening = -0.7 * rise * (0.1 * std::sin(turn) + 0.03 * (std::sin(2 * turn + 1) - std::sin(1.0)));
  const double wave = std::sin(turn - 0.5);
  shaking.activation = 0.02 + (wave > 0 ? 0.6 * wave * wave : 0);
  const int since = tick - first_jolt;
  if (shaken && since >= 0 && (since % jolt_apart == 1 || since % jolt_apart == 2))
    shaking.acceleration_m_s2 = {25, 10, 20};
  return shaking;
}

using Moved = std::vector<std::vector<double>>;  // of each tick three displacements a control point, m

/// A tick, or a part of it, in steps that are halved where they fail.
Result<void> follow(const FiniteBelly& belly, double foundation_hz, const Shaking& from, const Shaking& to,
                    double begin, double part, FiniteScratch& scratch, FiniteMotion& motion) {
  constexpr double least_part = 1.0 / (steps_a_tick * 32);
  const auto at_end = [&](double a, double b) { return a + (begin + part) * (b - a); };
  FiniteStep step{part * shaken_tick_s, tuned_damping_per_s(to.activation), foundation_hz,
                  at_end(from.shortening, to.shortening), to.activation};
  for (std::size_t d = 0; d < 3; ++d)
    step.acceleration_m_s2[d] = at_end(from.acceleration_m_s2[d], to.acceleration_m_s2[d]);
  auto done = advance(belly, scratch, step, motion);
  if (done || part < 1.5 * least_part) return done;
  for (const double start : {begin, begin + part / 2}) {
    if (done = follow(belly, foundation_hz, from, to, start, part / 2, scratch, motion); !done) return done;
  }
  return {};
}

Result<Moved> reference(Muscle muscle, double foundation_hz, bool shaken) {
  const auto belly = make_finite_belly(finite_mesh(muscle, solved_cells), {}, 0);
  if (!belly) return tl::unexpected(belly.error());
  FiniteScratch scratch = make_scratch(*belly);
  FiniteMotion motion = motion_at_rest(*belly);
  Moved moved;
  for (int tick = 1; tick <= shaken_ticks; ++tick) {
    const Shaking from = shaking_at(tick - 1, shaken), to = shaking_at(tick, shaken);
    for (int s = 0; s < steps_a_tick; ++s) {
      constexpr double part = 1.0 / steps_a_tick;
      if (auto done = follow(*belly, foundation_hz, from, to, s * part, part, scratch, motion); !done)
        return tl::unexpected(done.error());
    }
    moved.push_back(sampled_points(solved_cells, shown_cells, motion.displacement_m));
  }
  return moved;
}

/// The kernels, in one lane.
Result<Moved> reduced(const ReducedBasis& basis, double length_m, bool tuned, bool shaken) {
  ReducedBellies bellies;
  bellies.tuned = tuned;
  const BellyScale<double> own{1, 1};
  if (auto solved = solve_bellies(basis, std::span(&own, 1), bellies); !solved) return tl::unexpected(solved.error());
  std::vector<Lanes<float>> motion(reduced_motion_width(basis.vectors, basis.inputs)),
      shape(reduced_shape_width(basis.vectors, basis.inputs)), state(reduced_state_width(basis.vectors)),
      points(3 * basis.control_weight.size());
  write_motions(bellies, basis.options.damping_per_s, shaken_tick_s, motion[0].lane);
  write_shapes(bellies, basis.options.damping_per_s, shape[0].lane);
  BellyScale<Lanes<float>> scale{};
  scale.across[0] = scale.along[0] = 1;
  EndDrive<Lanes<float>> end{};
  FrameLoad<Lanes<float>> frame{};
  Lanes<float> activation{};
  Moved moved;
  for (int tick = 1; tick <= shaken_ticks; ++tick) {
    const Shaking to = shaking_at(tick, shaken);
    end.from = end.to;
    end.to[0] = static_cast<float>(-to.shortening * length_m);
    frame.constant_from = frame.constant_to;
    frame.constant_to.x[0] = static_cast<float>(to.acceleration_m_s2[0]);
    frame.constant_to.y[0] = static_cast<float>(to.acceleration_m_s2[1]);
    frame.constant_to.z[0] = static_cast<float>(to.acceleration_m_s2[2]);
    activation[0] = static_cast<float>(to.activation);
    const ReducedBlock block{basis, scale, state[0].lane, motion[0].lane, &frame};
    if (tuned) {
      deform_tuned(block, {FarEnd::held, end}, activation, static_cast<float>(shaken_tick_s));
    } else {
      deform_reduced(block, {FarEnd::held, end}, static_cast<float>(shaken_tick_s));
    }
    place_control_points(block, {shape[0].lane, points[0].lane}, {FarEnd::held, end});
    auto& now = moved.emplace_back();
    for (const auto& u : points) now.push_back(double{u[0]});
  }
  return moved;
}

/// Sum of squares and the largest, of all and of what is across.
struct Squares {
  double all = 0, across = 0, worst = 0;

  void add(std::size_t component, double x) {
    all += x * x;
    if (component % 3 < 2) across += x * x;
    worst = std::max(worst, std::abs(x));
  }
};

Result<ShakenFrontier> measure_one(Muscle muscle) {
  LegMuscles choice;
  choice.inertia = true;
  const double hz = foundation_of(choice, muscle);
  const HexahedralMesh mesh = finite_mesh(muscle, solved_cells);
  ReducedOptions options;
  options.foundation_hz = hz;
  options.frame_loads = true;
  options.control_cells = shown_cells;
  const auto basis = make_reduced_basis(mesh, Material{}, Element::full, options);
  if (!basis) return tl::unexpected(basis.error());
  const double length_m = mesh.node.back().z - mesh.node.front().z;

  std::array<Result<Moved>, 2> truth = {reference(muscle, hz, false), reference(muscle, hz, true)};
  for (const auto& moved : truth) {
    if (!moved) return tl::unexpected(moved.error());
  }
  ShakenFrontier found{std::string(muscle_name(muscle)), 0, 0, {}};
  for (const bool tuned : {false, true}) {
    const auto still = reduced(*basis, length_m, tuned, false), shaken = reduced(*basis, length_m, tuned, true);
    if (!still) return tl::unexpected(still.error());
    if (!shaken) return tl::unexpected(shaken.error());
    Squares of, off;
    for (std::size_t t = 0; t < still->size(); ++t) {
      for (std::size_t i = 0; i < (*still)[t].size(); ++i) {
        const double real = (*truth[1])[t][i] - (*truth[0])[t][i], ours = (*shaken)[t][i] - (*still)[t][i];
        of.add(i, real);
        off.add(i, ours - real);
      }
    }
    const auto count = static_cast<double>(shaken_ticks * node_count(shown_cells));
    found.all_m = std::sqrt(of.all / count);
    found.across_m = std::sqrt(of.across / count);
    found.ways.push_back({tuned ? "reduced-12, tuned" : "reduced-12", std::sqrt(off.all / of.all),
                          std::sqrt(off.across / of.across), off.worst});
  }
  return found;
}

}  // namespace

Result<std::vector<ShakenFrontier>> measure_shaken(std::span<const Muscle> rows,
                                                   void (*progress)(std::string_view what, double part)) {
  std::vector<ShakenFrontier> all;
  for (const Muscle muscle : rows) {
    const std::string name(muscle_name(muscle));
    progress("shaken " + name, static_cast<double>(all.size()) / static_cast<double>(rows.size()));
    auto one = measure_one(muscle);
    if (!one) return tl::unexpected(Error{fmt::format("{}: {}", name, one.error().message)});
    all.push_back(std::move(*one));
  }
  const auto count = static_cast<double>(all.size());
  ShakenFrontier together{"all", 0, 0, {}};
  for (std::size_t w = 0; w < all.front().ways.size(); ++w) {
    ShakenError sum{all.front().ways[w].way};
    for (const ShakenFrontier& one : all) {
      sum.all += one.ways[w].all * one.ways[w].all / count;
      sum.across += one.ways[w].across * one.ways[w].across / count;
      sum.worst_m = std::max(sum.worst_m, one.ways[w].worst_m);
    }
    together.ways.push_back({sum.way, std::sqrt(sum.all), std::sqrt(sum.across), sum.worst_m});
  }
  for (const ShakenFrontier& one : all) {
    together.all_m += one.all_m / count;
    together.across_m += one.across_m / count;
  }
  all.push_back(together);
  return all;
}

std::string shaken_text(const std::vector<ShakenFrontier>& muscles) {
  std::string text = fmt::format(
      "What two jolts of 34 m/s^2 add to where 81 control points are, against nonlinear dynamics on 4x4x16 "
      "elements;\n"
      "shortened by -5 to 11 %, activation 0.02 to 0.62. Off, of what they add: rms of all, and of what is across\n\n"
      "{:<27}{:>8}{:>10}  {:<22}{:>7}{:>8}{:>9}\n",
      "muscle", "adds mm", "across mm", "moved by", "all", "across", "worst mm");
  for (const ShakenFrontier& one : muscles) {
    for (const ShakenError& way : one.ways) {
      const bool first = &way == &one.ways.front();
      fmt::format_to(std::back_inserter(text), "{:<27}{:>8}{:>10}  {:<22}{:>5.0f} %{:>6.0f} %{:>9.2f}\n",
                     first ? one.muscle : "", first ? fmt::format("{:.2f}", 1e3 * one.all_m) : "",
                     first ? fmt::format("{:.2f}", 1e3 * one.across_m) : "", way.way, 100 * way.all, 100 * way.across,
                     1e3 * way.worst_m);
    }
  }
  return text;
}

std::string shaken_csv(const std::vector<ShakenFrontier>& muscles) {
  std::string text = "muscle,adds_m,across_m,way,all_off,across_off,worst_m\n";
  for (const ShakenFrontier& one : muscles) {
    for (const ShakenError& way : one.ways) {
      fmt::format_to(std::back_inserter(text), "{},{:.6f},{:.6f},\"{}\",{:.5f},{:.5f},{:.6f}\n", one.muscle, one.all_m,
                     one.across_m, way.way, way.all, way.across, way.worst_m);
    }
  }
  return text;
}

}  // namespace mobil
