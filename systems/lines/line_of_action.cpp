#include "systems/lines/line_of_action.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/lines/line_of_action.cpp"
#include <hwy/foreach_target.h>

#include "engine/wide_geometry-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {
namespace {

/// Angle about x of the shank's rotation in the thigh's frame.
HWY_INLINE Wide knee_flexion(const WideQuat& thigh, const WideQuat& shank) {
  const WideQuat q = WideQuat{-thigh.x, -thigh.y, -thigh.z, thigh.w} * shank;
  const WideMask other_sign = q.w < wide(0.0F);
  return wide(2.0F) * atan2(select(other_sign, -q.x, q.x), abs(q.w));
}

HWY_INLINE Wide smoothstep(float from, float width, const Wide& x) {
  const Wide t = clamp((x - wide(from)) * wide(1 / width), 0.0F, 1.0F);
  return t * t * fnma(t, wide(2.0F), wide(3.0F));
}

constexpr float degree = 0.0174532925F;
constexpr auto blend = static_cast<float>(path_blend_deg) * degree;

/// A block of legs; places relative to the knee, so that a walk far from the origin loses no digits.
struct Leg {
  WideVec origin[4];
  WideQuat rotation[4];
  Wide y_scale[4], across;
  WideVec knee;
  Wide flexion;
};

HWY_INLINE Leg load_leg(const LegScale<Lanes<float>>& scale, const LegFrames<Lanes<float>>& legs) {
  Leg leg;
  leg.knee = load(legs.knee_m);
  const WideVec hip = load(legs.hip_m) - leg.knee, ankle = load(legs.ankle_m) - leg.knee;
  const Wide zero = wide(0.0F);
  leg.origin[0] = leg.origin[1] = hip;
  leg.origin[2] = {zero, zero, zero};
  leg.origin[3] = ankle;
  leg.rotation[0] = load(legs.pelvis);
  leg.rotation[1] = load(legs.thigh);
  leg.rotation[2] = load(legs.shank);
  leg.rotation[3] = load(legs.foot);
  leg.across = load(scale.across);
  leg.y_scale[0] = leg.y_scale[3] = leg.across;
  leg.y_scale[1] = load(scale.thigh);
  leg.y_scale[2] = load(scale.shank);
  leg.flexion = knee_flexion(leg.rotation[1], leg.rotation[2]);
  return leg;
}

HWY_INLINE WideVec place(const Leg& leg, LegBone bone, const WideVec& at) {
  const auto b = static_cast<std::size_t>(bone);
  return leg.origin[b] + rotate(leg.rotation[b], {leg.across * at.x, leg.y_scale[b] * at.y, leg.across * at.z});
}

HWY_INLINE WideVec place(const Leg& leg, const MuscleLines::Point& point) {
  return place(leg, point.bone, wide(point.at_m));
}

HWY_INLINE WideVec kneecap(const Leg& leg, const MuscleLines::Member& member) {
  const Wide u = leg.flexion * wide(1 / (static_cast<float>(kneecap_knot_deg) * degree));
  WideVec at = fma(u, wide(member.kneecap_slope), wide(member.kneecap_at_zero));
  for (std::size_t k = 0; k < kneecap_knots; ++k) {
    const Wide d = max(u - wide(static_cast<float>(k)), wide(0.0F));
    at = fma(d * d * d, wide(member.kneecap_cubic[k]), at);
  }
  return place(leg, LegBone::shank, at);
}

HWY_INLINE WideVec path_end(const Leg& leg, const MuscleLines::Member& member) {
  return member.on_kneecap ? kneecap(leg, member) : place(leg, member.path.back());
}

HWY_INLINE Wide path_length(const Leg& leg, const MuscleLines::Member& member, const WideVec& end) {
  WideVec at = place(leg, member.path.front());
  Wide sum = wide(0.0F);
  const std::size_t points = member.path.size();
  for (std::size_t i = 1; i < points; ++i) {
    const MuscleLines::Point& point = member.path[i];
    WideVec next = place(leg, point);
    if (point.straight_to > 0) {
      const WideVec line = (point.straight_to < points ? place(leg, member.path[point.straight_to]) : end) - at;
      const Wide t = clamp(dot(next - at, line) / max(dot(line, line), wide(1e-12F)), 0.0F, 1.0F);
      const Wide share = smoothstep(point.from_rad, 2 * blend, leg.flexion) *
                         (wide(1.0F) - smoothstep(point.to_rad, 2 * blend, leg.flexion));
      const WideVec straight = fma(t, line, at);
      next = fma(share, next - straight, straight);
    }
    sum = sum + length(next - at);
    at = next;
  }
  return member.on_kneecap ? sum + length(end - at) : sum;
}

/// Writes line; the elongation L − L₀.
Wide act(const MuscleLines& lines, const LegScale<Lanes<float>>& scale, const LegFrames<Lanes<float>>& legs,
         LineOfAction<Lanes<float>>& line) {
  const Leg leg = load_leg(scale, legs);
  Wide mean = wide(0.0F);
  WideVec target = leg.knee;
  for (std::size_t m = 0; m < lines.members.size(); ++m) {
    const MuscleLines::Member& member = lines.members[m];
    const WideVec end = path_end(leg, member);
    mean = fma(wide(member.weight), path_length(leg, member, end), mean);
    if (m == lines.towards) target = lines.point < member.path.size() ? place(leg, member.path[lines.point]) : end;
  }
  const Wide elongation = mean - load(line.rest_length_m);
  store(mean, line.length_m);
  store(-(load(line.stiffness_n_per_m) * elongation), line.force_n);

  const WideVec anchor = place(leg, lines.anchor);
  const WideVec span = target - anchor;
  const Wide reach = length(span);
  const WideVec z{span.x / reach, span.y / reach, span.z / reach};
  const auto along_bone = static_cast<std::size_t>(lines.along);
  store(leg.knee + fma(wide(lines.start_m) * leg.y_scale[along_bone], z, anchor), line.start_m);

  // The smallest turn from the bone's −y to z, after the turn that lays the muscle's axes on the bone's.
  const Wide zero = wide(0.0F), one = wide(1.0F);
  const Wide half = wide(0.70710678F);
  const WideQuat& bone = leg.rotation[static_cast<std::size_t>(lines.anchor.bone)];
  const WideVec down = rotate(bone, {zero, -one, zero});
  const WideVec axis = cross(down, z);
  const Wide w = one + dot(down, z);
  const Wide norm = sqrt(fma(w, w, dot(axis, axis)));
  store(WideQuat{axis.x / norm, axis.y / norm, axis.z / norm, w / norm} * (bone * WideQuat{half, zero, zero, half}),
        line.rotation);
  return elongation;
}

/// from: the last `to`, or this one's where the line had no length yet.
HWY_INLINE void follow(const WideMask& first, const Wide& now, Lanes<float>& from, Lanes<float>& to) {
  store(select(first, now, load(to)), from);
  store(now, to);
}

}  // namespace

