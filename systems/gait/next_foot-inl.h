// Placement of the next foot, and curvature of the walking line there. See engine/wide-inl.h for how to include it.

#if defined(MOBIL_SYSTEMS_GAIT_NEXT_FOOT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_GAIT_NEXT_FOOT_INL_H_
#undef MOBIL_SYSTEMS_GAIT_NEXT_FOOT_INL_H_
#else
#define MOBIL_SYSTEMS_GAIT_NEXT_FOOT_INL_H_
#endif

#include "assets/gait/walking_line-inl.h"
#include "systems/gait/heading-inl.h"
#include "systems/gait/step_limits.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

/// Maximum distance between the centre of pressure of a foot and the point that its turn requires, of the height.
constexpr float within_sole = 0.012F;
constexpr float centre_over_gravity = 0.56F / 9.81F;  // height of the centre of mass, of the height; s²/m
/// Minimum distance to the other foot's line when a foot is put to the inside, of the distance in a straight walk;
/// maximum displacement to the outside, of the height.
constexpr float nearest = 0.4F, farthest = 0.08F;

/// A step at its beginning, with the inputs of its turn: length, final speed, distance between both feet's lines in a
/// straight walk, curvature and shift of the stance foot. `lands_left` is 1 if the right foot stands, otherwise −1.
struct StepBegun {
  Wide height, length, speed, apart, bend, shift, lands_left;
};

/// Placement of a landing foot, to the left of its place on the line, and curvature of the line while the foot bears
/// load.
struct NextFoot {
  Wide shift, bend;
};

/// Takes as much of the way to the wanted heading as is left after the bend of this stance, as far as the foot can be
/// put outward for it.
HWY_INLINE NextFoot next_foot(const StepBegun& step, const Wide& way) {
  const Wide &height = step.height, &length = step.length, &speed = step.speed, &shift = step.shift;
  const WideMask walks = (length > 0.0F) & (speed > 0.0F);
  const Wide far = max(length, 0.05F), squared = max(speed * speed, 0.01F);
  const Wide most = min(step_limits::max_sideways / squared, step_limits::max_turn / far);
  const Wide bends = length * step.bend;
  const WideMask there = max(abs(way), abs(bends)) < as_asked;
  const Wide after = select(there, wide(0.0F), (way - (1.0F - slope_at_end) * bends) / far);
  const Wide shift_per_bend = -centre_over_gravity * height * squared;
  // The foot after an inside one can come back inward only a limited way, which limits the turn.
  // undo.
  const Wide undone = ((1.0F - nearest) * step.apart + within_sole * height) / -shift_per_bend, turned = abs(after);
  const WideMask inside = (after * step.lands_left > 0.0F) & (turned > undone);
  const Wide wish = copy_sign(min(select(inside, 0.5F * (turned + undone), turned), most), after);
  const Wide wished = select(walks, wish, wide(0.0F));
  // Outward from the stance foot to the landing foot.
  const Wide outward = step.lands_left * (shift_per_bend * wished - shift);
  const Wide kept = fma(step.lands_left, min(max(outward, (nearest - 1.0F) * step.apart), farthest * height), shift);
  const Wide possible = kept / shift_per_bend, slack = abs(within_sole * height / shift_per_bend);
  // Without this limit a walker who has slowed down would turn on the spot because of a foot that is still far outside.
  const Wide bend = min(max(min(max(wished, possible - slack), possible + slack), -most), most);
  return {select(walks, kept, shift), select(walks, bend, wide(0.0F))};
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
