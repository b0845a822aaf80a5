// One step of sixteen walkers while it is solved: what its parts share. Include it as engine/wide-inl.h says.

#if defined(MOBIL_SYSTEMS_GAIT_STEP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_GAIT_STEP_INL_H_
#undef MOBIL_SYSTEMS_GAIT_STEP_INL_H_
#else
#define MOBIL_SYSTEMS_GAIT_STEP_INL_H_
#endif

#include "systems/gait/strike-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {

constexpr std::size_t intervals = knot_count - 1;
/// For difference quotients, s.
constexpr float dt = 2e-3F;

/// Everything about one step that its parts share.
struct Step {
  LegSize leg;
  Wide height, mass, duration, double_support, flat;
  Wide rate_from, rate_to;  // of the phase
  WideMask from_stands, to_stands;
  Footing support, trailing, landing;
  const GaitStyleOf<Lanes<float>>* style;
  StepPlan<Lanes<float>>* plan;

  HWY_INLINE Wide phase(const Wide& u) const { return hermite(u, wide(0.0F), rate_from, wide(1.0F), rate_to); }

  /// A leg's own hip at time t, relative to the stance foothold; `turns` 0 for the stance leg, 1 for the other.
  HWY_NOINLINE Place hip(const Wide& t, float turns) const {
    const Wide u = t / duration;
    const PelvisManner pelvis = pelvis_manner(plan->from.manner, plan->to.manner, u);
    const Place middle = {wide(0.0F), curve_at(plan->hip_up_m, u), curve_at(plan->hip_forward_m, u)};
    return middle + hip_offset(leg, pelvis, phase(u) + turns);
  }
};

struct Pitch {
  Wide value, rate;
};

/// A curve over `span` through `at`, given twice as densely as its knots, slopes by central differences; the ends as
/// given.
HWY_NOINLINE inline void fit_samples(Curve<Lanes<float>>& curve, const Wide* at, const Wide& span, const Pitch& first,
                                     const Pitch& last) {
  const Wide per_knot = span / static_cast<float>(intervals);
  for (std::size_t k = 0; k <= intervals; ++k) {
    store(k == 0 ? first.value : k == intervals ? last.value : at[2 * k], curve.value[k]);
    const Wide slope = k == 0           ? first.rate * per_knot
                       : k == intervals ? last.rate * per_knot
                                        : at[2 * k + 1] - at[2 * k - 1];
    store(slope, curve.slope[k]);
  }
}

/// The same through value(t) at equal times from `start`.
template <class Value>
HWY_INLINE void fit(Curve<Lanes<float>>& curve, const Wide& start, const Wide& span, const Pitch& first,
                    const Pitch& last, Value value) {
  Wide at[2 * intervals + 1];
  at[0] = first.value;
  at[2 * intervals] = last.value;
  for (std::size_t i = 1; i < 2 * intervals; ++i)
    at[i] = value(fma(span, wide(static_cast<float>(i) / (2 * intervals)), start));
  fit_samples(curve, at, span, first, last);
}

}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
