#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include "assets/gait/on_line-inl.h"
#include "engine/wide-inl.h"
#include "systems/gait/root_place.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

void root_block(const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state,
                RootPlace<Lanes<float>>& out) {
  const Wide u = load(state.time_s) / load(plan.duration_s), eased = smooth(u), phase = step_phase(plan, u);
  const Line line = line_of(plan, state);
  const OnLine on = on_line(line, quintic_at(plan.even_m, phase), phase, eased);
  Wide s, c, heading_s, heading_c;
  sin_cos(on.heading, s, c);
  const Ground aside = turned(shift_at_rest(plan, line, eased), wide(0.0F), s, c);
  const Wide heading = load(state.heading_rad);
  sin_cos(heading, heading_s, heading_c);
  const Ground place = turned(on.place.left + aside.left, on.place.forward + aside.forward, heading_s, heading_c);
  store(place.left, out.x_m);
  store(place.forward, out.z_m);
  store(heading + on.heading, out.heading_rad);
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {

HWY_EXPORT(root_block);

void root_place(const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state,
                RootPlace<Lanes<float>>& out) {
  HWY_DYNAMIC_DISPATCH(root_block)(plan, state, out);
}

}  // namespace mobil::inline v0_3
#endif
