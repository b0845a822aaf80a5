#pragma once
// Plots as SVG: a grid of panels with lines, bands and points. Data in, text out.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace mobil {

/// A line through points; a point that is not finite (or not positive on a logarithmic axis) breaks it. `label`: in the
/// legend, once for all series of that name in a figure; empty for none. `colour`: as CSS writes it.
struct PlotLine {
  std::vector<double> x, y;
  std::string colour, label;
  double width = 1.6;  // pixels
  bool dashed = false;
};

/// The area between `low` and `high`.
struct PlotBand {
  std::vector<double> x, low, high;
  std::string colour, label;
  double opacity = 0.22;
};

/// Single points. `text`: written beside each, empty for none.
struct PlotPoints {
  std::vector<double> x, y;
  std::vector<std::string> text;
  std::string colour, label;
};

/// `low`, `high`: the data's own range where absent. Put the unit into the label.
struct PlotAxis {
  std::string label;
  std::optional<double> low{}, high{};
  bool logarithmic = false;
};

/// `own_legend`: its series are named beside its title and not at the head of the figure.
struct PlotPanel {
  std::string title;
  PlotAxis x, y;
  std::vector<PlotBand> bands;  // drawn first
  std::vector<PlotLine> lines;
  std::vector<PlotPoints> points;
  bool own_legend = false;
};

/// Panels fill rows of `columns` from the top left. `shared_y`: one vertical range a row, its axis that of the left
/// panel and labelled there alone; for rows of one quantity. Sizes are pixels and do not count titles and labels.
struct PlotFigure {
  std::string title{}, footnote{};
  std::size_t columns = 1;
  double panel_width = 240, panel_height = 150;
  bool shared_y = false;
  std::vector<PlotPanel> panels{};
};

/// The whole SVG file. Vectors of one series that differ in length are cut to the shortest.
std::string svg(const PlotFigure& figure);

/// Where an axis from `low` to `high` has its ticks: at 1, 2 or 5 times powers of ten, some `count` of them; on a
/// logarithmic axis at powers of ten, or at 1, 2 and 5 times them where it spans less than three.
std::vector<double> plot_ticks(double low, double high, bool logarithmic, int count = 5);

}  // namespace mobil