void act_by_displacement(const MuscleLines& lines, const LegScale<Lanes<float>>& scale,
                         const LegFrames<Lanes<float>>& legs, LineOfAction<Lanes<float>>& line,
                         EndDisplacement<Lanes<float>>& end) {
  const WideMask first = load(line.length_m) <= wide(0.0F);
  const Wide elongation = act(lines, scale, legs, line);
  follow(first, elongation, end.from_m, end.to_m);
}

void act_by_force(const MuscleLines& lines, const LegScale<Lanes<float>>& scale, const LegFrames<Lanes<float>>& legs,
                  LineOfAction<Lanes<float>>& line, EndForce<Lanes<float>>& end) {
  const WideMask first = load(line.length_m) <= wide(0.0F);
  const Wide elongation = act(lines, scale, legs, line);
  follow(first, load(line.stiffness_n_per_m) * elongation, end.from_n, end.to_n);
}

void flexions(const LegFrames<Lanes<float>>& legs, Lanes<float>& flexion_rad) {
  store(knee_flexion(load(legs.thigh), load(legs.shank)), flexion_rad);
}

}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <algorithm>
#include <iterator>
#include <numbers>

#include "assets/muscle_path.h"
#include "components/segments.h"
#include "engine/geometry.h"

namespace mobil {
namespace {

HWY_EXPORT(act_by_displacement);
HWY_EXPORT(act_by_force);
HWY_EXPORT(flexions);

using geometry::to_float;

MuscleLines::Point point(const PathPoint& p, std::size_t straight_to = 0) {
  // Far outside any angle where there is no limit.
  const auto rad = [](double deg) {
    const double limit = deg <= -180 ? -1000 : deg >= 180 ? 1000 : deg - path_blend_deg;
    return static_cast<float>(limit * std::numbers::pi / 180);
  };
  return {p.bone, to_float(p.at_m), straight_to, rad(p.from_deg), rad(p.to_deg)};
}

MuscleLines::Member member(const MemberMuscle& muscle, double weight) {
  MuscleLines::Member m{};
  m.weight = static_cast<float>(weight);
  m.on_kneecap = muscle.kneecap != nullptr;
  for (std::size_t i = 0; i < muscle.path.size(); ++i) {
    const auto next =
        std::find_if(muscle.path.begin() + static_cast<std::ptrdiff_t>(i) + 1, muscle.path.end(), bends_always);
    const auto straight_to = static_cast<std::size_t>(next - muscle.path.begin());
    m.path.push_back(point(muscle.path[i], bends_always(muscle.path[i]) ? 0 : straight_to));
  }
  if (!m.on_kneecap) return m;
  const KneecapSpline spline = kneecap_spline(*muscle.kneecap);
  m.kneecap_at_zero = to_float(spline.at_zero);
  m.kneecap_slope = to_float(spline.slope);
  for (std::size_t k = 0; k < kneecap_knots; ++k) m.kneecap_cubic[k] = to_float(spline.cubic[k]);
  return m;
}

/// `word(i)` is the i-th of a pose's floats.
template <class Word>
void gather(Word word, Side side, LegFrames<Lanes<float>>& legs, std::size_t lane) {
  const float mirror = side == left ? -1.0F : 1.0F;
  const auto position = [&](Segment right_segment, Vec3<Lanes<float>>& to) {
    const std::size_t at = 3 * index(on_side(right_segment, side));
    to.x[lane] = mirror * word(at);
    to.y[lane] = word(at + 1);
    to.z[lane] = word(at + 2);
  };
  const auto rotation = [&](Segment segment, Quat<Lanes<float>>& to) {
    const std::size_t at = 3 * segment_count + 4 * index(segment);
    to.x[lane] = word(at);
    to.y[lane] = mirror * word(at + 1);
    to.z[lane] = mirror * word(at + 2);
    to.w[lane] = word(at + 3);
  };
  position(Segment::thigh_right, legs.hip_m);
  position(Segment::shank_right, legs.knee_m);
  position(Segment::foot_right, legs.ankle_m);
  rotation(Segment::pelvis, legs.pelvis);
  rotation(on_side(Segment::thigh_right, side), legs.thigh);
  rotation(on_side(Segment::shank_right, side), legs.shank);
  rotation(on_side(Segment::foot_right, side), legs.foot);
}

}  // namespace

MuscleLines make_muscle_lines(Muscle muscle) {
  const MuscleRow& row = muscle_row(muscle);
  const DrawnLine& drawn = row.drawn;
  MuscleLines lines{{},          point(drawn.anchor), drawn.towards,
                    drawn.point, drawn.along,         static_cast<float>(drawn.start_m)};
  for (const auto& m : row.members) lines.members.push_back(member(m, member_weight(row.members, m)));
  return lines;
}

void gather_leg(const float* pose, Side side, LegFrames<Lanes<float>>& legs, std::size_t lane) {
  gather([pose](std::size_t i) { return pose[i * lane_count]; }, side, legs, lane);
}

void gather_leg(const Pose<float>& pose, Side side, LegFrames<Lanes<float>>& legs, std::size_t lane) {
  static_assert(sizeof(Pose<float>) == 7 * segment_count * sizeof(float));
  const auto word = [&pose](std::size_t i) {
    if (i < 3 * segment_count) {
      const Vec3<float>& p = pose.position_m[i / 3];
      return i % 3 == 0 ? p.x : i % 3 == 1 ? p.y : p.z;
    }
    const Quat<float>& q = pose.rotation[(i - 3 * segment_count) / 4];
    const std::size_t part = (i - 3 * segment_count) % 4;
    return part == 0 ? q.x : part == 1 ? q.y : part == 2 ? q.z : q.w;
  };
  gather(word, side, legs, lane);
}

void lines_of_action(const MuscleLines& lines, const LegScale<Lanes<float>>& scale, const LegFrames<Lanes<float>>& legs,
                     LineOfAction<Lanes<float>>& line, EndDisplacement<Lanes<float>>& end) {
  HWY_DYNAMIC_DISPATCH(act_by_displacement)(lines, scale, legs, line, end);
}

void lines_of_action(const MuscleLines& lines, const LegScale<Lanes<float>>& scale, const LegFrames<Lanes<float>>& legs,
                     LineOfAction<Lanes<float>>& line, EndForce<Lanes<float>>& end) {
  HWY_DYNAMIC_DISPATCH(act_by_force)(lines, scale, legs, line, end);
}

void knee_flexions(const LegFrames<Lanes<float>>& legs, Lanes<float>& flexion_rad) {
  HWY_DYNAMIC_DISPATCH(flexions)(legs, flexion_rad);
}

}  // namespace mobil
#endif
