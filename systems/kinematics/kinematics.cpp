#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/kinematics/kinematics.cpp"
#include <hwy/foreach_target.h>

#include "assets/anthropometry.h"
#include "systems/kinematics/kinematics.h"
#include "systems/kinematics/kinematics_wide-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {

constexpr float pi_f = 3.14159265F;

/// The pose under construction, in the walker's own frame: origin on the walking line beside the stance foothold,
/// +Z along the heading.
struct Skeleton {
  Wide height;
  WideVec position[segment_count];
  WideQuat rotation[segment_count];

  HWY_INLINE void hang(Segment s, const WideQuat& world_rotation) {
    const std::size_t i = index(s), parent = index(segment_parent[i]);
    position[i] = position[parent] + rotate(rotation[parent], scaled(unit_body.joint_offset[i], height));
    rotation[i] = world_rotation;
  }
  HWY_INLINE const WideQuat& parent_rotation(Segment s) const { return rotation[index(segment_parent[index(s)])]; }
};

/// What the pelvis does now, seen from the right side.
struct PelvisMotion {
  Wide rotation, list, tilt, shift;
};

HWY_INLINE Wide cosine_of(const Wide& angle) {
  Wide s, c;
  sin_cos(angle, s, c);
  return c;
}

HWY_INLINE PelvisMotion pelvis_motion(const StepPlan<Lanes<float>>& plan, const Wide& time, const Wide& sign) {
  namespace p = pelvis_phase;
  const Wide at = time / load(plan.duration_s), pi = wide(pi_f);
  auto wave = [&](double phase, float harmonic) {
    return cosine_of(pi * wide(harmonic) * (at - wide(static_cast<float>(phase))));
  };
  PelvisMotion m;
  m.rotation = sign * load(plan.pelvis_rotation) * wave(p::rotation, 1.0F);
  m.list = sign * load(plan.pelvis_list) *
           fma(wide(static_cast<float>(p::list_first)), wave(p::list_first_phase, 1.0F),
               wide(static_cast<float>(p::list_third)) * wave(p::list_third_phase, 3.0F));
  m.tilt = fma(load(plan.pelvis_tilt_wave), wave(p::tilt, 2.0F), load(plan.pelvis_tilt));
  const Wide middle = (time - wide(0.5F) * load(plan.double_support_s)) / load(plan.duration_s);
  m.shift = sign * load(plan.pelvis_shift_m) * cosine_of(pi * (middle - wide(0.5F)));
  return m;
}

/// Foot of one leg: pitch, bend of the toes, ankle in the walker's frame, the sign of its own outward direction.
struct FootMotion {
  Wide pitch, toes;
  WideVec ankle;
};

/// `lag` is the time since this leg's own heel strike, up to two steps; `forward` the place of its foothold ahead of
/// the stance foothold, `out` +1 for the left leg, −1 for the right.
HWY_INLINE FootMotion foot_motion(const StepPlan<Lanes<float>>& plan, const Wide& height, const Wide& lag,
                                  const Wide& forward, float out) {
  const Wide zero = wide(0.0F), one = wide(1.0F);
  const Wide flat = load(plan.flat_s), step = load(plan.duration_s);
  const Wide toe_off = step + load(plan.double_support_s);
  const WideMask swinging = lag >= toe_off, rocking = lag < flat;
  const Wide in_stance = (lag - flat) / (toe_off - flat);
  const Wide in_swing = (lag - toe_off) / (step + step - toe_off);
  const Wide second = select(swinging, one, zero);
  const Wide rolled = curve_at(plan.foot_pitch, second, select(swinging, in_swing, in_stance));
  const Wide u = lag / flat, rest = one - u;
  const Wide rocked = load(plan.strike_pitch) * rest * rest * fma(wide(0.7F), u, one);
  FootMotion foot;
  foot.pitch = select(rocking, rocked, select(swinging, rolled, min(rolled, zero)));
  foot.toes = select(swinging, curve_at(plan.swing_toes, in_swing), max(-foot.pitch, zero));

  // Standing: about the heel with the toes up, about the toe joint with the heel up.
  namespace f = fraction;
  Wide s, c;
  sin_cos(foot.pitch, s, c);
  const Wide back = wide(static_cast<float>(f::heel_back)) * height;
  const Wide ball = wide(static_cast<float>(f::ball_forward)) * height;
  const Wide tall = wide(static_cast<float>(f::ankle_height)) * height;
  const Wide joint = wide(static_cast<float>(f::toe_joint_height)) * height;
  const Wide over = tall - joint;
  const WideMask on_heel = foot.pitch >= zero;
  const Wide along = select(on_heel, fnma(tall, s, back * (c - one)), fnma(over, s, ball * (one - c)));
  const Wide up = select(on_heel, fma(back, s, tall * c), joint + fnma(ball, s, over * c));
  const Wide stand_out = fma(load(plan.toe_out_sin), along, load(plan.half_width_m));
  const Wide ease = in_swing * in_swing * fnma(wide(2.0F), in_swing, wide(3.0F));
  const Wide from = load(plan.swing_out_from_m);
  const Wide swing_out = fma(ease, load(plan.swing_out_to_m) - from, from);
  foot.ankle.x = wide(out) * select(swinging, swing_out, stand_out);
  foot.ankle.y = select(swinging, curve_at(plan.swing_up_m, in_swing), up);
  foot.ankle.z = forward + select(swinging, curve_at(plan.swing_forward_m, in_swing), load(plan.toe_out_cos) * along);
  return foot;
}

