// The line along which a person walks, between the footholds: straight, or bent as the feet can push. Include it as
// engine/wide-inl.h describes.

#if defined(MOBIL_ASSETS_GAIT_WALKING_LINE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_ASSETS_GAIT_WALKING_LINE_INL_H_
#undef MOBIL_ASSETS_GAIT_WALKING_LINE_INL_H_
#else
#define MOBIL_ASSETS_GAIT_WALKING_LINE_INL_H_
#endif

#include "engine/wide-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

/// The line from one foothold to the next, relative to the straight way between them. Its curvature is that of one
/// foot's stance until the other foot takes the weight over, and then that of the other's. `bend_rad` and `change_rad`
/// are curvature and its change times the length.
struct Chord {
  Wide length_m, bend_rad, change_rad;
};

/// Parts of the chord between which the weight passes from foot to foot.
constexpr float change_from = 0.58F, change_to = 0.82F, change_over = change_to - change_from;

/// Return the place and slope of the line of unit length whose curvature grows from 0 to 1 there, as 3 q² − 2 q³.
HWY_INLINE Wide changed_place(const Wide& s) {
  const Wide q = clamp((s - change_from) / change_over, 0.0F, 1.0F), beyond = max(s - change_to, 0.0F);
  return fma(q * q * q, (change_over * change_over) * q * fma(q, wide(-0.1F), wide(0.25F)),
             beyond * fma(beyond, wide(0.5F), wide(0.5F * change_over)));
}
HWY_INLINE Wide changed_slope(const Wide& s) {
  const Wide q = clamp((s - change_from) / change_over, 0.0F, 1.0F);
  return fma(q * q * q, change_over * fma(q, wide(-0.5F), wide(1.0F)), max(s - change_to, 0.0F));
}
constexpr float place_at_end =
    0.15F * change_over * change_over + (1 - change_to) * 0.5F * (change_over + 1 - change_to);
constexpr float slope_at_end = 0.5F * change_over + 1 - change_to;

/// Return the chord's heading relative to the line's start, and the line's turn along it; to the left, rad.
HWY_INLINE Wide chord_heading(const Chord& c) {
  return fma(c.bend_rad, wide(0.5F), place_at_end * c.change_rad);
}
HWY_INLINE Wide chord_turn(const Chord& c) {
  return fma(c.change_rad, wide(slope_at_end), c.bend_rad);
}

/// Return the line's distance to the left of the chord at a part of it, and its heading relative to the chord.
HWY_INLINE Wide left_of_chord(const Chord& c, const Wide& part) {
  const Wide curved = fma(c.bend_rad, 0.5F * part * part, c.change_rad * changed_place(part));
  return c.length_m * fnma(chord_heading(c), part, curved);
}
HWY_INLINE Wide heading_on_chord(const Chord& c, const Wide& part) {
  return fma(c.bend_rad, part, c.change_rad * changed_slope(part)) - chord_heading(c);
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
