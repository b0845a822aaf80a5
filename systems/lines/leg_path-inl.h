// Blocks of sixteen legs and the paths of muscles in them. See engine/wide-inl.h for how to include it.

#if defined(MOBIL_SYSTEMS_LINES_LEG_PATH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_LINES_LEG_PATH_INL_H_
#undef MOBIL_SYSTEMS_LINES_LEG_PATH_INL_H_
#else
#define MOBIL_SYSTEMS_LINES_LEG_PATH_INL_H_
#endif

#include <mobil/components/leg_frames.h>
#include "engine/wide_geometry-inl.h"
#include "systems/lines/muscle_lines.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

/// Returns the rotation angle of the shank about x in the thigh's frame.
MOBIL_WIDE_INLINE Wide knee_flexion(const WideQuat& thigh, const WideQuat& shank) {
  const WideQuat q = WideQuat{-thigh.x, -thigh.y, -thigh.z, thigh.w} * shank;
  const WideMask other_sign = q.w < wide(0.0F);
  return wide(2.0F) * atan2(select(other_sign, -q.x, q.x), abs(q.w));
}

/// A block of legs. Positions are relative to the knee, so no digits are lost far from the origin. Shank and foot are
/// displaced by `rolled` from the drawn bones, because the knee rolls.
struct Leg {
  WideVec origin[4];
  WideQuat rotation[4];
  Wide y_scale[4], across;
  WideVec edge[3];  // directions of the edges: x of pelvis, thigh and shank
  WideVec knee, rolled;
  Wide flexion, cube[knee_knots];  // of a track's spline: max(flexion / 20° − k, 0)³
};

constexpr float knots_per_rad = 57.2957795F / static_cast<float>(knee_knot_deg);

MOBIL_WIDE_INLINE WideVec track_at(const Leg& leg, const MuscleLines::Track& track) {
  WideVec at = fma(leg.flexion * wide(knots_per_rad), wide(track.slope), wide(track.at_zero));
  for (std::size_t k = 0; k < knee_knots; ++k) at = fma(leg.cube[k], wide(track.cubic[k]), at);
  return at;
}

/// Returns the vector from the bone's origin to a point fixed to it at `at` of the published leg, in world axes.
MOBIL_WIDE_INLINE WideVec turned(const Leg& leg, LegBone bone, const WideVec& at) {
  const auto b = static_cast<std::size_t>(bone);
  return rotate(leg.rotation[b], {leg.across * at.x, leg.y_scale[b] * at.y, leg.across * at.z});
}

MOBIL_WIDE_INLINE Leg load_leg(const MuscleLines& lines, const LegScale<Lanes<float>>& scale,
                               const LegFrames<Lanes<float>>& legs) {
  Leg leg;
  leg.knee = load(legs.knee_m);
  leg.rotation[0] = load(legs.pelvis);
  leg.rotation[1] = load(legs.thigh);
  leg.rotation[2] = load(legs.shank);
  leg.rotation[3] = load(legs.foot);
  leg.across = load(scale.across);
  leg.y_scale[0] = leg.y_scale[3] = leg.across;
  leg.y_scale[1] = load(scale.thigh);
  leg.y_scale[2] = load(scale.shank);
  const Wide zero = wide(0.0F);
  const WideVec x{wide(1.0F), zero, zero};
  for (std::size_t b = 0; b < 3; ++b) leg.edge[b] = rotate(leg.rotation[b], x);

  leg.flexion = knee_flexion(leg.rotation[1], leg.rotation[2]);
  const Wide u = leg.flexion * wide(knots_per_rad);
  for (std::size_t k = 0; k < knee_knots; ++k) {
    const Wide d = max(u - wide(static_cast<float>(k)), zero);
    leg.cube[k] = d * d * d;
  }
  const WideVec by = track_at(leg, lines.rolling);
  leg.rolled = rotate(leg.rotation[2], {zero, leg.across * by.y, leg.across * by.z});
  leg.origin[0] = leg.origin[1] = load(legs.hip_m) - leg.knee;
  leg.origin[2] = leg.rolled;
  leg.origin[3] = load(legs.ankle_m) - leg.knee + leg.rolled;
  return leg;
}

MOBIL_WIDE_INLINE WideVec place(const Leg& leg, LegBone bone, const WideVec& at) {
  return leg.origin[static_cast<std::size_t>(bone)] + turned(leg, bone, at);
}

HWY_INLINE WideVec place(const Leg& leg, const MuscleLines::Point& point) {
  return place(leg, point.bone, wide(point.at_m));
}

HWY_INLINE WideVec path_end(const Leg& leg, const MuscleLines::Member& member) {
  return member.on_kneecap ? place(leg, LegBone::shank, track_at(leg, member.kneecap)) : place(leg, member.path.back());
}

HWY_INLINE LegBone end_bone(const MuscleLines::Member& member) {
  return member.on_kneecap ? LegBone::shank : member.path.back().bone;
}

/// Point where the shortest path from `from` to `to` over the edge through p touches it, and the lanes in which it
/// does. Round the pelvis' edge a path never bends by more than a right angle; in deep flexion it is clear of it.
struct Touch {
  WideMask touched;
  WideVec at;
};
MOBIL_WIDE_INLINE Touch over_edge(const WideVec& from, const WideVec& to, const WideVec& p, const WideVec& axis,
                                  const MuscleLines::Point& edge) {
  const WideVec a = from - p, b = to - p;
  const Wide turn = dot(cross(a, b), axis);
  const Wide a_along = dot(a, axis), b_along = dot(b, axis);
  const Wide near = length(fma(-a_along, axis, a)), far = length(fma(-b_along, axis, b));
  const Wide slide = fma(a_along, far, b_along * near) / max(near + far, wide(1e-9F));
  const Wide zero = wide(0.0F);
  WideMask touched = edge.hold == PathHold::front ? turn < zero : turn > zero;
  if (edge.bone == LegBone::pelvis) touched = touched & (dot(a, b) < a_along * b_along);
  return {touched, fma(slide, axis, p)};
}

/// Calls segment(from, to, bone of `to`, mask of the lanes with that segment or null for all) along a member's path.
/// The path ends at `end`. A segment to an edge that is not touched has no length.
template <class Segment>
HWY_INLINE void along_path(const Leg& leg, const MuscleLines::Member& member, const WideVec& end,
                           const Segment& segment) {
  WideVec at = place(leg, member.path.front());
  const std::size_t points = member.path.size();
  const std::size_t corners = member.on_kneecap ? points : points - 1;  // before the end
  for (std::size_t i = 1; i < corners; ++i) {
    const MuscleLines::Point& point = member.path[i];
    WideVec next = place(leg, point);
    if (point.hold == PathHold::fixed) {
      segment(at, next, point.bone, nullptr);
    } else {
      const WideVec to = point.straight_to < corners ? place(leg, member.path[point.straight_to]) : end;
      const Touch touch = over_edge(at, to, next, leg.edge[static_cast<std::size_t>(point.bone)], point);
      next = select(touch.touched, touch.at, at);
      segment(at, next, point.bone, &touch.touched);
    }
    at = next;
  }
  segment(at, end, end_bone(member), nullptr);
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
