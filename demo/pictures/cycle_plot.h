#pragma once
// Curves over the gait cycle as series of a plot.

#include "demo/pictures/cycle_curve.h"
#include "demo/pictures/svg_plot.h"

namespace mobil {

inline constexpr const char *ours_colour = "#111", *first_colour = "#2f6db3", *second_colour = "#c1762c";
inline constexpr const char* series_colour[] = {"#2a9d8f", "#2f6db3", "#a23b72", "#c1762c", "#555"};

/// Returns the positions of a curve's points, 0 to 100 %.
std::vector<double> cycle_percents();

/// Returns scale · (value − from) for each point.
std::vector<double> cycle_values(const CycleCurve& curve, double scale = 1, double from = 0);

/// Adds a measured band with its mean; `faint` if it is only for comparison.
void add_measured(PlotPanel& panel, const MeasuredCurve& curve, const std::string& name, const std::string& colour,
                  bool faint);

/// Returns an empty panel over the cycle.
PlotPanel cycle_panel(std::string title, std::string y_label);

}  // namespace mobil
