#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include <mobil/anthropometry.h>
#include "assets/gait/leg_model.h"
#include "assets/gait/sole-inl.h"
#include "assets/gait/uneven-inl.h"
#include "engine/wide_geometry-inl.h"
#include "systems/forces/forces.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

namespace contact {
/// Height above the ground from which a point of a sole bears no load.
constexpr float high_m = 0.03F;
/// A point bears full load up to the first speed and no load from the second one.
constexpr float still_m_s = 0.3F, moving_m_s = 1.2F;
/// Largest free moment of a foot over its load: friction 0.8 times a mean distance of 6 cm from the centre of pressure.
constexpr float twist_m = 0.05F;
}  // namespace contact

/// A vector in a vertical plane.
struct Flat {
  Wide ahead, up;
};

HWY_INLINE Flat operator+(const Flat& a, const Flat& b) {
  return {a.ahead + b.ahead, a.up + b.up};
}
HWY_INLINE Flat operator-(const Flat& a, const Flat& b) {
  return {a.ahead - b.ahead, a.up - b.up};
}
HWY_INLINE Flat operator*(const Wide& s, const Flat& a) {
  return {s * a.ahead, s * a.up};
}
/// Moment of a force at an arm, about the axis to the left. A positive moment turns the upper end forward.
HWY_INLINE Wide moment(const Flat& arm, const Flat& force) {
  return fnma(arm.ahead, force.up, arm.up * force.ahead);
}

/// Vertical plane in which moments are taken.
struct Plane {
  Wide x, z;
  HWY_INLINE Flat of(const WideVec& v) const { return {fma(v.x, x, v.z * z), v.y}; }
};

/// Forces on the feet, centres of pressure and free moments there, in the frame of the stance foothold.
struct Support {
  WideVec force[2], centre[2];
  Wide free_moment[2];
};

/// A foot on the ground: position of the ankle of the flat foot, pointing direction, reach of the bearing part from
/// there, and the position along the foot where the walk presses it.
struct Sole {
  Wide x, z, along_x, along_z;
  SoleReach reach;
  Wide pressed;
};

/// Returns the foot of the right (right_one = 1) or left side (0), without `pressed`.
HWY_NOINLINE Sole sole_at(const BodyMotion<Lanes<float>>& motion, const Wide& right_one, const Wide& height) {
  auto side = [&](const Lanes<float>& of_right, const Lanes<float>& of_left) {
    return select(right_one > 0.0F, load(of_right), load(of_left));
  };
  const Vec3<Lanes<float>>& right_ankle = motion.place_m[leg_point(Side::right, ankle_point)];
  const Vec3<Lanes<float>>& left_ankle = motion.place_m[leg_point(Side::left, ankle_point)];
  Sole s;
  s.along_x = side(motion.foot_x[Side::right], motion.foot_x[Side::left]);
  s.along_z = side(motion.foot_z[Side::right], motion.foot_z[Side::left]);
  const Wide pitch = side(motion.foot_pitch[Side::right], motion.foot_pitch[Side::left]);
  const Wide rolled = planted_ankle(height, pitch).along.value;
  s.x = fnma(rolled, s.along_x, side(right_ankle.x, left_ankle.x));
  s.z = fnma(rolled, s.along_z, side(right_ankle.z, left_ankle.z));
  s.reach = sole_reach(height, pitch);
  return s;
}

/// Returns a foot with `pressed` at a phase of its cycle, by the shape parameters `of`. Toe-off is at phase `off`.
template <class Shape>
HWY_NOINLINE Sole sole_of(const Shape& of, const BodyMotion<Lanes<float>>& motion, const Wide& right_one,
                          const Wide& height, const Wide& cycle, const Wide& off) {
  Sole s = sole_at(motion, right_one, height);
  s.pressed = pressed(of, height, cycle / off);
  return s;
}

/// Part of the weight that a foot has taken over at part `u` of double support.
template <class Shape>
HWY_INLINE Wide taken(const Shape& of, const Wide& u) {
  const Wide rest = 1.0F - u;
  const Wide tail = fma(u, fma(u, of(step_shape::share, 2), of(step_shape::share, 1)), of(step_shape::share, 0));
  return 1.0F - rest * rest * fma(u, tail, wide(1.0F));
}

/// Planned share of the weight on the stance foot, and the force that pushes the feet apart, as a part of the weight.
struct Shares {
  Wide stance, push;
};

