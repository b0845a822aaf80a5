#include "demo/pictures/cycle_plot.h"

#include <utility>

namespace mobil {

std::vector<double> cycle_percents() {
  std::vector<double> x(cycle_points);
  for (std::size_t i = 0; i < cycle_points; ++i) x[i] = 100.0 * static_cast<double>(i) / (cycle_points - 1);
  return x;
}

std::vector<double> cycle_values(const CycleCurve& curve, double scale, double from) {
  std::vector<double> y;
  for (const double v : curve) y.push_back(scale * (v - from));
  return y;
}

void add_measured(PlotPanel& panel, const MeasuredCurve& curve, const std::string& name, const std::string& colour,
                  bool faint) {
  PlotBand band{cycle_percents(), {}, {}, colour, name + ", mean ± 1 SD", faint ? 0.10 : 0.28};
  for (std::size_t i = 0; i < cycle_points; ++i) {
    band.low.push_back(curve.mean[i] - curve.sd[i]);
    band.high.push_back(curve.mean[i] + curve.sd[i]);
  }
  panel.bands.push_back(std::move(band));
  panel.lines.push_back({cycle_percents(), cycle_values(curve.mean), colour, "", faint ? 0.7 : 1.0, faint});
}

PlotPanel cycle_panel(std::string title, std::string y_label) {
  PlotPanel panel;
  panel.title = std::move(title);
  panel.x = {"% of the gait cycle", 0, 100};
  panel.y.label = std::move(y_label);
  return panel;
}

}  // namespace mobil
