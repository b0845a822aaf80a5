// `mobil frontier`'s results in words and numbers.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <mobil/muscle_table.h>
#include "demo/lab/frontier/frontier.h"

namespace mobil {
namespace {

constexpr double close_enough = 0.015;

std::string percent(double part) {
  return fmt::format("{:.3g} %", 100 * part);
}

std::string named(const FrontierRow& row) {
  std::string text = fmt::format("{} {}", row.method, row.cells);
  if (row.vectors > 0) text += fmt::format(", {} vectors", row.vectors);
  if (row.method != "static" && row.vectors == 0) text += fmt::format(", {:.3g} ms", 1e3 * row.dt_s);
  return text;
}

void add_shown(const Frontier& frontier, bool loads, bool points, std::string& text) {
  const FrontierRow* row = cheapest_within(frontier.rows, loads, points, close_enough);
  const char* what = points ? "with control points placed" : "its state alone, no control points";
  if (row == nullptr) {
    text += fmt::format("  within {} of the reference, {}: none\n", percent(close_enough), what);
    return;
  }
  text +=
      fmt::format("  within {} of the reference, {}: {}, error {}{}, {:.3g} us, 1/{:.3g} of the paper's cost\n",
                  percent(close_enough), what, named(*row), percent(row->error), row->uncertain ? " (uncertain)" : "",
                  points ? row->points_us : row->cost_us, points ? row->points_ratio : row->ratio);
}

void add_scene(const Frontier& frontier, const FrontierChange& change, std::string& text) {
  std::vector<const FrontierRow*> on;
  for (const FrontierRow& row : frontier.rows) {
    if (row.loads == change.loads && (row.on_frontier || row.points_on_frontier || !row.mark.empty()))
      on.push_back(&row);
  }
  if (on.empty()) return;
  std::ranges::sort(on, {}, &FrontierRow::cost_us);
  constexpr auto line = "  {:<36} {:>9} {:>9} {:>10} {:>10} {:>10} {:>8}  {}\n";
  text +=
      change.loads ? "\nWith the line of action, gravity and the frame's motion:\n" : "\nThe line of action alone:\n";
  text += fmt::format(line, "", "error", "at most", "us a tick", "ratio", "us+points", "ratio", "");
  for (const FrontierRow* row : on) {
    std::string also = row->on_frontier ? "frontier" : row->points_on_frontier ? "frontier with control points" : "";
    if (row->uncertain) also += also.empty() ? "uncertain" : ", uncertain";
    if (!row->mark.empty()) also += (also.empty() ? "" : "; ") + row->mark;
    text += fmt::format(line, named(*row), percent(row->error), fmt::format("{:.2g} mm", 1e3 * row->error_max_m),
                        fmt::format("{:.4g}", row->cost_us), fmt::format("{:.3g}", row->ratio),
                        fmt::format("{:.4g}", row->points_us), fmt::format("{:.3g}", row->points_ratio), also);
  }
  text += fmt::format(
      "  the reference's own change: {} from half the cells, {} from 24 vectors{}\n", percent(change.mesh),
      percent(change.vectors),
      change.elements ? fmt::format("; {} from plain explicit meshes extrapolated", percent(*change.elements)) : "");
  add_shown(frontier, change.loads, false, text);
  add_shown(frontier, change.loads, true, text);
  const auto far =
      std::ranges::max_element(on, {}, [](const FrontierRow* row) { return row->on_frontier ? row->error : 0; });
  const auto near = std::ranges::min_element(on, {}, &FrontierRow::error);
  text += fmt::format(
      "  the farthest: {}, error {}, 1/{:.3g} of the paper's cost; the nearest: {}, error {}, 1/{:.3g}\n", named(**far),
      percent((*far)->error), (*far)->ratio, named(**near), percent((*near)->error), (*near)->ratio);
}

std::string reference_text(const Frontier& frontier) {
  const Cells& cells = frontier.request.reference;
  return fmt::format(
      "32 vectors made for each body alone on a mesh of {}x{}x{} cells, extrapolated from it and one of half its "
      "cells; each motion integrated exactly",
      cells[0], cells[1], cells[2]);
}

}  // namespace

std::string frontier_csv(const Frontier& frontier) {
  std::string csv =
      "method,nodes,dt_s,basis,error_rel,error_max_m,cost_us_per_tick,cost_ratio_to_paper,memory_bytes,on_frontier,"
      "loads,cells,cost_with_control_points_us,control_points_ratio_to_paper,on_frontier_with_control_points,uncertain";
  for (const Muscle muscle : frontier.request.muscles) csv += fmt::format(",error_{}", muscle_name(muscle));
  csv += ",paper\n";
  for (const FrontierRow& row : frontier.rows) {
    csv += fmt::format("{},{},{:.6g},{},{:.6g},{:.6g},{:.6g},{:.6g},{},{:d},{},{},{:.6g},{:.6g},{:d},{:d}", row.method,
                       row.nodes, row.dt_s, row.vectors, row.error, row.error_max_m, row.cost_us, row.ratio,
                       row.memory_bytes, row.on_frontier, row.loads ? "frame" : "line", row.cells, row.points_us,
                       row.points_ratio, row.points_on_frontier, row.uncertain);
    for (const double error : row.error_of_muscle) csv += std::isfinite(error) ? fmt::format(",{:.6g}", error) : ",";
    std::string mark = row.mark;
    std::ranges::replace(mark, ',', ' ');
    csv += fmt::format(",{}\n", mark);
  }
  return csv;
}

std::string frontier_text(const Frontier& frontier) {
  const FrontierRequest& request = frontier.request;
  std::string text = fmt::format(
      "{} muscles, {} walks, {:.3g} s of each; against {}.\nCosts: {} ({}), one thread, crowds of at least {} "
      "muscles.\n",
      request.muscles.size(), request.walks.size(), request.seconds, reference_text(frontier), frontier.machine.cpu,
      frontier.machine.target, frontier.least_muscles);
  for (const FrontierChange& change : frontier.change) add_scene(frontier, change, text);
  if (frontier.shared_us > 0) {
    const auto paper = std::ranges::find_if(frontier.rows, [](const FrontierRow& row) { return !row.loads; });
    if (paper != frontier.rows.end()) {
      text += fmt::format("\nThe paper's choice where all share one stiffness: {:.4g} us a tick, {:.3g} of {:.4g}.\n",
                          frontier.shared_us, frontier.shared_us / paper->cost_us, paper->cost_us);
    }
  }
  for (const std::string& note : frontier.notes) text += note + "\n";
  return text;
}

}  // namespace mobil
