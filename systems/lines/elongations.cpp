#include "systems/lines/elongations.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include "systems/lines/leg_path-inl.h"

#ifndef MOBIL_SYSTEMS_LINES_ELONGATIONS_CPP_
#define MOBIL_SYSTEMS_LINES_ELONGATIONS_CPP_
namespace mobil::inline v0_3 {
namespace {

/// Returns true if no joint changes the segment that ends at point `to`. The kneecap's end follows the last point.
bool is_constant(const MuscleLines::Member& member, std::size_t to) {
  if (to >= member.path.size()) return false;
  const MuscleLines::Point &a = member.path[to - 1], &b = member.path[to];
  return a.hold == PathHold::fixed && b.hold == PathHold::fixed && a.bone == b.bone;
}

}  // namespace
}  // namespace mobil::inline v0_3
#endif

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace {

constexpr float knots_a_radian = 57.2957795F / static_cast<float>(knee_knot_deg);

/// A block of legs in the frames of their knees. Points of the thigh are scaled but not rotated, points of the shank
/// are rotated only about x, and edges of both run along x.
struct Knees {
  WideVec hip, rolled, ankle, pelvis_x;
  WideVec pelvis[3], foot[3];  // axes, scaled by the size of the leg
  Wide sine, cosine, knots, cube[knee_knots];
  Wide across, thigh, shank;

  HWY_INLINE WideVec track(const MuscleLines::Track& of) const {
    WideVec at = fma(knots, wide(of.slope), wide(of.at_zero));
    for (std::size_t k = 0; k < knee_knots; ++k) at = fma(cube[k], wide(of.cubic[k]), at);
    return at;
  }
  HWY_INLINE WideVec turned_by_flexion(const WideVec& v) const {
    return {v.x, fnma(sine, v.z, cosine * v.y), fma(sine, v.y, cosine * v.z)};
  }
  HWY_INLINE WideVec place(LegBone bone, const WideVec& at) const {
    switch (bone) {
      case LegBone::pelvis:
        return fma(at.x, pelvis[0], fma(at.y, pelvis[1], fma(at.z, pelvis[2], hip)));
      case LegBone::thigh:
        return {fma(across, at.x, hip.x), fma(thigh, at.y, hip.y), fma(across, at.z, hip.z)};
      case LegBone::shank:
        return rolled + turned_by_flexion({across * at.x, shank * at.y, across * at.z});
      default:
        return fma(at.x, foot[0], fma(at.y, foot[1], fma(at.z, foot[2], ankle)));
    }
  }
  HWY_INLINE WideVec place(const MuscleLines::Point& point) const { return place(point.bone, wide(point.at_m)); }
};

HWY_INLINE WideVec times(const Wide& s, const WideVec& v) {
  return {s * v.x, s * v.y, s * v.z};
}

HWY_NOINLINE Knees load_knees(const MuscleLines::Track& rolling, const LegScale<Lanes<float>>& scale,
                              const KneeFrame<Lanes<float>>& leg) {
  Knees k;
  const Wide zero = wide(0.0F);
  k.across = load(scale.across), k.thigh = load(scale.thigh), k.shank = load(scale.shank);
  k.sine = load(leg.sine), k.cosine = load(leg.cosine);
  k.hip = load(leg.hip_m);
  k.pelvis_x = load(leg.pelvis[0]);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    k.pelvis[axis] = times(k.across, load(leg.pelvis[axis]));
    k.foot[axis] = times(k.across, load(leg.foot[axis]));
  }
  k.knots = load(leg.flexion_rad) * wide(knots_a_radian);
  for (std::size_t i = 0; i < knee_knots; ++i) {
    const Wide past = max(k.knots - wide(static_cast<float>(i)), zero);
    k.cube[i] = past * past * past;
  }
  const WideVec by = k.track(rolling);
  k.rolled = k.turned_by_flexion({zero, k.across * by.y, k.across * by.z});
  k.ankle = load(leg.ankle_m) + k.rolled;
  return k;
}

