#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/gait/gait_advance.cpp"
#include <hwy/foreach_target.h>

#include "engine/wide-inl.h"
#include "systems/gait/gait.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {

void advance_block(const StepPlan<Lanes<float>>& plan, GaitState<Lanes<float>>& state, float tick_s) {
  const Wide step = load(plan.duration_s);
  const Wide time = load(state.time_s) + wide(tick_s);
  const Wide done = floor(time / step);
  store(max(fnma(done, step, time), wide(0.0F)), state.time_s);
  Wide s, c;
  sin_cos(load(state.heading_rad), s, c);
  const Wide along = done * load(plan.step_length_m);
  store(fma(along, s, load(state.line_x_m)), state.line_x_m);
  store(fma(along, c, load(state.line_z_m)), state.line_z_m);
  Lanes<float> steps;
  store(done, steps);
  for (std::size_t l = 0; l < lane_count; ++l) {
    const auto n = static_cast<std::uint32_t>(steps[l]);
    state.steps[l] += n;
    state.stance_side[l] ^= n & 1U;
  }
}

}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil {

HWY_EXPORT(advance_block);

void advance_gait(const StepPlan<Lanes<float>>& plan, GaitState<Lanes<float>>& state, float tick_s) {
  HWY_DYNAMIC_DISPATCH(advance_block)(plan, state, tick_s);
}

}  // namespace mobil
#endif