HWY_NOINLINE Shares planned_shares(const StepPlan<Lanes<float>>& plan, const Wide& phase) {
  const OneShape from{plan.from.shape};
  const Wide off = load(plan.double_support), landing = load(plan.landing);
  const WideMask from_stands = stands(plan.from), to_stands = stands(plan.to);
  const Wide u = clamp(phase / max(off, 1e-3F), 0.0F, 1.0F), x = 2.0F * u - 1.0F;
  const Wide left_over = 0.5F * smooth((phase - landing) / max(1.0F - landing, 1e-3F));
  const Wide stance = select(from_stands, 0.5F + 0.5F * smooth(u), taken(from, u));
  const Wide apart =
      from(step_shape::split, 1) + x * from(step_shape::split, 2) + (1.5F * x * x - 0.5F) * from(step_shape::split, 3);
  return {select(landing <= 0.0F, wide(0.5F), select(to_stands, stance - left_over, stance)),
          select(from_stands, wide(0.0F), 4.0F * u * (1.0F - u) * apart)};
}

/// Point where the ground must press so that its moment equals that of the motion.
struct Pressed {
  Wide x, z;
};
HWY_INLINE Pressed balancing(const BodyMotion<Lanes<float>>& motion, const WideVec& total) {
  const WideVec moment = load(motion.moment_per_kg);
  const Wide lift = max(total.y, 1.0F);
  return {moment.z / lift, -(moment.x / lift)};
}

/// Computes the forces of both feet, whose sum is the motion's total, and the points where they act. `split(balanced)`
/// returns the first foot's share from the share that balances the motion with the centres at `pressed`. `split_again`
/// does so after the centres have moved, if both feet bear load. `push` is the forward force of the first foot and the
/// backward force of the other, per kg. The forces lean toward a point at the height `pivot`.
template <class Split, class SplitAgain>
HWY_INLINE void press(const BodySize<Lanes<float>>& size, const BodyMotion<Lanes<float>>& motion, const WideVec& total,
                      const Sole (&soles)[2], const Split& split, const SplitAgain& split_again, const Wide& push,
                      const Wide& pivot, WideVec (&force)[2], WideVec (&centre)[2]) {
  const Wide zero = wide(0.0F), one = wide(1.0F), height = load(size.leg_scale_m), mass = load(size.mass_kg);
  const Pressed wanted = balancing(motion, total);
  Wide x[2], z[2];
  for (std::size_t k = 0; k < 2; ++k) {
    x[k] = fma(soles[k].pressed, soles[k].along_x, soles[k].x);
    z[k] = fma(soles[k].pressed, soles[k].along_z, soles[k].z);
  }
  auto balanced = [&] {
    const Wide apart_x = x[0] - x[1], apart_z = z[0] - z[1];
    const Wide apart2 = max(fma(apart_x, apart_x, apart_z * apart_z), wide(1e-6F));
    return clamp(fma(wanted.x - x[1], apart_x, (wanted.z - z[1]) * apart_z) / apart2, 0.0F, 1.0F);
  };
  Wide share[2] = {split(balanced()), zero};
  share[1] = one - share[0];
  const Wide lacking_x = wanted.x - fma(share[0], x[0], share[1] * x[1]);
  const Wide lacking_z = wanted.z - fma(share[0], z[0], share[1] * z[1]);
  const Wide half_width = wide(sole::half_width) * height;
  for (std::size_t k = 0; k < 2; ++k) {
    const Sole& s = soles[k];
    const Wide along =
        min(max(s.pressed + fma(lacking_x, s.along_x, lacking_z * s.along_z), s.reach.back), s.reach.front);
    const Wide aside = min(max(fma(lacking_x, s.along_z, -(lacking_z * s.along_x)), -half_width), half_width);
    x[k] = fma(along, s.along_x, fma(aside, s.along_z, s.x));
    z[k] = fma(along, s.along_z, fnma(aside, s.along_x, s.z));
  }
  // In double support the shares balance the remainder.
  const WideMask both = (share[0] > 0.001F) & (share[0] < 0.999F);
  share[0] = select(both, split_again(balanced()), share[0]);
  share[1] = one - share[0];

  const Wide mean_x = fma(share[0], x[0], share[1] * x[1]), mean_z = fma(share[0], z[0], share[1] * z[1]);
  for (std::size_t k = 0; k < 2; ++k) {
    const Wide up = share[k] * total.y, lean = up / pivot;
    force[k] = {mass * fma(lean, mean_x - x[k], share[k] * total.x), mass * up,
                mass * (fma(lean, mean_z - z[k], share[k] * total.z) + (k == 0 ? push : -push))};
    centre[k] = {x[k], zero, z[k]};
  }
}

