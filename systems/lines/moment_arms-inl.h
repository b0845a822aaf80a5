// Moment arms of paths in blocks of sixteen legs. See engine/wide-inl.h for how to include it.

#if defined(MOBIL_SYSTEMS_LINES_MOMENT_ARMS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_LINES_MOMENT_ARMS_INL_H_
#undef MOBIL_SYSTEMS_LINES_MOMENT_ARMS_INL_H_
#else
#define MOBIL_SYSTEMS_LINES_MOMENT_ARMS_INL_H_
#endif

#include "systems/lines/leg_path-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
enum LegJoint : std::size_t { leg_hip, leg_knee, leg_ankle, leg_joints };

constexpr bool is_distal(LegBone bone, std::size_t joint) {
  return static_cast<std::size_t>(bone) > joint;
}

/// Axes of positive flexion of the distal parts, and axis × centre, relative to the knee.
struct Joints {
  WideVec axis[leg_joints], moment[leg_joints];
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

HWY_INLINE Joints find_joints(const Leg& leg, const MuscleLines::Track& rolling) {
  Joints joints;
  const Wide zero = wide(0.0F);
  joints.axis[leg_hip] = negated(leg.edge[0]);
  joints.axis[leg_knee] = leg.edge[1];
  joints.axis[leg_ankle] = negated(leg.edge[2]);
  joints.moment[leg_hip] = cross(joints.axis[leg_hip], leg.origin[0]);
  joints.moment[leg_knee] = {zero, zero, zero};
  joints.moment[leg_ankle] = cross(joints.axis[leg_ankle], leg.origin[3]);
  const Wide u = leg.flexion * wide(knots_per_rad);
  for (std::size_t k = 0; k < knee_knots; ++k) {
    const Wide d = max(u - wide(static_cast<float>(k)), zero);
    joints.square[k] = wide(3.0F) * d * d;
  }
  joints.drift = drift_of(leg, joints, rolling, leg.across);
  return joints;
}

/// Arms of flexion; and the moment of a unit of tension on the thigh about the hip, in world axes, if asked for.
struct Arms {
  Wide of[leg_joints];
  WideVec about_hip;
};

template <bool whole_hip>
HWY_INLINE Arms arms_of(const Leg& leg, const Joints& joints, const MuscleLines::Member& member, const WideVec& end) {
  const Wide zero = wide(0.0F);
  Arms arms{{zero, zero, zero}, {zero, zero, zero}};
  Wide distal[leg_joints];  // 1 where the path has passed the joint
  for (std::size_t j = 0; j < leg_joints; ++j) {
    distal[j] = wide(is_distal(member.path.front().bone, j) ? 1.0F : 0.0F);
  }
  WideVec last{zero, zero, zero};
  along_path(leg, member, end,
             [&](const WideVec& from, const WideVec& to, LegBone bone, const WideMask* there) HWY_ATTR {
               const WideVec d = to - from;
               const Wide shorten = wide(1.0F) / max(length(d), wide(1e-9F));
               const WideVec unit{shorten * d.x, shorten * d.y, shorten * d.z};
               const WideVec turn = cross(to, unit);
               for (std::size_t j = 0; j < leg_joints; ++j) {
                 Wide passed = wide(is_distal(bone, j) ? 1.0F : 0.0F);
                 if (there != nullptr) passed = select(*there, passed, distal[j]);
                 Wide growth = dot(joints.axis[j], turn) - dot(joints.moment[j], unit);
                 if (j == leg_knee) growth = growth + dot(joints.drift, unit);
                 arms.of[j] = fnma(passed - distal[j], growth, arms.of[j]);
                 if (whole_hip && j == leg_hip)
                   arms.about_hip = fma(distal[j] - passed, cross(to - leg.origin[0], unit), arms.about_hip);
                 distal[j] = passed;
               }
               last = unit;
             });
  if (member.on_kneecap) {
    arms.of[leg_knee] = arms.of[leg_knee] - dot(drift_of(leg, joints, member.kneecap, leg.y_scale[2]), last);
  }
  return arms;
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
