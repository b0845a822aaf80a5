#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include "assets/body/column.h"
#include "engine/fetch_ahead.h"
#include "systems/gait/kinematics.h"
#include "systems/gait/step_now-inl.h"

// Functions stay separate (HWY_NOINLINE) where a compiler would merge a whole skeleton into one.

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

/// The pose under construction.
struct Skeleton {
  WideScales scale;
  Pose<Lanes<float>>& pose;

  HWY_INLINE WideVec position(Segment s) const { return load(pose.position_m[index(s)]); }
  HWY_INLINE WideQuat rotation(Segment s) const { return load(pose.rotation[index(s)]); }
  HWY_INLINE void put(Segment s, const WideVec& position, const WideQuat& rotation) const {
    store(position, pose.position_m[index(s)]);
    store(rotation, pose.rotation[index(s)]);
  }
  /// Places a segment at its parent's joint with its own rotation.
  HWY_NOINLINE void hang(Segment s, const WideQuat& world_rotation) const {
    const Segment parent = segment_parent[index(s)];
    const WideVec offset = scaled(unit_skeleton.joint_offset[index(s)], scale, joint_groups[index(s)]);
    put(s, position(parent) + rotate(rotation(parent), offset), world_rotation);
  }
};

/// The stance foothold in the world.
struct Origin {
  WideVec position;
  Wide heading, sine, cosine;
};

/// Poses thigh, kneecap, shank, foot and toes of one side. Returns the forward angle of the line from hip to ankle.
HWY_NOINLINE Wide pose_leg(const StepNow& now, const Origin& origin, const WideQuat& facing, bool uneven,
                           std::size_t side, const Skeleton& skeleton, JointAngles<Lanes<float>>& angles,
                           Feet<Lanes<float>>& feet) {
  using enum Segment;
  const Segment thigh = on_side(thigh_right, side), patella = on_side(patella_right, side);
  const Segment shank = on_side(shank_right, side), foot_segment = on_side(foot_right, side);
  const Segment toes = on_side(toes_right, side);
  const Wide& height = skeleton.scale[LengthGroup::leg];
  const FootMotion& foot = now.foot[side];
  const Foothold& at = now.at[side];
  const LegPlane leg = leg_plane(now, side, height);
  const WideVec& d = leg.to_ankle;
  const Wide direction = atan2(d.z, sqrt(leg.across2));
  const Wide aside = atan2(d.x, -d.y);
  const Wide thigh_angle = direction + atan2(leg.bulge, leg.near);
  const Wide shank_angle = direction - atan2(leg.bulge, leg.distance - leg.near);
  const Wide flexion = thigh_angle - shank_angle;

  const WideQuat tilted = facing * turn_z(aside);
  skeleton.hang(thigh, tilted * turn_x(-thigh_angle));
  skeleton.hang(shank, tilted * turn_x(-shank_angle));
  const WideQuat on_the_way = tilted * turn_x(kneecap_part * flexion - thigh_angle);
  const Vec3<float> knee = unit_skeleton.joint_offset[index(shank)], cap = unit_skeleton.joint_offset[index(patella)];
  skeleton.put(
      patella,
      skeleton.position(shank) + rotate(on_the_way, scaled({cap.x - knee.x, cap.y - knee.y, cap.z - knee.z}, height)),
      on_the_way);

  const Wide yaw = origin.heading + at.heading + foot.toe_out * (side == Side::left ? 1.0F : -1.0F);
  WideQuat outward = turn_y(yaw);
  Wide sloped = wide(0.0F);
  if (uneven) {
    const Slope& slope = now.under[side];
    const Ground rise = turned(slope.left, slope.along, origin.sine, origin.cosine);
    Wide s, c;
    sin_cos(yaw, s, c);
    sloped = atan2(fma(rise.left, s, rise.forward * c), wide(1.0F));
    outward = tilt_of(rise.left, rise.forward) * outward;
  }
  const Wide pitch = held_pitch(foot, shank_angle - sloped);
  const Ground ankle = turned(at.ankle.left, at.ankle.forward, origin.sine, origin.cosine);
  const WideQuat sole = outward * turn_x(-pitch), toe_rotation = outward * turn_x(-(pitch + foot.toes));
  const WideVec ankle_at = origin.position + WideVec{ankle.left, foot.ankle_up, ankle.forward};
  skeleton.put(foot_segment, ankle_at, sole);
  skeleton.hang(toes, toe_rotation);

  store(thigh_angle + now.motion.tilt, angles.hip_flexion[side]);
  store(flexion, angles.knee_flexion[side]);
  store(pitch + sloped - shank_angle, angles.ankle_dorsiflexion[side]);
  constexpr auto tall = static_cast<float>(fraction::ankle_height);
  store(ankle_at + rotate(sole, scaled({0, -tall, -unit_foot::back}, height)), feet.heel_m[side]);
  store(skeleton.position(toes) + rotate(toe_rotation, scaled({0, -unit_foot::joint, 0}, height)), feet.toe_m[side]);
  store(skeleton.position(toes) + rotate(toe_rotation, scaled({0, -unit_foot::joint, unit_foot::toes}, height)),
        feet.tip_m[side]);
  return direction;
}