/// Gives the feet free moments that balance the motion about the vertical, in proportion to their loads.
HWY_NOINLINE void put_free_moments(const BodySize<Lanes<float>>& size, const BodyMotion<Lanes<float>>& motion,
                                   Support& ground) {
  Wide lacking = load(size.mass_kg) * load(motion.moment_per_kg.y), lift = wide(1.0F);
  for (std::size_t side = 0; side < 2; ++side) {
    const WideVec &f = ground.force[side], &c = ground.centre[side];
    lacking = lacking - fma(c.z, f.x, -(c.x * f.z));
    lift = lift + f.y;
  }
  for (std::size_t side = 0; side < 2; ++side) {
    const Wide& load_n = ground.force[side].y;
    const Wide most = contact::twist_m * load_n;
    // Adding zero makes −0 of a foot in the air +0, because machines disagree which of the two is the smaller.
    ground.free_moment[side] = min(max(lacking * (load_n / lift), -most), most) + wide(0.0F);
  }
}

/// Computes the total ground force on walkers, its split and the points where it acts.
HWY_NOINLINE void support(const BodySize<Lanes<float>>& size, const BodyMotion<Lanes<float>>& motion,
                          const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state, Support& out) {
  const Wide zero = wide(0.0F), one = wide(1.0F), height = load(size.leg_scale_m);
  const Wide phase = step_phase(plan, load(state.time_s) / load(plan.duration_s));
  const MixedShape of{plan.from.shape, plan.to.shape, mixed_part(plan, phase)};
  const Wide off = load(plan.double_support);
  const Wide right_stands = select(equal(state.stance_side, Side::right), one, zero);
  const Wide stance_off = 0.5F + mix(load(plan.from.double_support), load(plan.to.double_support), of.part);
  const Sole soles[2] = {
      sole_of(of, motion, right_stands, height, 0.5F * phase, stance_off),
      sole_of(OneShape{plan.from.shape}, motion, one - right_stands, height, 0.5F + 0.5F * phase, 0.5F + 0.5F * off)};
  const Shares planned = planned_shares(plan, phase);
  const WideMask stands = load(plan.landing) <= 0.0F;  // people standing still use the balancing share
  const Wide pivot =
      (forces::pivot_height + of(step_shape::split, 0)) * max(load(motion.centre_height_m), 0.1F * height);
  WideVec force[2], centre[2];
  press(
      size, motion, load(motion.force_per_kg), soles,
      [&](const Wide& balanced) HWY_ATTR { return select(stands, balanced, planned.stance); },
      [](const Wide& balanced) HWY_ATTR { return balanced; }, forces::gravity * planned.push, pivot, force, centre);
  auto of_side = [&](const WideVec(&stance_first)[2], std::size_t side) {
    const WideMask first = side == Side::right ? right_stands > 0.0F : right_stands <= 0.0F;
    const WideVec &a = stance_first[0], &b = stance_first[1];
    return WideVec{select(first, a.x, b.x), select(first, a.y, b.y), select(first, a.z, b.z)};
  };
  for (std::size_t side = 0; side < 2; ++side) {
    out.force[side] = of_side(force, side);
    out.centre[side] = of_side(centre, side);
  }
  put_free_moments(size, motion, out);
}

/// Part of a foot's lowest points that is near the ground and at rest, 0 to 1, and height of the lowest point.
struct Contact {
  Wide part, lowest;
};