/// Thigh, kneecap, shank, foot and toes of one side; returns the forward angle of the line from hip to ankle.
HWY_INLINE Wide pose_leg(const StepPlan<Lanes<float>>& plan, const FootMotion& foot, const PelvisMotion& motion,
                         std::size_t side, Skeleton& skeleton, JointAngles<Lanes<float>>& angles,
                         Feet<Lanes<float>>& feet) {
  using enum Segment;
  const Segment thigh = on_side(thigh_right, side), patella = on_side(patella_right, side);
  const Segment shank = on_side(shank_right, side), foot_segment = on_side(foot_right, side);
  const Segment toes = on_side(toes_right, side);
  const Wide& height = skeleton.height;
  const Wide upper = wide(static_cast<float>(fraction::thigh)) * height;
  const Wide lower = wide(static_cast<float>(fraction::shank)) * height;

  skeleton.hang(thigh, skeleton.rotation[index(Segment::pelvis)]);
  const WideVec hip = skeleton.position[index(thigh)];
  const WideVec d = foot.ankle - hip;
  const Wide across2 = fma(d.x, d.x, d.y * d.y);
  const Wide longest = (upper + lower) * wide(0.999999F);
  const Wide distance = min(sqrt(fma(d.z, d.z, across2)), longest);
  const Wide direction = atan2(d.z, sqrt(across2));
  const Wide aside = atan2(d.x, -d.y);
  // Where the knee's height over the hip–ankle line falls.
  const Wide near = (fma(upper, upper, distance * distance) - lower * lower) / (wide(2.0F) * distance);
  const Wide bulge = sqrt(max(fma(upper, upper, -(near * near)), wide(0.0F)));
  const Wide thigh_angle = direction + atan2(bulge, near);
  const Wide shank_angle = direction - atan2(bulge, distance - near);
  const Wide flexion = thigh_angle - shank_angle;

  const WideQuat tilted = turn_z(aside);
  skeleton.rotation[index(thigh)] = tilted * turn_x(-thigh_angle);
  skeleton.hang(shank, tilted * turn_x(-shank_angle));
  // The kneecap slides round the knee at half its flexion.
  const WideQuat half_way = tilted * turn_x(wide(0.5F) * flexion - thigh_angle);
  const Vec3<double> knee = unit_body.joint_offset[index(shank)], cap = unit_body.joint_offset[index(patella)];
  skeleton.rotation[index(patella)] = half_way;
  skeleton.position[index(patella)] =
      skeleton.position[index(shank)] +
      rotate(half_way, scaled({cap.x - knee.x, cap.y - knee.y, cap.z - knee.z}, height));

  const Wide yaw = atan2(load(plan.toe_out_sin), load(plan.toe_out_cos)) * wide(side == left ? 1.0F : -1.0F);
  const WideQuat outward = turn_y(yaw);
  skeleton.position[index(foot_segment)] = foot.ankle;
  skeleton.rotation[index(foot_segment)] = outward * turn_x(-foot.pitch);
  skeleton.hang(toes, outward * turn_x(-(foot.pitch + foot.toes)));

  store(thigh_angle + motion.tilt, angles.hip_flexion[side]);
  store(flexion, angles.knee_flexion[side]);
  store(foot.pitch - shank_angle, angles.ankle_dorsiflexion[side]);
  const WideVec heel = foot.ankle + rotate(skeleton.rotation[index(foot_segment)],
                                           scaled({0, -fraction::ankle_height, -fraction::heel_back}, height));
  const WideVec toe = skeleton.position[index(toes)] +
                      rotate(skeleton.rotation[index(toes)], scaled({0, -fraction::toe_joint_height, 0}, height));
  store(heel, feet.heel_m[side]);
  store(toe, feet.toe_m[side]);
  return direction;
}

