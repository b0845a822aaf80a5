#pragma once
// `mobil frontier --finite`: accuracy and cost with active, shaken muscles. Each way to move and show a belly is
// compared with tissue at finite strain with active fibres.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <mobil/components/muscle.h>
#include <mobil/engine/error.h>
#include "demo/pictures/svg_plot.h"

namespace mobil {

/// Errors of one way's control points relative to the reference's motion: root mean square, of all components and of
/// those across; worst, m; worst of the enclosed volume, relative to rest. Also errors of the jolts' effect alone.
struct ActiveError {
  std::string way;
  double all = 0, across = 0, worst_m = 0, volume = 0, jolts_all = 0, jolts_across = 0;
  double cost_us = 0;  // of a tick with control points, only in "all"
};

struct ActiveFrontier {
  std::string muscle;               // the last: "all" together
  double jolts_m = 0, bulge_m = 0;  // effect of the jolts; all motion across: root mean squares
  std::vector<ActiveError> ways;
};

/// Measures these rows of the muscle table, for some ten seconds each. `progress` receives 0 to 1. The reference is
/// nonlinear statics, from which the tables are made, and the effect of two jolts in nonlinear dynamics on 4x4x16
/// elements, held sideways and damped as tuned bellies are.
std::vector<ActiveFrontier> measure_active(std::span<const Muscle> rows,
                                           void (*progress)(std::string_view what, double part));

std::string active_text(const std::vector<ActiveFrontier>& muscles);
std::string active_csv(const std::vector<ActiveFrontier>& muscles);
/// Returns a plot of error across against cost.
PlotFigure active_figure(const std::vector<ActiveFrontier>& muscles);

}  // namespace mobil