/// Checks points under the heel, the ball and the tips of the toes (as in Feet).
HWY_NOINLINE Contact contact_of(const Wide& height, const Pose<Lanes<float>>& before, const Pose<Lanes<float>>& now,
                                const Pose<Lanes<float>>& after, std::size_t side, float apart_s) {
  namespace f = fraction;
  struct Point {
    Segment segment;
    double up, ahead;
  };
  using enum Segment;
  constexpr Point points[] = {{foot_right, -f::ankle_height, -f::heel_back},
                              {toes_right, -f::toe_joint_height, 0},
                              {toes_right, -f::toe_joint_height, f::toes_length}};
  const Wide zero = wide(0.0F);
  Wide up[3], slow[3];
  for (std::size_t p = 0; p < 3; ++p) {
    const std::size_t s = index(on_side(points[p].segment, side));
    const WideVec own = {zero, height * static_cast<float>(points[p].up), height * static_cast<float>(points[p].ahead)};
    auto place = [&](const Pose<Lanes<float>>& pose)
                     HWY_ATTR { return load(pose.position_m[s]) + rotate(load(pose.rotation[s]), own); };
    const WideVec moved = place(after) - place(before);
    up[p] = place(now).y;
    slow[p] = 1.0F - smooth((length(moved) * wide(0.5F / apart_s) - contact::still_m_s) *
                            wide(1.0F / (contact::moving_m_s - contact::still_m_s)));
  }
  const Wide lowest = min(up[0], min(up[1], up[2]));
  Wide part = zero;
  for (std::size_t p = 0; p < 3; ++p) part = max(part, slow[p] * (1.0F - smooth(up[p] * wide(1.0F / contact::high_m))));
  return {part, lowest};
}

/// Computes the ground forces on posed people, in a frame whose floor is the ground.
HWY_NOINLINE void posed_support(const BodySize<Lanes<float>>& size, const BodyMotion<Lanes<float>>& motion,
                                const Pose<Lanes<float>>& before, const Pose<Lanes<float>>& now,
                                const Pose<Lanes<float>>& after, float apart_s, Support& out) {
  const Wide zero = wide(0.0F), one = wide(1.0F), height = load(size.leg_scale_m);
  WideVec total = load(motion.force_per_kg);
  const WideMask pulls = total.y <= 0.0F;  // the ground does not pull
  total = {select(pulls, zero, total.x), select(pulls, zero, total.y), select(pulls, zero, total.z)};
  const Pressed wanted = balancing(motion, total);
  Sole soles[2];
  Contact contact[2];
  for (std::size_t side = 0; side < 2; ++side) {
    Sole& s = soles[side];
    s = sole_at(motion, side == Side::right ? one : zero, height);
    // Each centre is as near to the balancing point as its sole reaches: front foot at the heel, rear foot at the toes.
    s.pressed = min(max(fma(wanted.x - s.x, s.along_x, (wanted.z - s.z) * s.along_z), s.reach.back), s.reach.front);
    contact[side] = contact_of(height, before, now, after, side, apart_s);
  }
  // With no foot at rest near the ground, a person stands on the lower foot.
  const WideMask right_is_lower = contact[Side::right].lowest <= contact[Side::left].lowest;
  const Wide right_bears = contact[Side::right].part + select(right_is_lower, wide(1e-4F), zero);
  const Wide left_bears = contact[Side::left].part + select(right_is_lower, zero, wide(1e-4F));
  auto split = [&](const Wide& balanced) HWY_ATTR {
    const Wide on_right = right_bears * (balanced + 1e-3F), on_left = left_bears * (1.001F - balanced);
    return on_right / (on_right + on_left);
  };
  const Wide pivot = forces::pivot_height * max(load(motion.centre_height_m), 0.1F * height);
  press(size, motion, total, soles, split, split, zero, pivot, out.force, out.centre);
  put_free_moments(size, motion, out);
}

HWY_INLINE Wide mass_of_rod(const BodySize<Lanes<float>>& size, const forces::Rod& rod) {
  return load(size.mass_kg) * load(size.*rod.mass);
}