/// The column from the sacrum to the head: the pelvis's turn is undone and, up to the shoulders, reversed.
HWY_INLINE void pose_column(const StepPlan<Lanes<float>>& plan, const PelvisMotion& pelvis, const Wide& lean,
                            Skeleton& skeleton) {
  const std::size_t first = index(Segment::L5), shoulders = index(Segment::T1), head = index(Segment::head);
  const Wide turned_back = -load(plan.shoulder_rotation) * pelvis.rotation;
  for (std::size_t s = first; s <= head; ++s) {
    const bool trunk = s <= shoulders;
    const float part = trunk ? static_cast<float>(s - first + 1) / static_cast<float>(shoulders - first + 1)
                             : static_cast<float>(head - s) / static_cast<float>(head - shoulders);
    const Wide p = wide(part), q = wide(1.0F - part), zero = wide(0.0F);
    const Wide yaw = trunk ? fma(p, turned_back, q * pelvis.rotation) : p * turned_back;
    const Wide roll = trunk ? -(q * pelvis.list) : zero;
    const Wide pitch = trunk ? fma(p, lean, q * pelvis.tilt) : p * lean;
    skeleton.hang(static_cast<Segment>(s), turn_yzx(yaw, roll, pitch));
  }
}

/// One arm, swinging with the opposite leg.
HWY_INLINE void pose_arm(const StepPlan<Lanes<float>>& plan, const Wide& opposite_leg, std::size_t side,
                         Skeleton& skeleton, JointAngles<Lanes<float>>& angles) {
  using enum Segment;
  auto of = [&](Segment s) { return on_side(s, side); };
  const float out = side == left ? 1.0F : -1.0F;
  const Wide back = load(plan.leg_back);
  const Wide ahead = (opposite_leg - back) / max(load(plan.leg_forward) - back, wide(1e-3F));
  const Wide shoulder = fma(ahead, load(plan.arm_forward) + load(plan.arm_back), -load(plan.arm_back));
  const Wide elbow = fma(ahead, load(plan.elbow_forward) - load(plan.elbow_back), load(plan.elbow_back));
  const Wide pronation = load(plan.forearm_pronation) * wide(-out);

  skeleton.hang(of(clavicle_right), skeleton.parent_rotation(of(clavicle_right)));
  const WideQuat& trunk = skeleton.rotation[index(of(clavicle_right))];
  // A part of the pronation is the upper arm's inward turn.
  const WideQuat arm =
      trunk * (turn_z(load(plan.arm_abduction) * wide(out)) * (turn_x(-shoulder) * turn_y(wide(0.3F) * pronation)));
  skeleton.hang(of(upper_arm_right), arm);
  skeleton.hang(of(forearm_right), arm * (turn_x(-elbow) * turn_y(wide(0.7F) * pronation)));
  const WideQuat& forearm = skeleton.rotation[index(of(forearm_right))];
  skeleton.hang(of(hand_right), forearm * turn_x(wide(-0.10F)));
  const WideQuat& hand = skeleton.rotation[index(of(hand_right))];
  skeleton.hang(of(fingers_right), hand * turn_x(-load(plan.finger_flexion)));
  skeleton.hang(of(thumb_right), hand * (turn_z(wide(0.45F * out)) * turn_x(wide(-0.35F))));
  store(shoulder, angles.shoulder_flexion[side]);
  store(elbow, angles.elbow_flexion[side]);
}

HWY_INLINE void store_pose(const Skeleton& skeleton, Pose<Lanes<float>>& pose) {
  for (std::size_t s = 0; s < segment_count; ++s) {
    store(skeleton.position[s], pose.position_m[s]);
    store(skeleton.rotation[s], pose.rotation[s]);
  }
}

