#pragma once
// Walkers whom nobody sees: where a steady walk is at any tick, in closed form, and what becomes of one that is asked
// to turn, to stop or to go on, by its strikes alone.

#include <cstdint>
#include <optional>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/components/sleep.h>
#include "systems/gait/gait.h"

namespace mobil::inline v0_3 {

/// A style in bytes; nothing where it is not on the grid (`snapped`).
std::optional<SleepingStyle<float>> packed_style(const GaitStyle& style);
GaitStyle style_of(const SleepingStyle<float>& packed);

/// Bit l: lane l walks so steadily, or stands, that all later ticks follow from `walk`, for as long as nothing else is
/// asked. `tick`: ticks that have been run. Of other lanes `walk` means nothing.
std::uint32_t steady_walkers(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& gait,
                             const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state,
                             const Lanes<std::uint32_t>& tick, float tick_s, SteadyWalk<Lanes<float>>& walk);

/// Whether somebody may be steady, by what takes no time to read: who turns, or has not met what is asked, is not.
bool may_be_steady(const Gait<Lanes<float>>& gait, const StepPlan<Lanes<float>>& plan,
                   const GaitState<Lanes<float>>& state, std::size_t lane);

/// The state of a steady walk after so many ticks: what advance_gait and turn_gait would have made, to the bit.
void steady_state(const SteadyWalk<Lanes<float>>& walk, const Lanes<std::uint32_t>& tick, float tick_s,
                  GaitState<Lanes<float>>& state);
/// About where they are then, within a step and beside the line's own points; m.
void steady_places(const SteadyWalk<Lanes<float>>& walk, std::uint32_t tick, float tick_s, Lanes<float>& x_m,
                   Lanes<float>& z_m);

/// Walkers under way: body, what is asked of them, their step and where they are.
struct WalkingBlock {
  BodySize<Lanes<float>> size;
  Gait<Lanes<float>> gait;
  StepPlan<Lanes<float>> plan;
  GaitState<Lanes<float>> state;
};

/// Steady walks as walkers, after so many ticks.
void begin_steady(const SteadyWalk<Lanes<float>>& walk, const Lanes<std::uint32_t>& tick, float tick_s,
                  WalkingBlock& block);
/// Walkers who were steady at tick `asked`, by `before`, and were asked then for block.gait: as they are at `tick`, not
/// before `asked`. Their steps are solved as those of anybody. `work`: memory to work in, which is not `block` and does
/// not hold `gait_before`.
void walk_on(const Gait<Lanes<float>>& gait_before, const SteadyWalk<Lanes<float>>& before,
             const Lanes<std::uint32_t>& asked, const Lanes<std::uint32_t>& tick, float tick_s, WalkingBlock& block,
             WalkingBlock& work);
/// When those walkers are steady again and what they then do, by strikes alone: a hundredth of the time. `until` is
/// never_settles where that is not within twelve strikes.
void settle(const Gait<Lanes<float>>& gait_before, const SteadyWalk<Lanes<float>>& before,
            const Lanes<std::uint32_t>& asked, float tick_s, WalkingBlock& block, SteadyWalk<Lanes<float>>& after,
            Lanes<std::uint32_t>& until);

}  // namespace mobil::inline v0_3
