#pragma once
// The plots of a comparison: ours over what was measured.

#include <string>
#include <vector>

#include "demo/lab/compare/compare_verdicts.h"

namespace mobil {

struct NamedPlot {
  std::string file, text;  // name without folder; the whole SVG
};

/// angles.svg, ground_reaction.svg, moments.svg, steps.svg, centre_of_mass.svg.
std::vector<NamedPlot> comparison_plots(const Comparison& comparison);

}  // namespace mobil
