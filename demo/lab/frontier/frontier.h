#pragma once
// What accuracy costs: every way to deform a muscle over the same walks, how far it is from a converged reference and
// what a tick of it takes. The parts of `mobil frontier`.

#include <functional>
#include <string>
#include <string_view>

#include "demo/lab/frontier/frontier_answers.h"
#include "demo/measure/machine.h"
#include "demo/pictures/svg_plot.h"

namespace mobil {

/// A way that is measured. `name`: of the csv's column. `mark`: what it is of the paper's, empty for nothing.
struct FrontierLevel {
  std::string name;
  FrontierMethod method;
  std::string mark{};
};

/// What is measured. `reference`: cells of the mesh that the reference is made on.
/// `bytes`: of a method's crowd, so that caches do not flatter, unless a tick of it then took longer than `call_s`.
struct FrontierRequest {
  std::vector<Muscle> muscles = {Muscle::hamstrings, Muscle::quadriceps, Muscle::triceps_surae,
                                 Muscle::tibialis_anterior};
  std::vector<FrontierWalk> walks = frontier_walks();
  double seconds = 1.5;
  std::vector<bool> scenes = {false, true};  // with the frame's loads
  std::vector<FrontierLevel> levels;         // the first is what ratios are to
  Cells reference = {8, 8, 32};
  std::size_t bytes = std::size_t{48} << 20;
  double call_s = 0.02;
  int rounds = 5;
  int threads = 0;  // of the answers; costs are one thread's
  std::function<void(std::string_view what, double part)> progress = [](std::string_view, double) {};
};

/// A minute at most on two cores; and everything.
FrontierRequest short_frontier();
FrontierRequest long_frontier();

/// One way under one scene's loads. Costs are µs of one muscle in a tick of 1/60 s; `points_us` with control points
/// placed, which finite elements always have.
struct FrontierRow {
  std::string method, cells, mark;
  bool loads = false;
  std::uint32_t nodes = 0, modes = 0;
  double dt_s = 0;  // mean over individuals
  double error = 0, error_max_m = 0;
  std::vector<double> error_of_muscle;
  double cost_us = 0, points_us = 0;
  double ratio = 0, points_ratio = 0;  // the first level's cost under the same loads over this one's
  std::size_t memory_bytes = 0;        // of one individual, control points included
  bool on_frontier = false, points_on_frontier = false;
  bool uncertain = false;  // the reference's own change is more than a tenth of the error
};

/// How far the reference moves, relative as errors are: against the same on half its cells; with 24 modes instead of
/// 32.
struct FrontierChange {
  bool loads = false;
  double mesh = 0, modes = 0;

  double own() const { return mesh > modes ? mesh : modes; }
};

struct Frontier {
  FrontierRequest request;
  Machine machine;
  std::vector<FrontierRow> rows;
  std::vector<FrontierChange> change;  // a scene each
  double shared_us = 0;                // the first level's cost with the template's own size, line load alone
  std::size_t min_muscles = 0;         // of the crowds
  std::vector<std::string> notes;      // what was left out, and why
};

/// Fails on walks or bodies out of range or a reference that cannot be made. A level that somebody cannot be stepped by
/// is left out with a note.
Frontier measure_frontier(const FrontierRequest& request);

/// Marks the rows of each scene that no other is both nearer and cheaper than (at least as near and as cheap, and one
/// of them more), by cost_us and by points_us.
void mark_frontier(std::vector<FrontierRow>& rows);

/// The rows of a scene with control points or without that are within `error`, the cheapest; null for none.
const FrontierRow* cheapest_within(std::span<const FrontierRow> rows, bool loads, bool points, double error);

std::string frontier_csv(const Frontier& frontier);
PlotFigure frontier_figure(const Frontier& frontier);
/// The frontier as a table, and what it shows.
std::string frontier_text(const Frontier& frontier);

/// A muscle's reference under a scene's loads and its change.
struct FrontierReference {
  FrontierAnswer truth;
  FrontierError mesh, modes;
};
FrontierReference make_reference(const FrontierDrive& drive, const Cells& cells, bool loads);

/// Fills in cost_us, points_us, memory_bytes, dt_s and the ratios of the rows of one scene. `individuals`: of each
/// row's level, of each drive, its sixteen.
struct FrontierPriced {
  const FrontierLevel* level;
  std::span<const std::vector<FrontierIndividual>> individuals;
  FrontierRow* row;
};
void price(std::span<const FrontierPriced> all, std::span<const FrontierDrive> drives, bool loads, Frontier& frontier);

}  // namespace mobil
