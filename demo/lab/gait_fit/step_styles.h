#pragma once
// How a step changes with the manner of a walk, and stays in balance.

#include "assets/gait/step_styles.h"
#include "demo/lab/gait_fit/step_grid.h"

namespace mobil {

/// By style_effects: the change of the node's shape (m, rad) for one unit of each.
using StyleChanges = std::array<StepShape, style_effects.size()>;

/// The changes that disturb the fitted step least: a step near the node's that balances as well, clears the ground and
/// is as smooth, and of which a parameter is different by a given amount; the difference, for one unit.
StyleChanges style_changes(const StepNode& node);

/// What style_effects' parameters are of, in their units, at a step. `usual` is the step that they are counted from.
std::array<double, style_effects.size()> style_values(const StepTask& task, const StepShape& usual,
                                                      const StepShape& shape);

}  // namespace mobil
