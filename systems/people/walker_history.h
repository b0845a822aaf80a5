#pragma once
// Where a walker was a few ticks ago: for effects that begin under way and look back.

#include <optional>

#include <mobil/components/gait.h>

namespace mobil::inline v0_3 {

/// Where a walker was some seconds before, as far as the present step and one like it before that tell.
std::optional<GaitState<float>> earlier(GaitState<float> state, const StepPlan<float>& plan, float seconds);

}  // namespace mobil::inline v0_3
