// Where the next foot is put, and how far the walking line bends then. Include it as engine/wide-inl.h says.

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

/// How far beside the place where its turn asks for it a foot may press the ground, of the height.
constexpr float within_sole = 0.012F;
constexpr float centre_over_gravity = 0.56F / 9.81F;  // height of the centre of mass, of the height; s²/m
/// How near a foot may come to the other's line when it is put to the inside, of the distance in a straight walk; how
/// far it may go to the outside, of the height.
constexpr float nearest = 0.4F, farthest = 0.08F;

/// A step as it begins, with what its turn follows from: its length and the speed it leads to, the distance between
/// both feet's lines in a straight walk, curvature and shift of the stance foot; `lands_left` is 1 where the right foot
/// stands, else −1.
struct StepBegun {
  Wide height, length, speed, apart, bend, shift, lands_left;
};

/// A foot that comes to the ground: where, to the left of its place on the line, and the curvature that the line has
/// while it bears.
struct NextFoot {
  Wide shift, bend;
};

/// As much of the way to the wanted heading as is left after the bend of this stance, as far as the foot can be put
/// outward for it.
HWY_INLINE NextFoot next_foot(const StepBegun& step, const Wide& way) {
  const Wide &height = step.height, &length = step.length, &speed = step.speed, &shift = step.shift;
  const WideMask walks = (length > 0.0F) & (speed > 0.0F);
  const Wide far = max(length, 0.05F), squared = max(speed * speed, 0.01F);
  const Wide most = min(step_limits::max_sideways / squared, step_limits::max_turn / far);
  const Wide bends = length * step.bend;
  const WideMask there = max(abs(way), abs(bends)) < as_asked;
  const Wide after = select(there, wide(0.0F), (way - (1.0F - slope_at_end) * bends) / far);
  const Wide shift_per_bend = -centre_over_gravity * height * squared;
  // The foot after one on the inside can come back inward only so far: no more than that foot can undo.
  const Wide undone = ((1.0F - nearest) * step.apart + within_sole * height) / -shift_per_bend, turned = abs(after);
  const WideMask inside = (after * step.lands_left > 0.0F) & (turned > undone);
  const Wide wish = copy_sign(min(select(inside, 0.5F * (turned + undone), turned), most), after);
  const Wide wished = select(walks, wish, wide(0.0F));
  // Seen outward from the stance foot to the one that lands.
  const Wide outward = step.lands_left * (shift_per_bend * wished - shift);
  const Wide kept = fma(step.lands_left, min(max(outward, (nearest - 1.0F) * step.apart), farthest * height), shift);
  const Wide possible = kept / shift_per_bend, slack = abs(within_sole * height / shift_per_bend);
  // Who has become slow would turn on the spot for a foot that still stands far out.
  const Wide bend = min(max(min(max(wished, possible - slack), possible + slack), -most), most);
  return {select(walks, kept, shift), select(walks, bend, wide(0.0F))};
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
