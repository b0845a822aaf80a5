#include "systems/lines/line_of_action.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include <algorithm>

#include "systems/lines/leg_path-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace {

HWY_INLINE Wide path_length(const Leg& leg, const MuscleLines::Member& member, const WideVec& end) {
  Wide sum = wide(0.0F);
  along_path(leg, member, end, [&sum](const WideVec& from, const WideVec& to, LegBone, const WideMask*) HWY_ATTR {
    sum = sum + length(to - from);
  });
  return sum;
}

/// Returns a point of a path relative to the drawn bones, without the rolling of the knee.
HWY_INLINE WideVec unrolled(const Leg& leg, LegBone bone, const WideVec& at) {
  return bone < LegBone::shank ? at : at - leg.rolled;
}

constexpr std::size_t fetched_lines = 40;  // of each prefetched item

/// Writes `line` and returns the elongation L − L₀.
Wide act(const MuscleLines& lines, const LegScale<Lanes<float>>& scale, const LegFrames<Lanes<float>>& legs,
         LineOfAction<Lanes<float>>& line, Lanes<float>* member_m, std::span<FetchAhead> ahead) {
  const std::size_t lines_each = fetched_lines / std::max<std::size_t>(1, lines.members.size()) + 1;
  const Leg leg = load_leg(lines, scale, legs);
  Wide mean = wide(0.0F);
  WideVec target = leg.knee;
  for (std::size_t m = 0; m < lines.members.size(); ++m) {
    for (FetchAhead& some : ahead) some.fetch(lines_each);
    const MuscleLines::Member& member = lines.members[m];
    const WideVec end = path_end(leg, member);
    const Wide along = path_length(leg, member, end);
    mean = fma(wide(member.weight), along, mean);
    if (member_m != nullptr) store(along, member_m[m]);
    if (m != lines.towards) continue;
    target = lines.point < member.path.size()
                 ? unrolled(leg, member.path[lines.point].bone, place(leg, member.path[lines.point]))
                 : unrolled(leg, end_bone(member), end);
  }
  const Wide elongation = mean - load(line.rest_length_m);
  store(mean, line.length_m);
  store(-(load(line.stiffness_n_per_m) * elongation), line.force_n);

  const WideVec anchor = unrolled(leg, lines.anchor.bone, place(leg, lines.anchor));
  const WideVec span = target - anchor;
  const Wide reach = length(span);
  const WideVec z{span.x / reach, span.y / reach, span.z / reach};
  const auto along_bone = static_cast<std::size_t>(lines.along);
  store(leg.knee + fma(wide(lines.start_m) * leg.y_scale[along_bone], z, anchor), line.start_m);

  // The smallest rotation from the bone's −y to z, after the rotation of the muscle's axes to those of the bone.
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

/// Sets `from` to the last `to`, or to the new value where the line had no length yet.
HWY_INLINE void follow(const WideMask& first, const Wide& now, Lanes<float>& from, Lanes<float>& to) {
  store(select(first, now, load(to)), from);
  store(now, to);
}

}  // namespace

void act_on_end(const MuscleLines& lines, const LegScale<Lanes<float>>& scale, const LegFrames<Lanes<float>>& legs,
                FarEnd far_end, LineOfAction<Lanes<float>>& line, EndDrive<Lanes<float>>& end, Lanes<float>* member_m,
                std::span<FetchAhead> ahead) {
  const WideMask first = load(line.length_m) <= wide(0.0F);
  const Wide elongation = act(lines, scale, legs, line, member_m, ahead);
  if (far_end == FarEnd::held) {
    follow(first, elongation, end.from, end.to);
  } else {
    follow(first, load(line.stiffness_n_per_m) * elongation, end.from, end.to);
  }
}

using Four = hn::Full128<float>;

/// Transposes four rows of four words.
HWY_INLINE void turn(hn::Vec<Four> (&v)[4]) {
  const Four d;
  const auto low = hn::InterleaveLower(d, v[0], v[1]), high = hn::InterleaveUpper(d, v[0], v[1]);
  const auto low2 = hn::InterleaveLower(d, v[2], v[3]), high2 = hn::InterleaveUpper(d, v[2], v[3]);
  v[0] = hn::ConcatLowerLower(d, low2, low);
  v[1] = hn::ConcatUpperUpper(d, low2, low);
  v[2] = hn::ConcatLowerLower(d, high2, high);
  v[3] = hn::ConcatUpperUpper(d, high2, high);
}

constexpr std::size_t leg_words = sizeof(LegFrames<float>) / sizeof(float);
static_assert(sizeof(PublishedLeg::Leg) >= 4 * ((leg_words + 3) / 4) * sizeof(float));
// Copying in fours also writes zeros to the leg's clock, so people who do not walk count as standing.
static_assert(offsetof(PublishedLeg::Leg, clock) == 4 * leg_words && leg_words % 4 == 1);

