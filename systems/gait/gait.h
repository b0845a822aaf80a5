#pragma once
// Walking: from a request to a solved step (set-up), and the walker's clock (every tick).

#include "components/body.h"
#include "components/gait.h"
#include "engine/error.h"

namespace mobil {

/// Completes and checks a request for a body. Fails on speeds outside 0.3–2.3 m/s (at a leg of 0.90 m; in proportion to
/// √leg), step lengths outside 0.25–1.25 leg lengths, step frequencies outside 0.5–3 Hz (at that leg; in proportion to
/// 1/√leg), three values that disagree, or a style value outside its range.
Result<Gait> resolve_gait(const Body& body, const GaitRequest& request);

/// Solves one steady step: support dynamics, heel rise, swing dynamics, as curves. Fails, naming why, if none exists.
Result<StepPlan<float>> plan_step(const Body& body, const Gait& gait);

/// Moves each walker's clock on by tick_s; at each heel strike the sides change and the line moves on by a step.
void advance_gait(const StepPlan<Lanes<float>>& plan, GaitState<Lanes<float>>& state, float tick_s);

}  // namespace mobil
