#include "systems/lines/line_motion.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include "systems/lines/leg_path-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace {

enum Joint : std::size_t { hip, knee, ankle, joint_count };

constexpr bool is_distal(LegBone bone, std::size_t joint) {
  return static_cast<std::size_t>(bone) > joint;
}

/// Axes of positive flexion of the distal parts, and axis × centre, relative to the knee.
struct Joints {
  WideVec axis[joint_count], moment[joint_count];
  /// Displacement of shank and foot by the rolling of the knee, per radian of flexion.
  WideVec drift;
  Wide square[knee_knots];  // of a track's slope: 3·max(flexion / 20° − k, 0)²
};

HWY_INLINE WideVec negated(const WideVec& v) {
  return {-v.x, -v.y, -v.z};
}

/// Returns the displacement in the world, per radian of flexion, of a point on a track of the shank.
HWY_INLINE WideVec drift_of(const Leg& leg, const Joints& joints, const MuscleLines::Track& track,
                            const Wide& y_scale) {
  WideVec slope = wide(track.slope);
  for (std::size_t k = 0; k < knee_knots; ++k) slope = fma(joints.square[k], wide(track.cubic[k]), slope);
  const Wide rate = wide(knots_per_rad);
  return rotate(leg.rotation[2], {leg.across * rate * slope.x, y_scale * rate * slope.y, leg.across * rate * slope.z});
}

HWY_INLINE Joints find_joints(const Leg& leg, const MuscleLines& lines) {
  Joints joints;
  const Wide zero = wide(0.0F);
  joints.axis[hip] = negated(rotate(leg.rotation[0], {wide(1.0F), zero, zero}));
  joints.axis[knee] = leg.thigh_x;
  joints.axis[ankle] = negated(leg.shank_x);
  joints.moment[hip] = cross(joints.axis[hip], leg.origin[0]);
  joints.moment[knee] = {zero, zero, zero};
  joints.moment[ankle] = cross(joints.axis[ankle], leg.origin[3]);
  const Wide u = leg.flexion * wide(knots_per_rad);
  for (std::size_t k = 0; k < knee_knots; ++k) {
    const Wide d = max(u - wide(static_cast<float>(k)), zero);
    joints.square[k] = wide(3.0F) * d * d;
  }
  joints.drift = drift_of(leg, joints, lines.rolling, leg.across);
  return joints;
}

struct Arms {
  Wide of[joint_count];
};

HWY_INLINE Arms arms_of(const Leg& leg, const Joints& joints, const MuscleLines::Member& member) {
  const Wide zero = wide(0.0F);
  Arms arms{{zero, zero, zero}};
  Wide distal[joint_count];  // 1 where the path has passed the joint
  for (std::size_t j = 0; j < joint_count; ++j) {
    distal[j] = wide(is_distal(member.path.front().bone, j) ? 1.0F : 0.0F);
  }
  WideVec last{zero, zero, zero};
  along_path(leg, member, path_end(leg, member),
             [&](const WideVec& from, const WideVec& to, LegBone bone, const WideMask* there) HWY_ATTR {
               const WideVec d = to - from;
               const Wide shorten = wide(1.0F) / max(length(d), wide(1e-9F));
               const WideVec unit{shorten * d.x, shorten * d.y, shorten * d.z};
               const WideVec turn = cross(to, unit);
               for (std::size_t j = 0; j < joint_count; ++j) {
                 Wide passed = wide(is_distal(bone, j) ? 1.0F : 0.0F);
                 if (there != nullptr) passed = select(*there, passed, distal[j]);
                 Wide growth = dot(joints.axis[j], turn) - dot(joints.moment[j], unit);
                 if (j == knee) growth = growth + dot(joints.drift, unit);
                 arms.of[j] = fnma(passed - distal[j], growth, arms.of[j]);
                 distal[j] = passed;
               }
               last = unit;
             });
  if (member.on_kneecap) {
    arms.of[knee] = arms.of[knee] - dot(drift_of(leg, joints, member.kneecap, leg.y_scale[2]), last);
  }
  return arms;
}

}  // namespace

void move_lines(const MuscleLines& lines, const LegScale<Lanes<float>>& scale, const LegFrames<Lanes<float>>& legs,
                const LineOfAction<Lanes<float>>& line, LineMotion<Lanes<float>>& motion, float tick_s) {
  const Wide before = load(motion.length_m), now = load(line.length_m), zero = wide(0.0F);
  store(select(before <= zero, zero, (now - before) / wide(tick_s)), motion.speed_m_s);
  store(now, motion.length_m);

  const Leg leg = load_leg(lines, scale, legs);
  const Joints joints = find_joints(leg, lines);
  Arms mean{{zero, zero, zero}};
  for (const MuscleLines::Member& member : lines.members) {
    const Arms arms = arms_of(leg, joints, member);
    for (std::size_t j = 0; j < joint_count; ++j) mean.of[j] = fma(wide(member.weight), arms.of[j], mean.of[j]);
  }
  store(mean.of[hip], motion.hip_flexion_arm_m);
  store(mean.of[knee], motion.knee_flexion_arm_m);
  store(mean.of[ankle], motion.ankle_dorsiflexion_arm_m);
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {
namespace {
HWY_EXPORT(move_lines);
}  // namespace

void line_motion(const MuscleLines& lines, const LegScale<Lanes<float>>& scale, const LegFrames<Lanes<float>>& legs,
                 const LineOfAction<Lanes<float>>& line, LineMotion<Lanes<float>>& motion, float tick_s) {
  HWY_DYNAMIC_DISPATCH(move_lines)(lines, scale, legs, line, motion, tick_s);
}

}  // namespace mobil::inline v0_3
#endif