/// Returns the part of a member's length that the joints change.
HWY_NOINLINE Wide changing_length(const Knees& knees, const MuscleLines::Member& member) {
  const std::size_t points = member.path.size(), corners = member.on_kneecap ? points : points - 1;
  const WideVec end =
      member.on_kneecap ? knees.place(LegBone::shank, knees.track(member.kneecap)) : knees.place(member.path.back());
  Wide sum = wide(0.0F);
  WideVec at = knees.place(member.path.front());
  for (std::size_t i = 1; i < corners; ++i) {
    const MuscleLines::Point& point = member.path[i];
    WideVec next = knees.place(point);
    if (point.hold == PathHold::fixed) {
      if (!is_constant(member, i)) sum = sum + length(next - at);
    } else {
      const WideVec to = point.straight_to < corners ? knees.place(member.path[point.straight_to]) : end;
      if (point.bone == LegBone::pelvis) {
        const Touch touch = over_edge(at, to, next, knees.pelvis_x, point);
        next = select(touch.touched, touch.at, at);
        sum = sum + length(next - at);
        at = next;
        continue;
      }
      const WideVec a = at - next, b = to - next;
      const Wide turn = fnma(a.z, b.y, a.y * b.z);
      const Wide near = sqrt(fma(a.y, a.y, a.z * a.z)), far = sqrt(fma(b.y, b.y, b.z * b.z));
      const Wide slide = fma(a.x, far, b.x * near) / max(near + far, wide(1e-9F));
      const WideMask touched = point.hold == PathHold::front ? turn < 0.0F : turn > 0.0F;
      next = {select(touched, next.x + slide, at.x), select(touched, next.y, at.y), select(touched, next.z, at.z)};
      sum = sum + length(next - at);
    }
    at = next;
  }
  return is_constant(member, corners) ? sum : sum + length(end - at);
}

void elongate(std::span<const ElongatedLine> muscles, const LegScale<Lanes<float>>& scale,
              const KneeFrame<Lanes<float>>& leg) {
  if (muscles.empty()) return;
  const Knees knees = load_knees(muscles.front().lines->rolling, scale, leg);
  for (const ElongatedLine& muscle : muscles) {
    Wide mean = -load(*muscle.slack_m);
    for (const MuscleLines::Member& member : muscle.lines->members)
      mean = fma(wide(member.weight), changing_length(knees, member), mean);
    store(mean, *muscle.elongation_m);
  }
}

}  // namespace
}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <array>
#include <cmath>

namespace mobil::inline v0_3 {
namespace {
HWY_EXPORT(elongate);
}  // namespace

const MuscleLines& lines_of(Muscle muscle) {
  static const std::vector<MuscleLines> all = [] {
    std::vector<MuscleLines> made;
    for (std::size_t m = 0; m < muscles().size(); ++m) made.push_back(make_muscle_lines(static_cast<Muscle>(m)));
    return made;
  }();
  return all[static_cast<std::size_t>(muscle)];
}

double constant_length_m(const MuscleLines& lines, const LegScale<float>& scale) {
  const auto along = [&](LegBone bone) {
    return double{bone == LegBone::thigh ? scale.thigh : bone == LegBone::shank ? scale.shank : scale.across};
  };
  const double across = double{scale.across};
  double sum = 0;
  for (const MuscleLines::Member& member : lines.members) {
    double own = 0;
    for (std::size_t i = 1; i < member.path.size(); ++i) {
      if (!is_constant(member, i)) continue;
      const Vec3<float>&a = member.path[i - 1].at_m, &b = member.path[i].at_m;
      own += std::hypot(across * (double{a.x} - double{b.x}), along(member.path[i].bone) * (double{a.y} - double{b.y}),
                        across * (double{a.z} - double{b.z}));
    }
    sum += double{member.weight} * own;
  }
  return sum;
}

void elongations(std::span<const ElongatedLine> muscles, const LegScale<Lanes<float>>& scale,
                 const KneeFrame<Lanes<float>>& leg) {
  HWY_DYNAMIC_DISPATCH(elongate)(muscles, scale, leg);
}

}  // namespace mobil::inline v0_3
#endif
