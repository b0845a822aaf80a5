#pragma once
// Walking: from a request to a gait (set-up), the solved steps (whenever something changes) and the walker's clock
// (every tick).

#include "components/body.h"
#include "components/gait.h"
#include "engine/error.h"

namespace mobil {

/// Completes and checks a request for a body. Fails on speeds other than 0 outside 0.3–2.3 m/s (at a leg of 0.90 m; in
/// proportion to √leg), step lengths outside 0.25–1.25 leg lengths, step frequencies outside 0.5–3 Hz (at that leg; in
/// proportion to 1/√leg), three values that disagree, or a style value outside its range.
Result<Gait<float>> resolve_gait(const Body& body, const GaitRequest& request);

/// The first step of sixteen walkers, as if they had walked so before: right heel strike at the start, or standing.
void plan_first_step(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted,
                     StepPlan<Lanes<float>>& plan);

/// The step that follows `plan` for the foot that lands at its end to stand on (`state.stance_side`, already changed),
/// toward the wanted gait as far as one step may go (systems/gait/step_plan.cpp). Always gives a step that goes on from
/// the last one smoothly; `clamped` tells where no bounded forces make it.
void plan_next_step(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted,
                    const GaitState<Lanes<float>>& state, StepPlan<Lanes<float>>& plan);

/// Moves each walker's clock on by tick_s, at most one step. At a heel strike the sides change and the line moves on to
/// the next foothold.
void advance_gait(const StepPlan<Lanes<float>>& plan, GaitState<Lanes<float>>& state, float tick_s);

/// Bit l: lane l began a step in this tick that its plan does not describe yet.
std::uint32_t lanes_to_plan(const StepPlan<Lanes<float>>& plan, const Gait<Lanes<float>>& wanted,
                            const GaitState<Lanes<float>>& state, float tick_s);

/// Who began a step in this tick turns toward the wanted heading from the next foot on, by at most 30° a step and
/// 1.1 m/s² of acceleration sideways, for which that foot is put outward by z a / g: z the height of the centre of
/// mass, a its acceleration toward the inside (a pendulum's balance). Who stands turns by up to 30° a step on the spot,
/// or steps aside as planned. After the plan of the step.
void turn_gait(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan, const Gait<Lanes<float>>& wanted,
               GaitState<Lanes<float>>& state, float tick_s);

}  // namespace mobil
