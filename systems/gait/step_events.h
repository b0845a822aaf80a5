#pragma once
// When feet come to the ground and leave it within a tick, and where.

#include <cstdint>

#include <mobil/components/footing.h>
#include <mobil/components/gait.h>
#include <mobil/components/lanes.h>
#include <mobil/components/step_events.h>

namespace mobil::inline v0_3 {

/// Places of the ground under the ankles of feet that lie flat, and where the feet point (rad about +Y, 0 toward +Z,
/// positive to the left): of the other foot before it leaves the ground, of the stance foot, of the other foot once it
/// has come down.
template <class F>
struct Footholds {
  F x_m[3], z_m[3], heading_rad[3];  // by FootholdOf
};

void footholds(const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state, Footholds<Lanes<float>>& out);

/// What comes to pass in a tick, `rows` being sixteen: before the walkers' clocks go on, what does until the step of
/// each ends; once the steps that began in it are planned and their turns are (plan_next_step, turn_gait), the rest.
/// Whoever's tick is longer than the step has what is left of the next one in the next tick.
void begin_step_events(const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state, float tick_s,
                       StepEvents* rows);
void end_step_events(const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state, float tick_s,
                     StepEvents* rows);

}  // namespace mobil::inline v0_3