/// Part of the stoop by which a vertebra is turned forward. The thoracic column bends by all of it between T12 and T1.
/// The lumbar column bends back, as much as keeps the shoulders above the hips.
constexpr float stoop_part(std::size_t segment) {
  constexpr float forward = 0.62F, back = 0.38F;
  constexpr auto low = static_cast<float>(index(Segment::L5)), middle = static_cast<float>(index(Segment::T12)),
                 top = static_cast<float>(index(Segment::T1));
  const auto s = static_cast<float>(segment);
  return s <= middle ? -back * (s - low + 1) / (middle - low + 1)
                     : (s - middle) / (top - middle) * (forward + back) - back;
}
/// Returns a small rotation about x, accurate to 1e-6 up to 0.4 rad.
HWY_INLINE WideQuat bent_by(const Wide& angle) {
  const Wide half = 0.5F * angle, squared = half * half;
  return {half * fma(squared, fma(squared, wide(1.0F / 120), wide(-1.0F / 6)), wide(1.0F)), wide(0.0F), wide(0.0F),
          fma(squared, fma(squared, wide(1.0F / 24), wide(-0.5F)), wide(1.0F))};
}

/// Poses the column from sacrum to head, with a small rotation between neighbouring vertebrae. The pelvis' rotation is
/// undone and, up to the shoulders, reversed. From there to the head, in the walking plane, it is undone again. Returns
/// the rotation of the shoulders without the stoop.
HWY_NOINLINE WideQuat pose_column(const WideQuat& facing, const Wide& turned_back, const Wide& lean, const Wide& stoop,
                                  const Skeleton& skeleton) {
  constexpr std::size_t first = index(Segment::L5), shoulders = index(Segment::T1), head = index(Segment::head);
  const WideQuat base = skeleton.rotation(Segment::pelvis);
  const WideQuat chest = facing * (turn_y(turned_back) * turn_x(lean));
  const WideMask stoops = stoop > 0.0F;
  const bool any_stoops = any(stoops);
  const auto bent = [&](const WideQuat& q, std::size_t s) {
    return any_stoops ? select(stoops, q * bent_by(stoop * stoop_part(s)), q) : q;
  };
  for (std::size_t s = first; s <= shoulders; ++s) {
    constexpr ColumnParts parts = column_parts();
    const auto part = static_cast<float>(parts[s - first]);
    skeleton.hang(static_cast<Segment>(s), bent(part_way(base, chest, wide(part)), s));
  }
  const WideQuat shoulder = bent(chest, shoulders);
  for (std::size_t s = shoulders + 1; s <= head; ++s) {
    const float part = static_cast<float>(s - shoulders) / static_cast<float>(head - shoulders);
    skeleton.hang(static_cast<Segment>(s), part_way(shoulder, facing, wide(part)));
  }
  return chest;
}

/// Parameters common to both arms.
struct ArmParameters {
  Wide back, forward, elbow_back, elbow_forward, abduction, pronation, fingers;
};

/// Poses one arm. `ahead` is the position of the opposite leg in its range, 0 back to 1 forward. `chest` is the
/// shoulders' rotation without the stoop, from which the arm swings.
HWY_NOINLINE void pose_arm(const ArmParameters& arm_manner, const Wide& ahead, const WideQuat& chest, std::size_t side,
                           const Skeleton& skeleton, JointAngles<Lanes<float>>& angles) {
  using enum Segment;
  auto of = [&](Segment s) { return on_side(s, side); };
  const float out = side == Side::left ? 1.0F : -1.0F;
  const Wide shoulder = fma(ahead, arm_manner.forward + arm_manner.back, -arm_manner.back);
  const Wide elbow = fma(ahead, arm_manner.elbow_forward - arm_manner.elbow_back, arm_manner.elbow_back);
  const Wide pronation = arm_manner.pronation * -out;

  skeleton.hang(of(clavicle_right), skeleton.rotation(T1));
  // Part of the pronation is an inward rotation of the upper arm.
  const WideQuat arm = chest * (turn_z(arm_manner.abduction * out) * (turn_x(-shoulder) * turn_y(0.3F * pronation)));
  skeleton.hang(of(upper_arm_right), arm);
  const WideQuat forearm = arm * (turn_x(-elbow) * turn_y(0.7F * pronation));
  skeleton.hang(of(forearm_right), forearm);
  constexpr HalfAngle wrist = half_of(-0.10), thumb = half_of(-0.35);
  const WideQuat hand = forearm * turn_x(wrist);
  skeleton.hang(of(hand_right), hand);
  skeleton.hang(of(fingers_right), hand * turn_x(-arm_manner.fingers));
  skeleton.hang(of(thumb_right), hand * (turn_z(wide(0.45F * out)) * turn_x(thumb)));
  store(shoulder, angles.shoulder_flexion[side]);
  store(elbow, angles.elbow_flexion[side]);
}

