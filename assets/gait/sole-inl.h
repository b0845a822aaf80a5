// Area where a foot on the ground can press it. Include it as engine/wide-inl.h describes.

#if defined(MOBIL_ASSETS_GAIT_SOLE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_ASSETS_GAIT_SOLE_INL_H_
#undef MOBIL_ASSETS_GAIT_SOLE_INL_H_
#else
#define MOBIL_ASSETS_GAIT_SOLE_INL_H_
#endif

#include "assets/gait/step_curves-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

namespace sole {
/// Origin of the fitted centre of pressure, ahead of the ankle, in body heights.
constexpr float pressed_ahead = 0.05F / 1.75F;
/// Pitch (rad) from which on only the heel bears, and heel rise from which on only the forefoot does. `pad` is the
/// extent of the bearing end, in body heights, because pads are soft and round.
constexpr float toes_lifted = 0.30F, heel_lifted = 0.15F, pad = 0.03F / 1.75F;
/// Extent to each side of the foot's line, in body heights.
constexpr float half_width = 0.025F;
}  // namespace sole

/// Extent of the bearing part of a foot from its ankle's foothold, along the foot.
struct SoleReach {
  Wide back, front;
};

HWY_INLINE SoleReach sole_reach(const Wide& height, const Wide& pitch) {
  constexpr float tip = unit_foot::ball + unit_foot::toes, heel = -unit_foot::back;
  const Wide toes_down = clamp(1.0F - max(pitch, 0.0F) * (1.0F / sole::toes_lifted), 0.0F, 1.0F);
  const Wide heel_up = clamp(max(-pitch, 0.0F) * (1.0F / sole::heel_lifted), 0.0F, 1.0F);
  return {height * fma(heel_up, wide(unit_foot::ball - sole::pad - heel), wide(heel)),
          height * min(fma(toes_down, wide(tip - heel), wide(heel + sole::pad)), tip)};
}

/// Returns the place at which a walk of that shape presses the ground, along the foot, at a part of the foot's stance.
template <class Shape>
HWY_INLINE Wide pressed(const Shape& of, const Wide& height, const Wide& part) {
  return fma(wide(sole::pressed_ahead), height,
             legendre_sum(of, step_shape::pressure, 2.0F * clamp(part, 0.0F, 1.0F) - 1.0F));
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
