#pragma once
// Plots as SVG text: a grid of panels with lines, bands and points.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace mobil {

/// A line through points, broken at points that are not finite (or not positive on a logarithmic axis). `label`: entry
/// in the legend, once for all series of that name in a figure; empty for none. `colour`: in CSS notation.
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

/// Single points. `text`: label next to each point, empty for none.
struct PlotPoints {
  std::vector<double> x, y;
  std::vector<std::string> text;
  std::string colour, label;
};

/// An axis. `low`, `high`: if absent, those of the data. The label should include the unit.
struct PlotAxis {
  std::string label;
  std::optional<double> low{}, high{};
  bool logarithmic = false;
};

/// A panel. `own_legend`: its legend is next to its title instead of at the top of the figure.
struct PlotPanel {
  std::string title;
  PlotAxis x, y;
  std::vector<PlotBand> bands;  // drawn first
  std::vector<PlotLine> lines;
  std::vector<PlotPoints> points;
  bool own_legend = false;
};

/// Panels in rows of `columns`, from the top left. `shared_y`: the panels of a row show one quantity, with one vertical
/// range and the left panel's axis, the only one with labels. Sizes are in pixels, without titles and labels.
struct PlotFigure {
  std::string title{}, footnote{};
  std::size_t columns = 1;
  double panel_width = 240, panel_height = 150;
  bool shared_y = false;
  std::vector<PlotPanel> panels{};
};

/// Returns the SVG file. Vectors of one series that differ in length are cut to the shortest.
std::string svg(const PlotFigure& figure);

/// Returns the ticks of an axis from `low` to `high`: about `count` multiples of 1, 2 or 5 times a power of ten. On a
/// logarithmic axis they are powers of ten, or 1, 2 and 5 times them if it spans less than three decades.
std::vector<double> plot_ticks(double low, double high, bool logarithmic, int count = 5);

}  // namespace mobil
