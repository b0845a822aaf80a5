// Turns toward the wanted heading, and walkers whose steps they change. See engine/wide-inl.h for inclusion.

#if defined(MOBIL_SYSTEMS_GAIT_HEADING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_GAIT_HEADING_INL_H_
#undef MOBIL_SYSTEMS_GAIT_HEADING_INL_H_
#else
#define MOBIL_SYSTEMS_GAIT_HEADING_INL_H_
#endif

#include "assets/gait/step_curves-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

constexpr float pi_f = 3.14159265F;

/// Deviation from the wanted heading above which a standing person turns on the spot, rad.
constexpr float off_heading = 0.02F;

/// Deviation above which a walker takes steps closer to the usual ones, rad.
constexpr float own_turn_rad = 0.05F;

constexpr std::size_t style_numbers = sizeof(GaitStyle) / sizeof(float);
static_assert(sizeof(GaitStyleOf<Lanes<float>>) == style_numbers * lane_count * sizeof(float));

/// Returns the largest difference of a style's parameters from the usual ones. It is 0 for the usual style, whose
/// turning steps are the same as straight ones.
HWY_INLINE Wide off_usual(const GaitStyleOf<Lanes<float>>& style) {
  constexpr GaitStyle usual;
  const auto* const own = reinterpret_cast<const float*>(&style);
  const auto* const there = reinterpret_cast<const float*>(&usual);
  Wide off = wide(0.0F);
  for (std::size_t p = 0; p < style_numbers; ++p) off = max(off, abs(load(own + p * lane_count) - there[p]));
  return off;
}

/// Deviation from the wanted heading, and turn within a step, below which a walker goes straight on, rad.
constexpr float as_asked = 4e-6F;

/// Returns the turn from one heading to another, at most half a turn either way.
HWY_INLINE Wide shorter_way(const Wide& from, const Wide& to) {
  const Wide off = to - from;
  return off - (2.0F * pi_f) * floor(off * (0.5F / pi_f) + 0.5F);
}

/// Returns the standing people who put a foot down elsewhere.
HWY_INLINE WideMask steps_on_spot(const StepPlan<Lanes<float>>& plan) {
  return stands_still(plan) & (load(plan.landing) > 0.0F);
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
