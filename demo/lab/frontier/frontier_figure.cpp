// `mobil frontier`'s picture: error against cost.

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <string_view>

#include "demo/lab/frontier/frontier.h"

namespace mobil {
namespace {

struct Series {
  std::string_view method, label, colour;
};
constexpr std::array series = {
    Series{"static", "static", "#8c6d31"},
    Series{"ecd", "explicit (ECD)", "#1f77b4"},
    Series{"icd", "implicit, consistent mass (ICD)", "#17a2b8"},
    Series{"caa", "constant average acceleration (CAA)", "#9467bd"},
    Series{"reduced-static", "reduced, static", "#bcbd22"},
    Series{"reduced-plain", "reduced, not extrapolated", "#e377c2"},
    Series{"reduced", "reduced, state alone", "#2ca02c"},
};
constexpr std::string_view placed_label = "reduced, control points placed", placed_colour = "#ff7f0e",
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

/// The number of vectors beside the point that is on the frontier, once a number.
std::string number_beside(const Frontier& frontier, const FrontierRow& row) {
  const bool bettered = std::ranges::any_of(frontier.rows, [&](const FrontierRow& other) {
    return other.loads == row.loads && other.on_frontier && other.vectors == row.vectors && other.error < row.error;
  });
  return row.on_frontier && !bettered && std::has_single_bit(row.vectors) ? std::to_string(row.vectors) : "";
}

void add_points(const Frontier& frontier, bool loads, PlotPanel& panel) {
  const auto add = [&](std::string_view method, std::string_view label, std::string_view colour,
                       double FrontierRow::*cost, bool numbered) {
    PlotPoints points{{}, {}, {}, {}, std::string(colour), std::string(label)};
    for (const FrontierRow& row : frontier.rows) {
      if (row.loads != loads || row.method != method) continue;
      points.x.push_back(row.*cost);
      points.y.push_back(100 * row.error);
      points.text.push_back(numbered ? number_beside(frontier, row) : "");
    }
    if (!points.x.empty()) panel.points.push_back(std::move(points));
  };
  for (const Series& one : series) {
    add(one.method, one.label, one.colour, &FrontierRow::cost_us, one.method == "reduced");
  }
  add("reduced", placed_label, placed_colour, &FrontierRow::points_us, false);
  PlotPoints paper{{}, {}, {}, {}, std::string(paper_colour), std::string(paper_label)};
  for (const FrontierRow& row : frontier.rows) {
    if (row.loads != loads || row.mark.empty()) continue;
    paper.x.push_back(row.cost_us);
    paper.y.push_back(100 * row.error);
    paper.text.push_back(std::to_string(row.nodes) + " nodes");
  }
  panel.points.push_back(std::move(paper));
}

}  // namespace

PlotFigure frontier_figure(const Frontier& frontier) {
  PlotFigure figure{"What accuracy costs",
                    "Against a converged reference, over our own walks; one core. Numbers: vectors.",
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
