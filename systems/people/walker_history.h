#pragma once
// A walker's state a few ticks ago, for effects that start in mid-walk and need a history.

#include <optional>

#include <mobil/components/gait.h>
#include <mobil/components/step_plan.h>

namespace mobil::inline v0_3 {

/// Returns a walker's state `seconds` earlier, within the current step or, for a steady walk, the equal one before it.
std::optional<GaitState<float>> earlier(GaitState<float> state, const StepPlan<float>& plan, float seconds);

}  // namespace mobil::inline v0_3
