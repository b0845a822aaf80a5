// Results of `mobil frontier` in words, numbers and a plot of error against cost.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

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
  if (row.modes > 0) text += fmt::format(", {} modes", row.modes);
  if (row.method != "static" && row.modes == 0) text += fmt::format(", {:.3g} ms", 1e3 * row.dt_s);
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
  text += fmt::format("  the reference's own change: {} from half the cells, {} from 24 modes\n", percent(change.mesh),
                      percent(change.modes));
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
      "32 modes made for each body alone on a mesh of {}x{}x{} cells, extrapolated from it and one of half its "
      "cells; each motion integrated exactly",
      cells[0], cells[1], cells[2]);
}

struct Series {
  std::string_view method, label, colour;
};
constexpr std::array series = {
    Series{"static", "static", "#8c6d31"},
    Series{"explicit-central", "explicit (ECD)", "#1f77b4"},
    Series{"implicit-central", "implicit, consistent mass (ICD)", "#17a2b8"},
    Series{"newmark", "constant average acceleration (CAA)", "#9467bd"},
    Series{"modal-static", "modal, static", "#bcbd22"},
    Series{"modal-plain", "modal, not extrapolated", "#e377c2"},
    Series{"modal", "modal, state alone", "#2ca02c"},
};
constexpr std::string_view placed_label = "modal, control points placed", placed_colour = "#ff7f0e",
                           frontier_label = "Pareto frontier", paper_label = "the paper's choices",
                           paper_colour = "#d62728";

std::vector<const FrontierRow*> sorted_by(const Frontier& frontier, bool loads, bool FrontierRow::*on,
                                          double FrontierRow::*cost) {
  std::vector<const FrontierRow*> rows;
  for (const FrontierRow& row : frontier.rows) {
    if (row.loads == loads && row.*on) rows.push_back(&row);
  }
  std::ranges::sort(rows, {}, [&](const FrontierRow* row) { return row->*cost; });
  return rows;
}

void add_line(const Frontier& frontier, bool loads, bool placed, PlotPanel& panel) {
  const auto cost = placed ? &FrontierRow::points_us : &FrontierRow::cost_us;
  PlotLine line{{},     {},
                "#555", placed ? std::string(frontier_label) + ", with control points" : std::string(frontier_label),
                1.4,    placed};
  for (const FrontierRow* row :
       sorted_by(frontier, loads, placed ? &FrontierRow::points_on_frontier : &FrontierRow::on_frontier, cost)) {
    line.x.push_back(row->*cost);
    line.y.push_back(100 * row->error);
  }
  panel.lines.push_back(std::move(line));
}

/// Returns the number of modes, as the label of a point on the frontier; each number once.
std::string number_beside(const Frontier& frontier, const FrontierRow& row) {
  const bool bettered = std::ranges::any_of(frontier.rows, [&](const FrontierRow& other) {
    return other.loads == row.loads && other.on_frontier && other.modes == row.modes && other.error < row.error;
  });
  return row.on_frontier && !bettered && std::has_single_bit(row.modes) ? std::to_string(row.modes) : "";
}

void add_points(const Frontier& frontier, bool loads, PlotPanel& panel) {
  const auto add = [&](std::string_view method, std::string_view label, std::string_view colour,
                       double FrontierRow::*cost, bool numbered) {
    PlotPoints points{{}, {}, {}, std::string(colour), std::string(label)};
    for (const FrontierRow& row : frontier.rows) {
      if (row.loads != loads || row.method != method) continue;
      points.x.push_back(row.*cost);
      points.y.push_back(100 * row.error);
      points.text.push_back(numbered ? number_beside(frontier, row) : "");
    }
    if (!points.x.empty()) panel.points.push_back(std::move(points));
  };
  for (const Series& one : series) {
    add(one.method, one.label, one.colour, &FrontierRow::cost_us, one.method == "modal");
  }
  add("modal", placed_label, placed_colour, &FrontierRow::points_us, false);
  PlotPoints paper{{}, {}, {}, std::string(paper_colour), std::string(paper_label)};
  for (const FrontierRow& row : frontier.rows) {
    if (row.loads != loads || row.mark.empty()) continue;
    paper.x.push_back(row.cost_us);
    paper.y.push_back(100 * row.error);
    paper.text.push_back(std::to_string(row.nodes) + " nodes");
  }
  panel.points.push_back(std::move(paper));
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
                       row.nodes, row.dt_s, row.modes, row.error, row.error_max_m, row.cost_us, row.ratio,
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
      frontier.machine.target, frontier.min_muscles);
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

PlotFigure frontier_figure(const Frontier& frontier) {
  PlotFigure figure{"What accuracy costs",
                    "Against a converged reference, over our own walks; one core. Numbers: modes.",
                    frontier.change.size(),
                    430,
                    340,
                    true};
  for (const FrontierChange& change : frontier.change) {
    PlotPanel panel;
    panel.title = change.loads ? "line of action, gravity and the frame's motion" : "line of action alone";
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (const FrontierRow& row : frontier.rows) {
      least = std::min(least, row.cost_us);
      most = std::max(most, row.points_us);
    }
    panel.x = {"µs a muscle and tick of 1/60 s", least / 1.6, most * 1.6, true};
    panel.y = {"error, % of the displacement (rms)", {}, {}, true};
    add_line(frontier, change.loads, false, panel);
    add_line(frontier, change.loads, true, panel);
    add_points(frontier, change.loads, panel);
    figure.panels.push_back(std::move(panel));
  }
  return figure;
}

}  // namespace mobil
