// Places of the hips and of both feet along the walking line of this step. Include it as engine/wide-inl.h describes.

#if defined(MOBIL_ASSETS_GAIT_ON_LINE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_ASSETS_GAIT_ON_LINE_INL_H_
#undef MOBIL_ASSETS_GAIT_ON_LINE_INL_H_
#else
#define MOBIL_ASSETS_GAIT_ON_LINE_INL_H_
#endif

#include "assets/gait/step_feet-inl.h"
#include "assets/gait/walking_line-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

/// The walking line in the frame of the stance foothold (+Z its heading there), from the foothold before to the next
/// one.
struct Line {
  Chord from, to;
  Wide from_heading, to_heading;  // of the chords
  Wide from_s, from_c, to_s, to_c;
  Wide turned_before, turn;  // heading at the stance foothold less that at the one before; at the next one less it
  Wide shift_before, shift, shift_next;  // of footholds, to the left
  Wide slant;                            // of a standing walker's chords, relative to the body
};

HWY_INLINE Line line_of(const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state) {
  const Wide before = load(state.bend_before_per_m), now = load(state.bend_per_m), next = load(state.bend_next_per_m);
  const Wide length_before = load(plan.length_before_m), length = load(plan.step_length_m);
  Line line;
  line.from = {length_before, before * length_before, (now - before) * length_before};
  line.to = {length, now * length, (next - now) * length};
  line.from_heading = load(state.chord_before_rad);
  line.to_heading = load(state.chord_rad);
  sin_cos(line.from_heading, line.from_s, line.from_c);
  sin_cos(line.to_heading, line.to_s, line.to_c);
  line.turned_before = load(state.turn_before_rad);
  line.turn = load(state.turn_rad);
  line.shift_before = load(state.shift_before_m);
  line.shift = load(state.shift_m);
  line.shift_next = load(state.shift_next_m);
  line.slant = load(plan.slant_rad);
  return line;
}

/// A place to the left of and along a line of that heading.
struct Ground {
  Wide left, forward;
};

HWY_INLINE Ground turned(const Wide& left, const Wide& forward, const Wide& s, const Wide& c) {
  return {fma(left, c, forward * s), fnma(left, s, forward * c)};
}

HWY_INLINE Ground part_way(const Ground& a, const Ground& b, const Wide& part) {
  return {mix(a.left, b.left, part), mix(a.forward, b.forward, part)};
}

/// A place of the line in the frame of the stance foothold, `forward` along it, and the walker's heading there. Both
/// chords' lines have one curvature about the foothold, so the place of the blend between them matters little.
struct OnLine {
  Ground place;
  Wide heading;
};

HWY_INLINE OnLine on_line(const Line& line, const Wide& forward, const Wide& phase, const Wide& ahead) {
  constexpr float shortest = 0.05F;
  const Wide from = (forward + line.from.length_m) / max(line.from.length_m, shortest);
  const Wide to = forward / max(line.to.length_m, shortest);
  // A walker who turns on the spot has the rates of both turns at either end.
  auto heading = [&](const Chord& chord, const Wide& chord_heading, const Wide& part, const Wide& spot) {
    return select(chord.length_m > 0.0F, chord_heading + heading_on_chord(chord, part) - line.slant,
                  (phase - 0.5F) * spot);
  };
  return {part_way(turned(left_of_chord(line.from, from), forward, line.from_s, line.from_c),
                   turned(left_of_chord(line.to, to), forward, line.to_s, line.to_c), ahead),
          mix(heading(line.from, line.from_heading, from, line.turned_before),
              heading(line.to, line.to_heading, to, line.turn), ahead)};
}

/// Returns the length that the outer leg lacks at a strike in a turn, to a foothold that is shifted and, on the outer
/// arc, further ahead. The pelvis sinks by it.
HWY_INLINE Wide longer_leg(const Wide& length, const Wide& turn, const Wide& shift_before, const Wide& shift,
                           const Wide& height) {
  constexpr auto leg = static_cast<float>(fraction::hip_height);  // of the height
  constexpr float out = 0.075F;                                   // foot and hip from the middle, of the height
  const Wide far = max(abs(shift_before), abs(shift));
  const Wide ahead = (0.5F * abs(turn)) * fma(wide(out), height, far);
  return fma(far, far + 2.0F * ankle_outward * height, ahead * (ahead + length)) * 0.8F / (2.0F * leg * height);
}

/// Returns the hips' shift to the left of the line, to the middle of feet that are put left of it, on the way to
/// standing and from there.
HWY_INLINE Wide shift_at_rest(const StepPlan<Lanes<float>>& plan, const Line& line, const Wide& eased) {
  const Wide zero = wide(0.0F);
  return mix(select(stands(plan.from), 0.5F * (line.shift_before + line.shift), zero),
             select(stands(plan.to), 0.5F * (line.shift + line.shift_next), zero), eased);
}

/// Place of a foot in the frame of the stance foothold, and its heading there.
struct Foothold {
  Ground ankle;
  Wide heading;
};

/// Returns the stance foot's place.
HWY_INLINE Foothold stance_foothold(const Line& line, const FootMotion& foot, const Wide& out) {
  return {{fma(out, foot.ankle_out, line.shift), foot.ankle_forward}, wide(0.0F)};
}

/// Returns the other foot's: first in the frame of the foothold before, then along the line, at last in that of the
/// next.
HWY_NOINLINE inline Foothold other_foothold(const Line& line, const FootMotion& foot, const Wide& out) {
  const Wide left = out * foot.ankle_out, along = foot.ankle_forward;
  const Wide &length_before = line.from.length_m, &length = line.to.length_m;
  Wide before_s, before_c, ahead_s, ahead_c, s, c;
  sin_cos(-line.turned_before, before_s, before_c);
  sin_cos(line.turn, ahead_s, ahead_c);
  Ground from = turned(left + line.shift_before, along, before_s, before_c),
         to = turned(left + line.shift_next, along - length_before - length, ahead_s, ahead_c);
  from.left = fnma(length_before, line.from_s, from.left);
  from.forward = fnma(length_before, line.from_c, from.forward);
  to.left = fma(length, line.to_s, to.left);
  to.forward = fma(length, line.to_c, to.forward);
  const Wide& part = foot.part;
  Foothold f;
  f.heading = mix(-line.turned_before, line.turn, foot.swung);
  f.ankle = part_way(from, to, foot.swung);
  const Wide longest = max(max(length_before, length), 0.05F), forward = along - length_before;
  const OnLine way = on_line(line, forward, wide(0.0F), smooth(0.5F + forward / longest));
  sin_cos(way.heading, s, c);
  const Ground aside = turned(left + mix(line.shift_before, line.shift_next, foot.swung), wide(0.0F), s, c);
  const Ground in_air = {way.place.left + aside.left, way.place.forward + aside.forward};
  const WideMask early = part < 0.5F;
  const WideMask walks = length_before + length > 0.0F;  // turning on the spot has no line
  const Ground planted = {select(early, from.left, to.left), select(early, from.forward, to.forward)};
  const Ground there = part_way(planted, in_air, smooth(3.0F * min(part, 1.0F - part)));
  f.ankle = {select(walks, there.left, f.ankle.left), select(walks, there.forward, f.ankle.forward)};
  return f;
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
