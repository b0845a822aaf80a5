#pragma once
// `mobil frontier --finite`: what accuracy costs where muscles pull and are shaken. Each way to move
// and show a belly is held against tissue at finite strain whose fibres pull.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <mobil/components/muscle.h>
#include <mobil/engine/error.h>
#include "demo/pictures/svg_plot.h"

namespace mobil {

/// How far the control points of one way are off the reference's, over what that moves: root of the mean square, of all
/// and of what is across; m at worst; the volume that they enclose off that at rest, at worst. And off, of what the
/// jolts alone add.
struct ActiveError {
  std::string way;
  double all = 0, across = 0, worst_m = 0, volume = 0, jolts_all = 0, jolts_across = 0;
  double cost_us = 0;  // of a tick with control points, of "all" alone
};

struct ActiveFrontier {
  std::string muscle;               // the last: "all" together
  double jolts_m = 0, bulge_m = 0;  // what the jolts add; what is across of all: roots of the mean square
  std::vector<ActiveError> ways;
};

/// These rows of the muscle table; some ten seconds each. `progress`: 0 to 1. The reference is nonlinear statics as the
/// tables are made from, and what two jolts add to nonlinear dynamics on 4x4x16 elements, held sideways and damped as
/// tuned bellies are.
std::vector<ActiveFrontier> measure_active(std::span<const Muscle> rows,
                                           void (*progress)(std::string_view what, double part));

std::string active_text(const std::vector<ActiveFrontier>& muscles);
std::string active_csv(const std::vector<ActiveFrontier>& muscles);
/// Error across against cost.
PlotFigure active_figure(const std::vector<ActiveFrontier>& muscles);

}  // namespace mobil