/// Computes hip, knee and ankle moments of one leg, from the foot up.
HWY_NOINLINE void leg_moments(const BodySize<Lanes<float>>& size, const BodyMotion<Lanes<float>>& motion,
                              const Support& ground, std::size_t side, Wide* hip_knee_ankle) {
  const Plane plane = {load(motion.facing_x), load(motion.facing_z)};
  Flat at[leg_points], push[leg_points];  // positions, and accelerations minus gravity
  for (std::size_t p = 0; p < leg_points; ++p) {
    const std::size_t i = leg_point(side, static_cast<LegPoint>(p));
    at[p] = plane.of(load(motion.place_m[i]));
    push[p] = plane.of(load(motion.acceleration[i]));
    push[p].up = push[p].up + wide(forces::gravity);
  }
  const auto mass_of = [&](const forces::Rod& rod) { return mass_of_rod(size, rod); };
  // Rate of angular momentum of a rod: mass · gyration² · (rod × difference of its ends' accelerations).
  auto spin = [&](const forces::Rod& rod, std::size_t upper, std::size_t lower) {
    return mass_of(rod) * wide(rod.gyration * rod.gyration) * moment(at[lower] - at[upper], push[lower] - push[upper]);
  };
  const Flat reaction = plane.of(ground.force[side]), centre = plane.of(ground.centre[side]);
  const Flat foot_force = mass_of(forces::foot) * push[foot_centre_point];
  Wide turning = moment(at[foot_centre_point] - at[ankle_point], foot_force) -
                 moment(centre - at[ankle_point], reaction) + spin(forces::foot, ankle_point, ball_point);
  Flat through = foot_force - reaction;
  hip_knee_ankle[2] = turning;
  auto climb = [&](const forces::Rod& rod, std::size_t upper, std::size_t lower) {
    const Flat own = mass_of(rod) * (push[upper] + wide(rod.centre) * (push[lower] - push[upper]));
    const Flat length = at[lower] - at[upper];
    turning = turning + moment(length, through) + moment(wide(rod.centre) * length, own) + spin(rod, upper, lower);
    through = through + own;
  };
  climb(forces::shank, knee_point, ankle_point);
  hip_knee_ankle[1] = -turning;
  climb(forces::thigh, hip_point, knee_point);
  hip_knee_ankle[0] = turning;
}

/// Returns the whole moment of the pelvis on the leg at the hip, by the same rods in three dimensions.
HWY_NOINLINE WideVec hip_moment(const BodySize<Lanes<float>>& size, const BodyMotion<Lanes<float>>& motion,
                                const Support& ground, std::size_t side) {
  const Wide zero = wide(0.0F);
  WideVec at[leg_points], push[leg_points];  // positions, and accelerations minus gravity
  for (std::size_t p = 0; p < leg_points; ++p) {
    const std::size_t i = leg_point(side, static_cast<LegPoint>(p));
    at[p] = load(motion.place_m[i]);
    push[p] = load(motion.acceleration[i]);
    push[p].y = push[p].y + wide(forces::gravity);
  }
  const auto mass_of = [&](const forces::Rod& rod) { return mass_of_rod(size, rod); };
  const WideVec hip = at[hip_point];
  const WideVec none = {zero, zero, zero};
  WideVec moment = cross(at[foot_centre_point] - hip, fma(mass_of(forces::foot), push[foot_centre_point], none)) -
                   cross(ground.centre[side] - hip, ground.force[side]);
  auto add = [&](const forces::Rod& rod, std::size_t upper, std::size_t lower, bool has_weight) {
    const WideVec along = at[lower] - at[upper], faster = push[lower] - push[upper];
    moment = fma(mass_of(rod) * wide(rod.gyration * rod.gyration), cross(along, faster), moment);
    if (!has_weight) return;
    const WideVec centre = fma(wide(rod.centre), along, at[upper]), own = fma(wide(rod.centre), faster, push[upper]);
    moment = fma(mass_of(rod), cross(centre - hip, own), moment);
  };
  add(forces::foot, ankle_point, ball_point, false);
  add(forces::shank, knee_point, ankle_point, true);
  add(forces::thigh, hip_point, knee_point, true);
  return moment - WideVec{zero, ground.free_moment[side], zero};
}

void put_moments(const BodySize<Lanes<float>>& size, const BodyMotion<Lanes<float>>& motion, const Support& ground,
                 JointMoments<Lanes<float>>& moments) {
  for (std::size_t side = 0; side < 2; ++side) {
    Wide joint[3];
    leg_moments(size, motion, ground, side, joint);
    store(joint[0], moments.hip_nm[side]);
    store(joint[1], moments.knee_nm[side]);
    store(joint[2], moments.ankle_nm[side]);
    const WideVec whole = hip_moment(size, motion, ground, side);
    const Wide outward = wide(side == Side::left ? 1.0F : -1.0F);
    store(outward * fma(whole.x, load(motion.facing_x), whole.z * load(motion.facing_z)),
          moments.hip_abduction_nm[side]);
    store(-outward * whole.y, moments.hip_rotation_nm[side]);
  }
}

