#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/kinematics/kinematics.cpp"
#include <hwy/foreach_target.h>

#include "assets/body/anthropometry.h"
#include "assets/body/column.h"
#include "assets/body/fat_distribution.h"
#include "systems/kinematics/kinematics.h"
#include "systems/kinematics/kinematics_wide-inl.h"
#include "systems/kinematics/on_line-inl.h"

// Functions here are kept apart where a compiler would otherwise put all of a skeleton into one.

#ifndef MOBIL_SYSTEMS_KINEMATICS_CPP_
#define MOBIL_SYSTEMS_KINEMATICS_CPP_
namespace mobil {
namespace {

/// The body of height 1 m in single precision.
struct UnitSkeleton {
  Vec3<float> joint_offset[segment_count], centre_of_mass[segment_count];
  float mass_fraction[segment_count], mass_per_extra_fat[segment_count];
};

constexpr UnitSkeleton make_unit_skeleton() {
  UnitSkeleton s{};
  auto single = [](const Vec3<double>& v) {
    return Vec3<float>{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
  };
  for (std::size_t i = 0; i < segment_count; ++i) {
    s.joint_offset[i] = single(unit_body.joint_offset[i]);
    s.centre_of_mass[i] = single(unit_body.centre_of_mass[i]);
    s.mass_fraction[i] = static_cast<float>(unit_body.mass_fraction[i]);
    s.mass_per_extra_fat[i] = static_cast<float>(mass_per_extra_fat(i));
  }
  return s;
}

constexpr UnitSkeleton unit_skeleton = make_unit_skeleton();

}  // namespace
}  // namespace mobil
#endif

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {

/// The pose under construction.
struct Skeleton {
  Wide height;
  Pose<Lanes<float>>& pose;

  HWY_INLINE WideVec position(Segment s) const { return load(pose.position_m[index(s)]); }
  HWY_INLINE WideQuat rotation(Segment s) const { return load(pose.rotation[index(s)]); }
  HWY_INLINE void put(Segment s, const WideVec& position, const WideQuat& rotation) const {
    store(position, pose.position_m[index(s)]);
    store(rotation, pose.rotation[index(s)]);
  }
  /// A segment that turns where it hangs on its parent.
  HWY_NOINLINE void hang(Segment s, const WideQuat& world_rotation) const {
    const Segment parent = segment_parent[index(s)];
    const WideVec offset = scaled(unit_skeleton.joint_offset[index(s)], height);
    put(s, position(parent) + rotate(rotation(parent), offset), world_rotation);
  }
};

/// What the pelvis does now, seen from the right side; its turn and the hips' places from their middle, in its heading.
struct PelvisMotion {
  Wide rotation, list, tilt;
  WideQuat turn;
  WideVec hip[2];
};

HWY_NOINLINE PelvisMotion pelvis_motion(const StepPlan<Lanes<float>>& plan, const StepWaves& w, const Wide& eased,
                                        const Wide& sign, const Wide& height) {
  PelvisMotion m;
  m.rotation = sign * pelvis_rotation(plan, w, eased);
  m.list = sign * pelvis_list(plan, w, eased);
  m.tilt = pelvis_tilt(plan, w, eased);
  m.turn = turn_yzx(m.rotation, -m.list, m.tilt);
  for (std::size_t side = 0; side < 2; ++side)
    m.hip[side] =
        rotate(m.turn, scaled(unit_skeleton.joint_offset[index(on_side(Segment::thigh_right, side))], height));
  return m;
}

/// Where the pelvis is and heads, in the frame of the stance foothold; the heading there, sine and cosine.
struct PelvisPlace {
  WideVec position;
  Wide heading, sine, cosine;
};

/// The stance foothold in the world.
struct Origin {
  WideVec position;
  Wide heading, sine, cosine;
};

/// The lower of two, rounded off where they are within `width`: C², never above either.
HWY_INLINE Wide lower_of(const Wide& a, const Wide& b, const Wide& width) {
  const Wide d = clamp((b - a) / width, -1.0F, 1.0F);
  // The positive part of d with (1 − d²) 3/4 as its second derivative.
  const Wide rounded = fma(d, fma(d, 0.375F - 0.0625F * d * d, wide(0.5F)), wide(0.1875F));
  return min(a, b) - width * (rounded - max(d, 0.0F));
}

/// A foot in the air that its leg cannot reach is drawn in toward the hip: smoothly, and less the nearer it is to the
/// ground it left or comes to.
HWY_NOINLINE void draw_in(FootMotion& foot, Foothold& at, const PelvisPlace& root, const PelvisMotion& motion,
                          std::size_t side, const Wide& height) {
  const WideVec& hip = motion.hip[side];
  const Wide hip_left = root.position.x + fma(hip.x, root.cosine, hip.z * root.sine);
  const Wide hip_ahead = root.position.z + fnma(hip.x, root.sine, hip.z * root.cosine);
  const Wide dx = at.ankle.left - hip_left, dz = at.ankle.forward - hip_ahead;
  const Wide dy = foot.ankle_up - root.position.y - hip.y;
  const Wide distance = sqrt(fma(dx, dx, fma(dy, dy, dz * dz)));
  constexpr float full = static_cast<float>(fraction::thigh + fraction::shank);
  const Wide most = 0.9995F * full * height;
  const Wide within = fma(0.01F * full * height, foot.in_the_air, wide(1e-5F));
  const Wide near = max(1.0F - abs(distance - most) / within, 0.0F);
  const Wide reached = min(distance, most) - within * (1.0F / 6.0F) * near * near * near;
  const Wide part = mix(wide(1.0F), reached / distance, smooth(4.0F * foot.in_the_air));
  at.ankle = {fma(part, dx, hip_left), fma(part, dz, hip_ahead)};
  foot.ankle_up = fma(part, dy, root.position.y + hip.y);
}

/// Height of the middle of the hips at which a leg is as straight as a knee becomes.
HWY_NOINLINE Wide highest_hips(const FootMotion& foot, const Foothold& at, const PelvisPlace& root,
                               const PelvisMotion& motion, std::size_t side, const Wide& height) {
  const WideVec& hip = motion.hip[side];
  const Wide dx = at.ankle.left - root.position.x, dz = at.ankle.forward - root.position.z;
  const Wide x = fnma(dz, root.sine, dx * root.cosine) - hip.x, z = fma(dx, root.sine, dz * root.cosine) - hip.z;
  constexpr float straightest = static_cast<float>(fraction::thigh + fraction::shank) * 0.9999F;  // 1.6 degrees
  const Wide reach = straightest * height;
  return foot.ankle_up - hip.y + sqrt(max(reach * reach - fma(x, x, z * z), 0.0F));
}

/// Thigh, kneecap, shank, foot and toes of one side; returns the forward angle of the line from hip to ankle.
HWY_NOINLINE Wide pose_leg(const FootMotion& foot, const Foothold& at, const PelvisPlace& root,
                           const PelvisMotion& motion, const Origin& origin, const WideQuat& facing, std::size_t side,
                           const Skeleton& skeleton, JointAngles<Lanes<float>>& angles, Feet<Lanes<float>>& feet) {
  using enum Segment;
  const Segment thigh = on_side(thigh_right, side), patella = on_side(patella_right, side);
  const Segment shank = on_side(shank_right, side), foot_segment = on_side(foot_right, side);
  const Segment toes = on_side(toes_right, side);
  const Wide& height = skeleton.height;
  const Wide upper = static_cast<float>(fraction::thigh) * height;
  const Wide lower = static_cast<float>(fraction::shank) * height;

  // In the frame of the stance foothold, then turned into the pelvis's heading: small numbers, so that the knee keeps
  // its digits however far somebody walks.
  const WideVec& hip = motion.hip[side];
  const Wide dx = at.ankle.left - root.position.x, dz = at.ankle.forward - root.position.z;
  const WideVec d = {fnma(dz, root.sine, dx * root.cosine) - hip.x, foot.ankle_up - root.position.y - hip.y,
                     fma(dx, root.sine, dz * root.cosine) - hip.z};
  const Wide across2 = fma(d.x, d.x, d.y * d.y);
  const Wide longest = (upper + lower) * 0.999999F;
  const Wide distance = min(sqrt(fma(d.z, d.z, across2)), longest);
  const Wide direction = atan2(d.z, sqrt(across2));
  const Wide aside = atan2(d.x, -d.y);
  // Where the knee's height over the hip–ankle line falls.
  const Wide near = fma(distance, distance, (upper - lower) * (upper + lower)) / (2.0F * distance);
  const Wide bulge = sqrt(max((upper - near) * (upper + near), 0.0F));
  const Wide thigh_angle = direction + atan2(bulge, near);
  const Wide shank_angle = direction - atan2(bulge, distance - near);
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
  const WideQuat outward = turn_y(yaw);
  const Ground ankle = turned(at.ankle.left, at.ankle.forward, origin.sine, origin.cosine);
  const WideQuat sole = outward * turn_x(-foot.pitch), toe_rotation = outward * turn_x(-(foot.pitch + foot.toes));
  const WideVec ankle_at = origin.position + WideVec{ankle.left, foot.ankle_up, ankle.forward};
  skeleton.put(foot_segment, ankle_at, sole);
  skeleton.hang(toes, toe_rotation);

  store(thigh_angle + motion.tilt, angles.hip_flexion[side]);
  store(flexion, angles.knee_flexion[side]);
  store(foot.pitch - shank_angle, angles.ankle_dorsiflexion[side]);
  constexpr auto tall = static_cast<float>(fraction::ankle_height);
  store(ankle_at + rotate(sole, scaled({0, -tall, -unit_foot::back}, height)), feet.heel_m[side]);
  store(skeleton.position(toes) + rotate(toe_rotation, scaled({0, -unit_foot::joint, 0}, height)), feet.toe_m[side]);
  store(skeleton.position(toes) + rotate(toe_rotation, scaled({0, -unit_foot::joint, unit_foot::toes}, height)),
        feet.tip_m[side]);
  return direction;
}

/// The column from the sacrum to the head, each vertebra turned a little on the one below: the pelvis's turn is undone
/// and, up to the shoulders, reversed; from there to the head, which stays in the walking plane, undone again.
HWY_NOINLINE void pose_column(const WideQuat& facing, const Wide& turned_back, const Wide& lean,
                              const Skeleton& skeleton) {
  constexpr std::size_t first = index(Segment::L5), shoulders = index(Segment::T1), head = index(Segment::head);
  // The sacrum's plate faces up in somebody who stands, whose pelvis laboratories find tilted.
  constexpr HalfAngle level = half_of(-neutral_tilt);
  const WideQuat base = skeleton.rotation(Segment::pelvis) * turn_x(level);
  const WideQuat chest = facing * (turn_y(turned_back) * turn_x(lean));
  for (std::size_t s = first; s <= shoulders; ++s) {
    constexpr ColumnParts parts = column_parts();
    const auto part = static_cast<float>(parts[s - first]);
    const WideQuat turned = part_way(base, chest, wide(part));
    if (s == first) {
      const WideVec offset = scaled(unit_skeleton.joint_offset[s], skeleton.height);
      skeleton.put(static_cast<Segment>(s), skeleton.position(Segment::pelvis) + rotate(base, offset), turned);
    } else {
      skeleton.hang(static_cast<Segment>(s), turned);
    }
  }
  for (std::size_t s = shoulders + 1; s <= head; ++s) {
    const float part = static_cast<float>(s - shoulders) / static_cast<float>(head - shoulders);
    skeleton.hang(static_cast<Segment>(s), part_way(chest, facing, wide(part)));
  }
}

/// What both arms share.
struct ArmManner {
  Wide back, forward, elbow_back, elbow_forward, abduction, pronation, fingers;
};

/// One arm; `ahead` is the place of the opposite leg in its range, 0 back to 1 forward.
HWY_NOINLINE void pose_arm(const ArmManner& arm_manner, const Wide& ahead, std::size_t side, const Skeleton& skeleton,
                           JointAngles<Lanes<float>>& angles) {
  using enum Segment;
  auto of = [&](Segment s) { return on_side(s, side); };
  const float out = side == Side::left ? 1.0F : -1.0F;
  const Wide shoulder = fma(ahead, arm_manner.forward + arm_manner.back, -arm_manner.back);
  const Wide elbow = fma(ahead, arm_manner.elbow_forward - arm_manner.elbow_back, arm_manner.elbow_back);
  const Wide pronation = arm_manner.pronation * -out;

  const WideQuat trunk = skeleton.rotation(T1);
  skeleton.hang(of(clavicle_right), trunk);
  // A part of the pronation is the upper arm's inward turn.
  const WideQuat arm = trunk * (turn_z(arm_manner.abduction * out) * (turn_x(-shoulder) * turn_y(0.3F * pronation)));
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

HWY_INLINE Foothold foothold_of(const WideMask& stands, const Foothold& stance, const Foothold& other) {
  return {
      {select(stands, stance.ankle.left, other.ankle.left), select(stands, stance.ankle.forward, other.ankle.forward)},
      select(stands, stance.heading, other.heading)};
}

HWY_INLINE FootMotion foot_of(const WideMask& stands, const FootMotion& stance, const FootMotion& other) {
  return {select(stands, stance.pitch, other.pitch),
          select(stands, stance.toes, other.toes),
          select(stands, stance.toe_out, other.toe_out),
          select(stands, stance.ankle_up, other.ankle_up),
          select(stands, stance.ankle_out, other.ankle_out),
          select(stands, stance.ankle_forward, other.ankle_forward),
          other.part,
          other.swung,
          select(stands, wide(0.0F), other.in_the_air)};
}

/// The hips give way to legs that a turn moves aside, so that the centre of mass keeps to the line: by this part of how
/// far the ankles are moved.
constexpr float give_way = 0.03F;

/// How much further to the left of the line a foot is than in a straight walk.
HWY_INLINE Wide beside(const OnLine& on, const PelvisPlace& root, const Foothold& at, const Wide& straight) {
  return fma(at.ankle.left - on.place.left, root.cosine, (on.place.forward - at.ankle.forward) * root.sine) - straight;
}

void pose_block(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                const GaitState<Lanes<float>>& state, Pose<Lanes<float>>& pose, JointAngles<Lanes<float>>& angles,
                Feet<Lanes<float>>& feet) {
  const Wide one = wide(1.0F), zero = wide(0.0F);
  const Skeleton skeleton{load(size.height_m), pose};
  const Wide time = load(state.time_s);
  const WideMask right_stands = equal(state.stance_side, Side::right),
                 left_stands = equal(state.stance_side, Side::left);
  const Wide u = time / load(plan.duration_s), eased = smooth(u), phase = step_phase(plan, u);
  const StepWaves waves = step_waves(phase);
  const MixedShape of{plan.from.shape, plan.to.shape, mixed_part(plan, phase)};
  const PelvisMotion motion = pelvis_motion(plan, waves, eased, select(right_stands, one, -one), skeleton.height);
  const Line line = line_of(plan, state);

  PelvisPlace pelvis;
  const HipsPlace hips = hips_place(plan, of, u, phase, waves);
  const Wide aside = select(right_stands, hips.aside, -hips.aside);
  const OnLine on = on_line(line, hips.forward, phase, eased);
  const Wide up =
      hips_height(plan, of, skeleton.height, u, waves) -
      mix(select(stands(plan.from), zero,
                 longer_leg(line.from.length_m, line.turned_before, line.shift_before, line.shift, skeleton.height)),
          select(stands(plan.to), zero,
                 longer_leg(line.to.length_m, line.turn, line.shift, line.shift_next, skeleton.height)),
          eased);
  pelvis.heading = on.heading;
  sin_cos(pelvis.heading, pelvis.sine, pelvis.cosine);

  const FootMotion stance = stance_foot(plan, of, skeleton.height, phase);
  const FootMotion other = other_foot(plan, of, skeleton.height, phase);
  const Wide out = select(left_stands, one, -one);  // the stance foot's side
  const Foothold standing_at = stance_foothold(line, stance, out), other_at = other_foothold(line, other, -out);
  const Wide rest = shift_at_rest(plan, line, eased);
  const Wide way_aside = aside + rest -
                         give_way * (beside(on, pelvis, standing_at, rest + out * stance.ankle_out) +
                                     beside(on, pelvis, other_at, rest - out * other.ankle_out));
  const Ground way = turned(way_aside, hips.ahead, pelvis.sine, pelvis.cosine);
  const Ground place = {on.place.left + way.left, on.place.forward + way.forward};
  pelvis.position = {place.left, up, place.forward};
  FootMotion foot[2];
  Foothold at[2];
  for (std::size_t side = 0; side < 2; ++side) {
    const WideMask stands = side == Side::right ? right_stands : left_stands;
    foot[side] = foot_of(stands, stance, other);
    at[side] = foothold_of(stands, standing_at, other_at);
    draw_in(foot[side], at[side], pelvis, motion, side, skeleton.height);
  }
  // Where a leg would be too short, in a turn or at a very slow walk, the pelvis sinks.
  const Wide rounding = 0.0002F * skeleton.height;
  auto limit = [&](std::size_t side) {
    return highest_hips(foot[side], at[side], pelvis, motion, side, skeleton.height);
  };
  pelvis.position.y = lower_of(pelvis.position.y, lower_of(limit(Side::right), limit(Side::left), rounding), rounding);

  Origin origin = {{load(state.line_x_m), zero, load(state.line_z_m)}, load(state.heading_rad), zero, zero};
  sin_cos(origin.heading, origin.sine, origin.cosine);
  const Ground world = turned(place.left, place.forward, origin.sine, origin.cosine);
  const WideQuat facing = turn_y(origin.heading + pelvis.heading);
  skeleton.put(Segment::pelvis, origin.position + WideVec{world.left, pelvis.position.y, world.forward},
               facing * motion.turn);

  Wide leg[2];
  for (std::size_t side = 0; side < 2; ++side) {
    const WideMask stands = side == Side::right ? right_stands : left_stands;
    leg[side] = pose_leg(foot[side], at[side], pelvis, motion, origin, facing, side, skeleton, angles, feet);
    store(0.5F * select(stands, u, u + 1.0F), feet.phase[side]);
  }

  const Manner<Lanes<float>>&from = plan.from.manner, &to = plan.to.manner;
  pose_column(facing, -manner(from.shoulder_rotation, to.shoulder_rotation, eased) * motion.rotation,
              harmonics(of, step_shape::trunk, 3, waves), skeleton);
  const ArmManner arms = {manner(from.arm_back, to.arm_back, eased),
                          manner(from.arm_forward, to.arm_forward, eased),
                          manner(from.elbow_back, to.elbow_back, eased),
                          manner(from.elbow_forward, to.elbow_forward, eased),
                          manner(from.arm_abduction, to.arm_abduction, eased),
                          manner(from.forearm_pronation, to.forearm_pronation, eased),
                          manner(from.finger_flexion, to.finger_flexion, eased)};
  const Wide leg_back = manner(from.leg_back, to.leg_back, eased);
  const Wide per_range = 1.0F / max(manner(from.leg_forward, to.leg_forward, eased) - leg_back, 1e-3F);
  for (std::size_t side = 0; side < 2; ++side)
    pose_arm(arms, (leg[1 - side] - leg_back) * per_range, side, skeleton, angles);
  store(motion.rotation, angles.pelvis_rotation);
  store(motion.list, angles.pelvis_list);
  store(motion.tilt, angles.pelvis_tilt);
}

void centre_block(const BodySize<Lanes<float>>& size, const Pose<Lanes<float>>& pose,
                  CentreOfMass<Lanes<float>>& centre) {
  const Wide height = load(size.height_m), extra = load(size.extra_fat);
  WideVec sum = {wide(0.0F), wide(0.0F), wide(0.0F)};
  for (std::size_t s = 0; s < segment_count; ++s) {
    const WideVec c = rotate(load(pose.rotation[s]), scaled(unit_skeleton.centre_of_mass[s], height));
    const Wide mass = fma(extra, wide(unit_skeleton.mass_per_extra_fat[s]), wide(unit_skeleton.mass_fraction[s]));
    sum = fma(mass, load(pose.position_m[s]) + c, sum);
  }
  store(sum, centre.position_m);
}

}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil {

HWY_EXPORT(pose_block);
HWY_EXPORT(centre_block);

void pose_skeleton(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                   const GaitState<Lanes<float>>& state, Pose<Lanes<float>>& pose, JointAngles<Lanes<float>>& angles,
                   Feet<Lanes<float>>& feet) {
  HWY_DYNAMIC_DISPATCH(pose_block)(size, plan, state, pose, angles, feet);
}

void centre_of_mass(const BodySize<Lanes<float>>& size, const Pose<Lanes<float>>& pose,
                    CentreOfMass<Lanes<float>>& centre) {
  HWY_DYNAMIC_DISPATCH(centre_block)(size, pose, centre);
}

}  // namespace mobil
#endif
