#pragma once
// Times and positions of feet that land or leave the ground within a tick.

#include <cstdint>

#include <mobil/components/footing.h>
#include <mobil/components/gait.h>
#include <mobil/components/lanes.h>
#include <mobil/components/step_events.h>
#include <mobil/components/step_plan.h>

namespace mobil::inline v0_3 {

/// Ground positions under the ankles of flat feet, and directions of the feet (rad about +Y, 0 toward +Z, positive to
/// the left). The entries are the other foot before it leaves the ground, the stance foot, and the other foot after
/// landing.
template <class F>
struct Footholds {
  F x_m[3], z_m[3], heading_rad[3];  // by FootholdOf
};

void footholds(const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state, Footholds<Lanes<float>>& out);

/// Record the events of a tick in sixteen `rows`. begin_step_events runs before the walkers' clocks advance and records
/// events up to the end of each step. end_step_events runs after the new steps and their turns are planned
/// (plan_next_step, turn_gait) and records the rest. With ticks longer than a step, the next step continues in the next
/// tick.
void begin_step_events(const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state, float tick_s,
                       StepEvents* rows);
void end_step_events(const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state, float tick_s,
                     StepEvents* rows);

}  // namespace mobil::inline v0_3
