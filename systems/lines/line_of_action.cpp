#include "systems/lines/line_of_action.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/lines/line_of_action.cpp"
#include <hwy/foreach_target.h>

#include "engine/wide-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {
namespace {

struct Vec {
  Wide x, y, z;
};
struct Rotation {
  Wide x, y, z, w;
};

HWY_INLINE Vec operator+(const Vec& a, const Vec& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
HWY_INLINE Vec operator-(const Vec& a, const Vec& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
HWY_INLINE Wide dot(const Vec& a, const Vec& b) {
  return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z));
}
HWY_INLINE Vec cross(const Vec& a, const Vec& b) {
  return {fnma(a.z, b.y, a.y * b.z), fnma(a.x, b.z, a.z * b.x), fnma(a.y, b.x, a.x * b.y)};
}
HWY_INLINE Wide length(const Vec& a) {
  return sqrt(dot(a, a));
}
/// a + s·b
HWY_INLINE Vec along(const Vec& a, const Wide& s, const Vec& b) {
  return {fma(s, b.x, a.x), fma(s, b.y, a.y), fma(s, b.z, a.z)};
}
HWY_INLINE Vec load(const Vec3<Lanes<float>>& v) {
  return {HWY_NAMESPACE::load(v.x), HWY_NAMESPACE::load(v.y), HWY_NAMESPACE::load(v.z)};
}
HWY_INLINE Vec wide(const Vec3<float>& v) {
  return {HWY_NAMESPACE::wide(v.x), HWY_NAMESPACE::wide(v.y), HWY_NAMESPACE::wide(v.z)};
}
HWY_INLINE Rotation load(const Quat<Lanes<float>>& q) {
  return {HWY_NAMESPACE::load(q.x), HWY_NAMESPACE::load(q.y), HWY_NAMESPACE::load(q.z), HWY_NAMESPACE::load(q.w)};
}

/// First b, then a.
HWY_INLINE Rotation operator*(const Rotation& a, const Rotation& b) {
  return {fma(a.w, b.x, fma(a.x, b.w, fnma(a.z, b.y, a.y * b.z))),
          fma(a.w, b.y, fma(a.y, b.w, fnma(a.x, b.z, a.z * b.x))),
          fma(a.w, b.z, fma(a.z, b.w, fnma(a.y, b.x, a.x * b.y))),
          fnma(a.z, b.z, fnma(a.y, b.y, fnma(a.x, b.x, a.w * b.w)))};
}
/// v + 2 (w t + q × t), t = q × v.
HWY_INLINE Vec rotate(const Rotation& q, const Vec& v) {
  const Vec axis{q.x, q.y, q.z};
  Vec t = cross(axis, v);
  t = t + t;
  return along(v, q.w, t) + cross(axis, t);
}

/// Angle about x of the shank's rotation in the thigh's frame.
HWY_INLINE Wide knee_flexion(const Rotation& thigh, const Rotation& shank) {
  const Rotation q = Rotation{-thigh.x, -thigh.y, -thigh.z, thigh.w} * shank;
  const WideMask other_sign = q.w < HWY_NAMESPACE::wide(0.0F);
  return HWY_NAMESPACE::wide(2.0F) * atan2(select(other_sign, -q.x, q.x), abs(q.w));
}

HWY_INLINE Wide smoothstep(float from, float width, const Wide& x) {
  const Wide t = clamp((x - HWY_NAMESPACE::wide(from)) * HWY_NAMESPACE::wide(1 / width), 0.0F, 1.0F);
  return t * t * fnma(t, HWY_NAMESPACE::wide(2.0F), HWY_NAMESPACE::wide(3.0F));
}

constexpr float degree = 0.0174532925F;
constexpr auto blend = static_cast<float>(path_blend_deg) * degree;

/// A block of legs; places relative to the knee, so that a walk far from the origin loses no digits.
struct Leg {
  Vec origin[4];
  Rotation rotation[4];
  Wide y_scale[4], across;
  Vec knee;
  Wide flexion;
};

HWY_INLINE Leg load_leg(const LegScale<Lanes<float>>& scale, const LegFrames<Lanes<float>>& legs) {
  Leg leg;
  leg.knee = load(legs.knee_m);
  const Vec hip = load(legs.hip_m) - leg.knee, ankle = load(legs.ankle_m) - leg.knee;
  const Wide zero = HWY_NAMESPACE::wide(0.0F);
  leg.origin[0] = leg.origin[1] = hip;
  leg.origin[2] = {zero, zero, zero};
  leg.origin[3] = ankle;
  leg.rotation[0] = load(legs.pelvis);
  leg.rotation[1] = load(legs.thigh);
  leg.rotation[2] = load(legs.shank);
  leg.rotation[3] = load(legs.foot);
  leg.across = HWY_NAMESPACE::load(scale.across);
  leg.y_scale[0] = leg.y_scale[3] = leg.across;
  leg.y_scale[1] = HWY_NAMESPACE::load(scale.thigh);
  leg.y_scale[2] = HWY_NAMESPACE::load(scale.shank);
  leg.flexion = knee_flexion(leg.rotation[1], leg.rotation[2]);
  return leg;
}

HWY_INLINE Vec place(const Leg& leg, LegBone bone, const Vec& at) {
  const auto b = static_cast<std::size_t>(bone);
  return leg.origin[b] + rotate(leg.rotation[b], {leg.across * at.x, leg.y_scale[b] * at.y, leg.across * at.z});
}

HWY_INLINE Vec place(const Leg& leg, const MuscleLines::Point& point) {
  return place(leg, point.bone, wide(point.at_m));
}

HWY_INLINE Vec kneecap(const Leg& leg, const MuscleLines::Member& member) {
  const Wide u = leg.flexion * HWY_NAMESPACE::wide(1 / (static_cast<float>(kneecap_knot_deg) * degree));
  Vec at = along(wide(member.kneecap_at_zero), u, wide(member.kneecap_slope));
  for (std::size_t k = 0; k < kneecap_knots; ++k) {
    const Wide d = max(u - HWY_NAMESPACE::wide(static_cast<float>(k)), HWY_NAMESPACE::wide(0.0F));
    at = along(at, d * d * d, wide(member.kneecap_cubic[k]));
  }
  return place(leg, LegBone::shank, at);
}

HWY_INLINE Vec path_end(const Leg& leg, const MuscleLines::Member& member) {
  return member.on_kneecap ? kneecap(leg, member) : place(leg, member.path.back());
}

HWY_INLINE Wide path_length(const Leg& leg, const MuscleLines::Member& member, const Vec& end) {
  Vec at = place(leg, member.path.front());
  Wide sum = HWY_NAMESPACE::wide(0.0F);
  const std::size_t points = member.path.size();
  for (std::size_t i = 1; i < points; ++i) {
    const MuscleLines::Point& point = member.path[i];
    Vec next = place(leg, point);
    if (point.straight_to > 0) {
      const Vec line = (point.straight_to < points ? place(leg, member.path[point.straight_to]) : end) - at;
      const Wide t = clamp(dot(next - at, line) / max(dot(line, line), HWY_NAMESPACE::wide(1e-12F)), 0.0F, 1.0F);
      const Wide share = smoothstep(point.from_rad, 2 * blend, leg.flexion) *
                         (HWY_NAMESPACE::wide(1.0F) - smoothstep(point.to_rad, 2 * blend, leg.flexion));
      const Vec straight = along(at, t, line);
      next = along(straight, share, next - straight);
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
  Wide mean = HWY_NAMESPACE::wide(0.0F);
  Vec target = leg.knee;
  for (std::size_t m = 0; m < lines.members.size(); ++m) {
    const MuscleLines::Member& member = lines.members[m];
    const Vec end = path_end(leg, member);
    mean = fma(HWY_NAMESPACE::wide(member.weight), path_length(leg, member, end), mean);
    if (m == lines.towards) target = end;
  }
  const Wide elongation = mean - HWY_NAMESPACE::load(line.rest_length_m);
  store(mean, line.length_m);
  store(-(HWY_NAMESPACE::load(line.stiffness_n_per_m) * elongation), line.force_n);

  const Vec anchor = place(leg, lines.anchor);
  const Vec span = target - anchor;
  const Wide reach = length(span);
  const Vec z{span.x / reach, span.y / reach, span.z / reach};
  const auto along_bone = static_cast<std::size_t>(lines.along);
  const Vec start = leg.knee + along(anchor, HWY_NAMESPACE::wide(lines.start_m) * leg.y_scale[along_bone], z);
  store(start.x, line.start_m.x);
  store(start.y, line.start_m.y);
  store(start.z, line.start_m.z);

  // The smallest turn from the bone's −y to z, after the turn that lays the muscle's axes on the bone's.
  const Wide zero = HWY_NAMESPACE::wide(0.0F), one = HWY_NAMESPACE::wide(1.0F);
  const Wide half = HWY_NAMESPACE::wide(0.70710678F);
  const Rotation& bone = leg.rotation[static_cast<std::size_t>(lines.anchor.bone)];
  const Vec down = rotate(bone, {zero, -one, zero});
  const Vec axis = cross(down, z);
  const Wide w = one + dot(down, z);
  const Wide norm = sqrt(fma(w, w, dot(axis, axis)));
  const Rotation q =
      Rotation{axis.x / norm, axis.y / norm, axis.z / norm, w / norm} * (bone * Rotation{half, zero, zero, half});
  store(q.x, line.rotation.x);
  store(q.y, line.rotation.y);
  store(q.z, line.rotation.z);
  store(q.w, line.rotation.w);
  return elongation;
}

/// from: the last `to`, or this one's where the line had no length yet.
HWY_INLINE void follow(const WideMask& first, const Wide& now, Lanes<float>& from, Lanes<float>& to) {
  store(select(first, now, HWY_NAMESPACE::load(to)), from);
  store(now, to);
}

}  // namespace

void act_by_displacement(const MuscleLines& lines, const LegScale<Lanes<float>>& scale,
                         const LegFrames<Lanes<float>>& legs, LineOfAction<Lanes<float>>& line,
                         EndDisplacement<Lanes<float>>& end) {
  const WideMask first = HWY_NAMESPACE::load(line.length_m) <= HWY_NAMESPACE::wide(0.0F);
  const Wide elongation = act(lines, scale, legs, line);
  follow(first, elongation, end.from_m, end.to_m);
}

void act_by_force(const MuscleLines& lines, const LegScale<Lanes<float>>& scale, const LegFrames<Lanes<float>>& legs,
                  LineOfAction<Lanes<float>>& line, EndForce<Lanes<float>>& end) {
  const WideMask first = HWY_NAMESPACE::load(line.length_m) <= HWY_NAMESPACE::wide(0.0F);
  const Wide elongation = act(lines, scale, legs, line);
  follow(first, HWY_NAMESPACE::load(line.stiffness_n_per_m) * elongation, end.from_n, end.to_n);
}

void flexions(const LegFrames<Lanes<float>>& legs, Lanes<float>& flexion_rad) {
  store(knee_flexion(load(legs.thigh), load(legs.shank)), flexion_rad);
}

}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <algorithm>
#include <array>
#include <iterator>
#include <numbers>

#include "assets/muscle_plan.h"
#include "components/segments.h"

namespace mobil {
namespace {

HWY_EXPORT(act_by_displacement);
HWY_EXPORT(act_by_force);
HWY_EXPORT(flexions);

Vec3<float> to_float(const Vec3<double>& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

bool always(const PathPoint& p) {
  return p.from_deg <= -180 && p.to_deg >= 180;
}

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
    const auto next = std::find_if(muscle.path.begin() + static_cast<std::ptrdiff_t>(i) + 1, muscle.path.end(), always);
    const auto straight_to = static_cast<std::size_t>(next - muscle.path.begin());
    m.path.push_back(point(muscle.path[i], always(muscle.path[i]) ? 0 : straight_to));
  }
  if (!m.on_kneecap) return m;
  const KneecapSpline spline = kneecap_spline(*muscle.kneecap);
  m.kneecap_at_zero = to_float(spline.at_zero);
  m.kneecap_slope = to_float(spline.slope);
  std::transform(spline.cubic.begin(), spline.cubic.end(), m.kneecap_cubic, to_float);
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

MuscleLines make_muscle_lines(MuscleGroup group) {
  const GroupLine& drawn = group_line(group);
  MuscleLines lines{{}, point(drawn.anchor), 0, drawn.along, static_cast<float>(drawn.start_m)};
  for (const auto& muscle : members_of(group)) {
    if (muscle.name == drawn.towards) lines.towards = lines.members.size();
    lines.members.push_back(member(muscle, member_weight(muscle)));
  }
  return lines;
}

MuscleLines make_muscle_lines(const MemberMuscle& muscle) {
  return {{member(muscle, 1)}, point(muscle.path.front()), 0, muscle.path.front().bone, 0};
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