/// Projects centres of pressure onto the ground under each foot. The split between the feet stays that of level ground.
HWY_NOINLINE void put_centres(const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state,
                              const Footing<Lanes<float>>& footing, Support& ground) {
  const Slopes slopes = slopes_of(footing, load(state.heading_rad));
  const Line line = line_of(plan, state);
  const Wide zero = wide(0.0F), one = wide(1.0F);
  const Wide phase = step_phase(plan, load(state.time_s) / load(plan.duration_s));
  const Wide landed = select(phase < load(plan.double_support), zero, one);
  const Wide left_stands = select(equal(state.stance_side, Side::left), one, zero), out = 2.0F * left_stands - one;
  const Slope other = part_way(slopes.leaving, slopes.landing, landed);
  const Ground other_at = flat_other(plan, line, landed, -out);
  const Ground stance_at = {fma(out, load(plan.from.half_width_m), line.shift), zero};
  for (std::size_t side = 0; side < 2; ++side) {
    const Wide stands = side == Side::left ? left_stands : one - left_stands;
    const Slope slope = part_way(other, slopes.stance, stands);
    const Ground unmoved = part_way(other_at, stance_at, stands);
    const Ground from = {unmoved.left + slope.moved_left, unmoved.forward + slope.moved_along};
    WideVec& at = ground.centre[side];
    at.y = fma(slope.left, at.x - from.left, fma(slope.along, at.z - from.forward, slope.height));
  }
}

void forces_block(const BodySize<Lanes<float>>& size, const BodyMotion<Lanes<float>>& motion,
                  const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state,
                  const Footing<Lanes<float>>* footing, GroundReaction<Lanes<float>>& reaction,
                  JointMoments<Lanes<float>>& moments) {
  Support ground;
  support(size, motion, plan, state, ground);
  const bool uneven = footing != nullptr;
  if (uneven) put_centres(plan, state, *footing, ground);
  Wide s, c;
  sin_cos(load(state.heading_rad), s, c);
  const Wide line_x = load(state.line_x_m), line_z = load(state.line_z_m);
  const Wide floor = uneven ? load(footing->height_m[index(FootholdOf::stance)]) : wide(0.0F);
  for (std::size_t side = 0; side < 2; ++side) {
    const WideVec &f = ground.force[side], &p = ground.centre[side];
    store(WideVec{fma(f.x, c, f.z * s), f.y, fnma(f.x, s, f.z * c)}, reaction.force_n[side]);
    store(WideVec{line_x + fma(p.x, c, p.z * s), uneven ? floor + p.y : p.y, line_z + fnma(p.x, s, p.z * c)},
          reaction.centre_m[side]);
    store(ground.free_moment[side], reaction.free_moment_nm[side]);
  }
  put_moments(size, motion, ground, moments);
}

void posed_block(const BodySize<Lanes<float>>& size, const BodyMotion<Lanes<float>>& motion,
                 const Pose<Lanes<float>>& before, const Pose<Lanes<float>>& now, const Pose<Lanes<float>>& after,
                 float apart_s, GroundReaction<Lanes<float>>& reaction, JointMoments<Lanes<float>>& moments) {
  Support ground;
  posed_support(size, motion, before, now, after, apart_s, ground);
  for (std::size_t side = 0; side < 2; ++side) {
    store(ground.force[side], reaction.force_n[side]);
    store(ground.centre[side], reaction.centre_m[side]);
    store(ground.free_moment[side], reaction.free_moment_nm[side]);
  }
  put_moments(size, motion, ground, moments);
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {

HWY_EXPORT(forces_block);
HWY_EXPORT(posed_block);

void joint_forces(const BodySize<Lanes<float>>& size, const BodyMotion<Lanes<float>>& motion,
                  const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state,
                  const Footing<Lanes<float>>* footing, GroundReaction<Lanes<float>>& reaction,
                  JointMoments<Lanes<float>>& moments) {
  HWY_DYNAMIC_DISPATCH(forces_block)(size, motion, plan, state, footing, reaction, moments);
}

void posed_forces(const BodySize<Lanes<float>>& size, const BodyMotion<Lanes<float>>& motion,
                  const Pose<Lanes<float>>& before, const Pose<Lanes<float>>& now, const Pose<Lanes<float>>& after,
                  float apart_s, GroundReaction<Lanes<float>>& reaction, JointMoments<Lanes<float>>& moments) {
  HWY_DYNAMIC_DISPATCH(posed_block)(size, motion, before, now, after, apart_s, reaction, moments);
}

}  // namespace mobil::inline v0_3
#endif
