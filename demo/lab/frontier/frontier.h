#pragma once
// Accuracy and cost of every method of deformation over the same walks: its error relative to a converged reference,
// and its time a tick. The parts of `mobil frontier`.

#include <functional>
#include <string>
#include <string_view>

#include "demo/lab/frontier/frontier_answers.h"
#include "demo/measure/machine.h"
#include "demo/pictures/svg_plot.h"

namespace mobil {

/// A measured method. `name` is for the csv's column. `mark` is its role in the paper, or empty.
struct FrontierLevel {
  std::string name;
  FrontierMethod method;
  std::string mark{};
};

/// Scope of a measurement. `reference`: cells of the reference's mesh. `bytes`: size of a method's crowd, so that
/// caches do not flatter, unless a tick of it would take longer than `call_s`.
struct FrontierRequest {
  std::vector<Muscle> muscles = {Muscle::hamstrings, Muscle::quadriceps, Muscle::triceps_surae,
                                 Muscle::tibialis_anterior};
  std::vector<FrontierWalk> walks = frontier_walks();
  double seconds = 1.5;
  std::vector<bool> scenes = {false, true};  // with the frame's loads
  std::vector<FrontierLevel> levels;         // ratios are relative to the first
  Cells reference = {8, 8, 32};
  std::size_t bytes = std::size_t{48} << 20;
  double call_s = 0.02;
  int rounds = 5;
  int threads = 0;  // for answers; costs are of one thread
  std::function<void(std::string_view what, double part)> progress = [](std::string_view, double) {};
};

/// Return a measurement of at most a minute on two cores, and the full one.
FrontierRequest short_frontier();
FrontierRequest long_frontier();

/// One method under one scene's loads. Costs are µs of one muscle in a tick of 1/60 s. `points_us` includes placing
/// control points, which finite elements always have.
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

/// Uncertainty of the reference, relative like errors: change with half its cells; change with 24 modes instead of 32.
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
  std::vector<std::string> notes;      // omissions, with reasons
};

/// Measures the frontier. Fails on walks or bodies out of range or a reference that cannot be made. Leaves out a level
/// that cannot step an individual, with a note.
Frontier measure_frontier(const FrontierRequest& request);

/// Marks the rows of each scene for which no other is both nearer and cheaper (at least as near and as cheap, and one
/// of them more), by cost_us and by points_us.
void mark_frontier(std::vector<FrontierRow>& rows);

/// Returns the cheapest row of a scene, with or without control points, within `error`; null without one.
const FrontierRow* cheapest_within(std::span<const FrontierRow> rows, bool loads, bool points, double error);

std::string frontier_csv(const Frontier& frontier);
PlotFigure frontier_figure(const Frontier& frontier);
/// Returns the frontier as a table, with conclusions.
std::string frontier_text(const Frontier& frontier);

/// A muscle's reference under a scene's loads, and its uncertainty.
struct FrontierReference {
  FrontierAnswer truth;
  FrontierError mesh, modes;
};
FrontierReference make_reference(const FrontierDrive& drive, const Cells& cells, bool loads);

/// Sets cost_us, points_us, memory_bytes, dt_s and the ratios of the rows of one scene. `individuals`: the sixteen of
/// each drive, for each row's level.
struct FrontierPriced {
  const FrontierLevel* level;
  std::span<const std::vector<FrontierIndividual>> individuals;
  FrontierRow* row;
};
void price(std::span<const FrontierPriced> all, std::span<const FrontierDrive> drives, bool loads, Frontier& frontier);

}  // namespace mobil