void pose_block(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                const GaitState<Lanes<float>>& state, Pose<Lanes<float>>& pose, JointAngles<Lanes<float>>& angles,
                Feet<Lanes<float>>& feet) {
  const Wide one = wide(1.0F), zero = wide(0.0F);
  Skeleton skeleton;
  skeleton.height = load(size.height_m);
  const Wide time = load(state.time_s), step = load(plan.duration_s);
  const WideMask right_stands = equal(state.stance_side, right);
  const PelvisMotion pelvis = pelvis_motion(plan, time, select(right_stands, one, -one));

  const Wide u = time / step;
  skeleton.position[index(Segment::pelvis)] = {-pelvis.shift, curve_at(plan.hip_up_m, u),
                                               curve_at(plan.hip_forward_m, u)};
  skeleton.rotation[index(Segment::pelvis)] = turn_yzx(pelvis.rotation, -pelvis.list, pelvis.tilt);

  Wide swing[2];
  for (std::size_t side = 0; side < 2; ++side) {
    const WideMask stands = side == right ? right_stands : equal(state.stance_side, left);
    const Wide lag = select(stands, time, time + step);
    const FootMotion foot = foot_motion(plan, skeleton.height, lag, select(stands, zero, -load(plan.step_length_m)),
                                        side == left ? 1.0F : -1.0F);
    swing[side] = pose_leg(plan, foot, pelvis, side, skeleton, angles, feet);
    store(lag / (step + step), feet.phase[side]);
  }
  pose_column(plan, pelvis, curve_at(plan.trunk_pitch, u), skeleton);
  for (std::size_t side = 0; side < 2; ++side) pose_arm(plan, swing[1 - side], side, skeleton, angles);
  store(pelvis.rotation, angles.pelvis_rotation);
  store(pelvis.list, angles.pelvis_list);
  store(pelvis.tilt, angles.pelvis_tilt);

  // Into the world.
  const WideQuat heading = turn_y(load(state.heading_rad));
  const WideVec line = {load(state.line_x_m), zero, load(state.line_z_m)};
  for (std::size_t s = 0; s < segment_count; ++s) {
    skeleton.position[s] = line + rotate(heading, skeleton.position[s]);
    skeleton.rotation[s] = heading * skeleton.rotation[s];
  }
  store_pose(skeleton, pose);
  for (std::size_t side = 0; side < 2; ++side) {
    for (Vec3<Lanes<float>>* point : {&feet.heel_m[side], &feet.toe_m[side]}) {
      store(line + rotate(heading, load(*point)), *point);
    }
  }
}

void anatomical_block(const BodySize<Lanes<float>>& size, Pose<Lanes<float>>& pose) {
  Skeleton skeleton;
  skeleton.height = load(size.height_m);
  const Wide zero = wide(0.0F);
  const WideQuat identity = {zero, zero, zero, wide(1.0F)};
  skeleton.position[0] = scaled(unit_body.joint_offset[0], skeleton.height);
  skeleton.rotation[0] = identity;
  for (std::size_t s = 1; s < segment_count; ++s) skeleton.hang(static_cast<Segment>(s), identity);
  store_pose(skeleton, pose);
}

void centre_block(const BodySize<Lanes<float>>& size, const Pose<Lanes<float>>& pose,
                  CentreOfMass<Lanes<float>>& centre) {
  const Wide height = load(size.height_m);
  WideVec sum = {wide(0.0F), wide(0.0F), wide(0.0F)};
  for (std::size_t s = 0; s < segment_count; ++s) {
    const WideVec c = rotate(load(pose.rotation[s]), scaled(unit_body.centre_of_mass[s], height));
    const Wide part = wide(static_cast<float>(unit_body.mass_fraction[s]));
    sum = fma(part, load(pose.position_m[s]) + c, sum);
  }
  store(sum, centre.position_m);
}

}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil {

HWY_EXPORT(pose_block);
HWY_EXPORT(anatomical_block);
HWY_EXPORT(centre_block);

void pose_skeleton(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                   const GaitState<Lanes<float>>& state, Pose<Lanes<float>>& pose, JointAngles<Lanes<float>>& angles,
                   Feet<Lanes<float>>& feet) {
  HWY_DYNAMIC_DISPATCH(pose_block)(size, plan, state, pose, angles, feet);
}

void pose_anatomical(const BodySize<Lanes<float>>& size, Pose<Lanes<float>>& pose) {
  HWY_DYNAMIC_DISPATCH(anatomical_block)(size, pose);
}

void centre_of_mass(const BodySize<Lanes<float>>& size, const Pose<Lanes<float>>& pose,
                    CentreOfMass<Lanes<float>>& centre) {
  HWY_DYNAMIC_DISPATCH(centre_block)(size, pose, centre);
}

}  // namespace mobil
#endif
