#pragma once
// Unseen walkers: closed-form state of steady walks at any tick, and changes of a walk computed only from heel strikes.

#include <cstdint>
#include <optional>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/components/sleep.h>
#include <mobil/components/step_plan.h>
#include "systems/gait/gait.h"

namespace mobil::inline v0_3 {

/// Packs a style into bytes. Returns nothing if it is not on the grid (`snapped`).
std::optional<SleepingStyle<float>> packed_style(const GaitStyle& style);
GaitStyle style_of(const SleepingStyle<float>& packed);

/// Returns a mask with bit l set if lane l walks so steadily, or stands, that all later ticks follow from `walk` until
/// the next request. `tick` is the number of ticks run. In other lanes `walk` is undefined.
std::uint32_t steady_walkers(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& gait,
                             const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state,
                             const Lanes<std::uint32_t>& tick, float tick_s, SteadyWalk<Lanes<float>>& walk);

/// Returns false if a walker cannot be steady, by a cheap check: walkers who turn or have unmet requests are not.
bool may_be_steady(const Gait<Lanes<float>>& gait, const StepPlan<Lanes<float>>& plan,
                   const GaitState<Lanes<float>>& state, std::size_t lane);

/// Computes the state of a steady walk after this many ticks, bit-identical to advance_gait and turn_gait.
void steady_state(const SteadyWalk<Lanes<float>>& walk, const Lanes<std::uint32_t>& tick, float tick_s,
                  GaitState<Lanes<float>>& state);
/// Computes approximate positions at that tick, m, between the line's points and accurate to within a step.
void steady_places(const SteadyWalk<Lanes<float>>& walk, std::uint32_t tick, float tick_s, Lanes<float>& x_m,
                   Lanes<float>& z_m);

/// Walkers in motion: body, request, step and state.
struct WalkingBlock {
  BodySize<Lanes<float>> size;
  Gait<Lanes<float>> gait;
  StepPlan<Lanes<float>> plan;
  GaitState<Lanes<float>> state;
};

/// Turns steady walks into walkers after this many ticks.
void begin_steady(const SteadyWalk<Lanes<float>>& walk, const Lanes<std::uint32_t>& tick, float tick_s,
                  WalkingBlock& block);
/// Computes the state at `tick` of walkers who were steady by `before` and received the request block.gait at tick
/// `asked`. `tick` is not before `asked`. Their steps are fully solved. `work` is scratch memory, other than `block`,
/// that does not contain `gait_before`.
void walk_on(const Gait<Lanes<float>>& gait_before, const SteadyWalk<Lanes<float>>& before,
             const Lanes<std::uint32_t>& asked, const Lanes<std::uint32_t>& tick, float tick_s, WalkingBlock& block,
             WalkingBlock& work);
/// Computes the tick at which those walkers are steady again and their walk from then on. It evaluates only heel
/// strikes and is 100 times faster than walk_on. `until` is never_settles if they are not steady within twelve strikes.
void settle(const Gait<Lanes<float>>& gait_before, const SteadyWalk<Lanes<float>>& before,
            const Lanes<std::uint32_t>& asked, float tick_s, WalkingBlock& block, SteadyWalk<Lanes<float>>& after,
            Lanes<std::uint32_t>& until);

}  // namespace mobil::inline v0_3