void pose_block(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                const GaitState<Lanes<float>>& state, const Footing<Lanes<float>>* footing, Pose<Lanes<float>>& pose,
                JointAngles<Lanes<float>>& angles, Feet<Lanes<float>>& feet, const NextWalkers& next) {
  FetchAhead plans(next.plan), poses(next.pose);
  constexpr std::size_t places = 7, pose_lines = sizeof(pose) / 64 / places + 1,
                        plan_lines = sizeof(plan) / 64 / step_now_fetches + 1;
  const auto fetch = [&] { poses.fetch(pose_lines); };
  FetchAhead(next.state).fetch(all_lines);
  const Skeleton skeleton{WideScales(size), pose};
  const StepNow now = step_now(leg_size(size), plan, state, footing, [&] { plans.fetch(plan_lines); });
  const PelvisMotion& motion = now.motion;
  const PelvisPlace& pelvis = now.pelvis;
  const Wide& eased = now.eased;

  const Wide zero = wide(0.0F);
  const Wide ground = footing == nullptr ? zero : load(footing->height_m[index(FootholdOf::stance)]);
  Origin origin = {{load(state.line_x_m), ground, load(state.line_z_m)}, load(state.heading_rad), zero, zero};
  sin_cos(origin.heading, origin.sine, origin.cosine);
  const Ground world = turned(pelvis.position.x, pelvis.position.z, origin.sine, origin.cosine);
  const WideQuat facing = turn_y(origin.heading + pelvis.heading);
  skeleton.put(Segment::pelvis, origin.position + WideVec{world.left, pelvis.position.y, world.forward},
               facing * motion.turn);

  Wide leg[2];
  fetch();
  for (std::size_t side = 0; side < 2; ++side) {
    fetch();
    leg[side] = pose_leg(now, origin, facing, footing != nullptr, side, skeleton, angles, feet);
    store(0.5F * select(now.stands[side], now.part, now.part + 1.0F), feet.phase[side]);
  }

  const PostureParameters<Lanes<float>>&from = plan.from.posture, &to = plan.to.posture;
  fetch();
  Wide lean = harmonics(now.shape, step_shape::trunk, 3, now.waves);
  if (footing != nullptr) lean = lean + now.lean;
  const WideQuat chest =
      pose_column(facing, -posture(from.shoulder_rotation, to.shoulder_rotation, eased) * motion.rotation, lean,
                  load(size.stoop_rad), skeleton);
  const ArmParameters arms = {posture(from.arm_back, to.arm_back, eased),
                              posture(from.arm_forward, to.arm_forward, eased),
                              posture(from.elbow_back, to.elbow_back, eased),
                              posture(from.elbow_forward, to.elbow_forward, eased),
                              posture(from.arm_abduction, to.arm_abduction, eased),
                              posture(from.forearm_pronation, to.forearm_pronation, eased),
                              posture(from.finger_flexion, to.finger_flexion, eased)};
  const Wide leg_back = posture(from.leg_back, to.leg_back, eased);
  const Wide per_range = 1.0F / max(posture(from.leg_forward, to.leg_forward, eased) - leg_back, 1e-3F);
  for (std::size_t side = 0; side < 2; ++side) {
    fetch();
    pose_arm(arms, (leg[1 - side] - leg_back) * per_range, chest, side, skeleton, angles);
  }
  fetch();
  FetchAhead(next.angles).fetch(all_lines);
  FetchAhead(next.feet).fetch(all_lines);
  store(motion.rotation, angles.pelvis_rotation);
  store(motion.list, angles.pelvis_list);
  store(motion.tilt, angles.pelvis_tilt);
}

void centre_block(const BodySize<Lanes<float>>& size, const Pose<Lanes<float>>& pose,
                  CentreOfMass<Lanes<float>>& centre) {
  const WideScales scale(size);
  const WideMasses masses(size);
  WideVec sum = {wide(0.0F), wide(0.0F), wide(0.0F)};
  for (std::size_t s = 0; s < segment_count; ++s) {
    const WideVec c = rotate(load(pose.rotation[s]), scaled(unit_skeleton.centre_of_mass[s], scale, segment_groups[s]));
    const Wide mass = masses[mass_group[s]] * unit_skeleton.mass_share[s];
    sum = fma(mass, load(pose.position_m[s]) + c, sum);
  }
  store(sum, centre.position_m);
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {

HWY_EXPORT(pose_block);
HWY_EXPORT(centre_block);

void pose_skeleton(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                   const GaitState<Lanes<float>>& state, const Footing<Lanes<float>>* footing, Pose<Lanes<float>>& pose,
                   JointAngles<Lanes<float>>& angles, Feet<Lanes<float>>& feet, const NextWalkers& next) {
  HWY_DYNAMIC_DISPATCH(pose_block)(size, plan, state, footing, pose, angles, feet, next);
}

void centre_of_mass(const BodySize<Lanes<float>>& size, const Pose<Lanes<float>>& pose,
                    CentreOfMass<Lanes<float>>& centre) {
  HWY_DYNAMIC_DISPATCH(centre_block)(size, pose, centre);
}

}  // namespace mobil::inline v0_3
#endif