void gather_rows(const PublishedLeg::Leg* const (&from)[lane_count], LegFrames<Lanes<float>>& legs) {
  const Four d;
  auto* const to = reinterpret_cast<float*>(&legs);
  for (std::size_t lane = 0; lane < lane_count; lane += 4) {
    for (std::size_t w = 0; w < leg_words; w += 4) {
      hn::Vec<Four> v[4];
      for (std::size_t i = 0; i < 4; ++i) v[i] = hn::Load(d, reinterpret_cast<const float*>(from[lane + i]) + w);
      turn(v);
      for (std::size_t i = 0; i < 4 && w + i < leg_words; ++i) hn::Store(v[i], d, to + (w + i) * lane_count + lane);
    }
  }
}

void scatter_rows(const LegFrames<Lanes<float>>& legs, Side side, PublishedLeg* posts) {
  const Four d;
  const auto* const from = reinterpret_cast<const float*>(&legs);
  for (std::size_t lane = 0; lane < lane_count; lane += 4) {
    for (std::size_t w = 0; w < leg_words; w += 4) {
      hn::Vec<Four> v[4];
      for (std::size_t i = 0; i < 4; ++i)
        v[i] = w + i < leg_words ? hn::Load(d, from + (w + i) * lane_count + lane) : hn::Zero(d);
      turn(v);
      for (std::size_t i = 0; i < 4; ++i) hn::Store(v[i], d, reinterpret_cast<float*>(&posts[lane + i].leg[side]) + w);
    }
  }
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <mobil/components/segments.h>
#include "engine/fetch_ahead.h"

namespace mobil::inline v0_3 {
namespace {

HWY_EXPORT(act_on_end);
HWY_EXPORT(gather_rows);
HWY_EXPORT(scatter_rows);

/// `word(i)` returns word i of a pose. put(f, x, sign) stores sign·x in f.
template <class Word, class F, class Put>
void gather(Word word, Side side, LegFrames<F>& legs, Put put) {
  const float mirror = side == Side::left ? -1.0F : 1.0F;
  const auto position = [&](Segment right_segment, Vec3<F>& to) {
    const std::size_t at = 3 * index(on_side(right_segment, side));
    put(to.x, word(at), mirror);
    put(to.y, word(at + 1), 1.0F);
    put(to.z, word(at + 2), 1.0F);
  };
  const auto rotation = [&](Segment segment, Quat<F>& to) {
    const std::size_t at = 3 * segment_count + 4 * index(segment);
    put(to.x, word(at), 1.0F);
    put(to.y, word(at + 1), mirror);
    put(to.z, word(at + 2), mirror);
    put(to.w, word(at + 3), 1.0F);
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

void gather_leg(const float* pose, Side side, LegFrames<Lanes<float>>& legs, std::size_t lane) {
  gather([pose](std::size_t i) { return pose[i * lane_count]; }, side, legs,
         [lane](Lanes<float>& to, float x, float sign) { to[lane] = sign * x; });
}

void post_legs(const Pose<Lanes<float>>& pose, const Pose<Lanes<float>>* next, PublishedLeg* posts) {
  const auto *words = reinterpret_cast<const Lanes<float>*>(&pose),
             *ahead = reinterpret_cast<const Lanes<float>*>(next);
  const auto word = [words, ahead](std::size_t i) -> const Lanes<float>& {
    if (ahead != nullptr) FetchAhead(ahead + i).fetch(1);
    return words[i];
  };
  for (const Side side : {Side::right, Side::left}) {
    LegFrames<Lanes<float>> legs;
    gather(word, side, legs, [](Lanes<float>& to, const Lanes<float>& x, float sign) {
      for (std::size_t lane = 0; lane < lane_count; ++lane) to[lane] = sign * x[lane];
    });
    HWY_DYNAMIC_DISPATCH(scatter_rows)(legs, side, posts);
  }
}

void take_legs(const PublishedLeg::Leg* const (&from)[lane_count], LegFrames<Lanes<float>>& legs) {
  HWY_DYNAMIC_DISPATCH(gather_rows)(from, legs);
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
  gather(word, side, legs, [lane](Lanes<float>& to, float x, float sign) { to[lane] = sign * x; });
}

void lines_of_action(const MuscleLines& lines, const LegScale<Lanes<float>>& scale, const LegFrames<Lanes<float>>& legs,
                     FarEnd far_end, LineOfAction<Lanes<float>>& line, EndDrive<Lanes<float>>& end,
                     Lanes<float>* member_m, std::span<FetchAhead> ahead) {
  HWY_DYNAMIC_DISPATCH(act_on_end)(lines, scale, legs, far_end, line, end, member_m, ahead);
}

}  // namespace mobil::inline v0_3
#endif
