#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/forces/forces.cpp"
#include <hwy/foreach_target.h>

#include "assets/body/anthropometry.h"
#include "engine/wide_geometry-inl.h"
#include "systems/forces/forces.h"
#include "systems/forces/leg_model.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {

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
/// Moment of a force at an arm, about the axis to the left: positive turns what is up forward.
HWY_INLINE Wide moment(const Flat& arm, const Flat& force) {
  return fnma(arm.ahead, force.up, arm.up * force.ahead);
}

/// The plane that moments are taken in.
struct Plane {
  Wide x, z;
  HWY_INLINE Flat of(const WideVec& v) const { return {fma(v.x, x, v.z * z), v.y}; }
};

/// A person now: tracked points, and their accelerations a tick ago.
struct Motion {
  WideVec now[tracked_points], acceleration[tracked_points];
};

/// What carries a person.
struct Support {
  WideVec force[2], centre[2];
};

HWY_INLINE WideVec centre_of(const BodySize<Lanes<float>>& size, const Pose<Lanes<float>>& pose, std::size_t segment) {
  const Wide height = load(size.height_m);
  const Vec3<double>& c = unit_body.centre_of_mass[segment];
  const WideVec own = {wide(static_cast<float>(c.x)) * height, wide(static_cast<float>(c.y)) * height,
                       wide(static_cast<float>(c.z)) * height};
  return load(pose.position_m[segment]) + rotate(load(pose.rotation[segment]), own);
}

HWY_NOINLINE void track(const BodySize<Lanes<float>>& size, const Pose<Lanes<float>>& pose,
                        const CentreOfMass<Lanes<float>>& centre, WideVec* now) {
  using enum Segment;
  now[0] = load(centre.position_m);
  for (std::size_t side = 0; side < 2; ++side) {
    auto of = [&](Segment s) { return index(on_side(s, side)); };
    now[tracked_point(side, hip_point)] = load(pose.position_m[of(thigh_right)]);
    now[tracked_point(side, knee_point)] = load(pose.position_m[of(shank_right)]);
    now[tracked_point(side, ankle_point)] = load(pose.position_m[of(foot_right)]);
    now[tracked_point(side, ball_point)] = load(pose.position_m[of(toes_right)]);
    const WideVec foot = centre_of(size, pose, of(foot_right)), toes = centre_of(size, pose, of(toes_right));
    now[tracked_point(side, foot_centre_point)] = fma(wide(forces::toes_of_foot), toes - foot, foot);
  }
}

/// Total force of the ground, and how it is split and where it acts, from the last tick's contacts.
HWY_NOINLINE void support(const BodySize<Lanes<float>>& size, const MotionHistory<Lanes<float>>& history,
                          const Motion& motion, float tick_s, Support& out) {
  const Wide zero = wide(0.0F), one = wide(1.0F), height = load(size.height_m), mass = load(size.mass_kg);
  const WideVec body = load(history.place_m[0]);
  const WideVec& a = motion.acceleration[0];
  const Wide lift = a.y + wide(forces::gravity);
  const WideVec total = {mass * a.x, mass * lift, mass * a.z};

  const WideVec travel = motion.now[0] - body + load(history.step_m[0]);
  const Wide rate = wide(0.5F / tick_s);
  const Wide speed2 = rate * rate * fma(travel.x, travel.x, travel.z * travel.z);
  const Wide froude = speed2 / (wide(forces::rest_froude * forces::gravity) * height);
  const Wide rest = one / fma(froude, froude, one);

  // Where the total makes no moment about the centre of mass, and the share that would bring it there.
  const Wide arm = body.y / max(lift, one);
  const Wide balance_x = fnma(arm, a.x, body.x), balance_z = fnma(arm, a.z, body.z);
  Wide x[2], z[2];
  for (std::size_t side = 0; side < 2; ++side) {
    x[side] = load(history.contact[side].x_m);
    z[side] = load(history.contact[side].z_m);
  }
  const Wide apart_x = x[right] - x[left], apart_z = z[right] - z[left];
  const Wide apart2 = max(fma(apart_x, apart_x, apart_z * apart_z), wide(1e-6F));
  const Wide balanced = clamp(fma(balance_x - x[left], apart_x, (balance_z - z[left]) * apart_z) / apart2, 0.0F, 1.0F);
  const Wide planned = load(history.load_right);
  const Wide on_both = wide(4.0F) * planned * (one - planned);
  const Wide share_right = fma(rest * on_both, balanced - planned, planned);
  const Wide share[2] = {share_right, one - share_right};
  const Wide lacking_x = rest * (balance_x - fma(share_right, apart_x, x[left]));
  const Wide lacking_z = rest * (balance_z - fma(share_right, apart_z, z[left]));

  const Wide half_width = wide(forces::half_sole_width) * height;
  for (std::size_t side = 0; side < 2; ++side) {
    const FootContact<Lanes<float>>& c = history.contact[side];
    const Wide along_x = load(c.along_x), along_z = load(c.along_z);
    const Wide along = min(max(fma(lacking_x, along_x, lacking_z * along_z), -load(c.back_m)), load(c.ahead_m));
    const Wide aside = min(max(fma(lacking_x, along_z, -(lacking_z * along_x)), -half_width), half_width);
    x[side] = fma(along, along_x, fma(aside, along_z, x[side]));
    z[side] = fma(along, along_z, fnma(aside, along_x, z[side]));
  }
  const Wide mean_x = fma(share[right], x[right], share[left] * x[left]);
  const Wide mean_z = fma(share[right], z[right], share[left] * z[left]);
  const Wide pivot = wide(forces::pivot_height) * max(body.y, wide(0.1F) * height);
  for (std::size_t side = 0; side < 2; ++side) {
    const Wide up = share[side] * total.y, lean = up / pivot;
    out.force[side] = {fma(lean, mean_x - x[side], share[side] * total.x), up,
                       fma(lean, mean_z - z[side], share[side] * total.z)};
    out.centre[side] = {x[side], zero, z[side]};
  }
}

/// Hip, knee and ankle moments of one leg a tick ago, from the foot up.
HWY_NOINLINE void leg_moments(const BodySize<Lanes<float>>& size, const MotionHistory<Lanes<float>>& history,
                              const Motion& motion, const Support& ground, std::size_t side, Wide* hip_knee_ankle) {
  const Plane plane = {load(history.forward_x), load(history.forward_z)};
  const Wide mass = load(size.mass_kg);
  Flat at[leg_points], push[leg_points];  // places, and accelerations against gravity
  for (std::size_t p = 0; p < leg_points; ++p) {
    const std::size_t i = tracked_point(side, static_cast<LegPoint>(p));
    at[p] = plane.of(load(history.place_m[i]));
    push[p] = plane.of(motion.acceleration[i]);
    push[p].up = push[p].up + wide(forces::gravity);
  }
  // A rod's rate of angular momentum: mass · gyration² · (rod × difference of its ends' accelerations).
  auto spin = [&](const forces::Rod& rod, std::size_t upper, std::size_t lower) {
    return mass * wide(rod.mass * rod.gyration * rod.gyration) *
           moment(at[lower] - at[upper], push[lower] - push[upper]);
  };
  const Flat reaction = plane.of(ground.force[side]), centre = plane.of(ground.centre[side]);
  const Flat foot_force = (mass * wide(forces::foot.mass)) * push[foot_centre_point];
  Wide turning = moment(at[foot_centre_point] - at[ankle_point], foot_force) -
                 moment(centre - at[ankle_point], reaction) + spin(forces::foot, ankle_point, ball_point);
  Flat through = foot_force - reaction;
  hip_knee_ankle[2] = turning;
  auto climb = [&](const forces::Rod& rod, std::size_t upper, std::size_t lower) {
    const Flat own = (mass * wide(rod.mass)) * (push[upper] + wide(rod.centre) * (push[lower] - push[upper]));
    const Flat length = at[lower] - at[upper];
    turning = turning + moment(length, through) + moment(wide(rod.centre) * length, own) + spin(rod, upper, lower);
    through = through + own;
  };
  climb(forces::shank, knee_point, ankle_point);
  hip_knee_ankle[1] = -turning;
  climb(forces::thigh, hip_point, knee_point);
  hip_knee_ankle[0] = turning;
}

/// Where a foot presses when the body rolls over it.
HWY_NOINLINE void touch(const Wide& height, const WideVec& hip, const WideVec& ankle, const WideVec& heel,
                        const WideVec& ball, FootContact<Lanes<float>>& contact) {
  const Wide zero = wide(0.0F), one = wide(1.0F);
  const Wide dx = ball.x - heel.x, dz = ball.z - heel.z;
  const Wide sole = max(sqrt(fma(dx, dx, dz * dz)), wide(1e-4F));
  const Wide along_x = dx / sole, along_z = dz / sole;
  const WideVec leg = hip - ankle;
  const Wide slope = fma(leg.x, along_x, leg.z * along_z) / max(leg.y, wide(0.1F) * height);
  const Wide s = (slope - wide(forces::rocker_slope)) * wide(1.0F / forces::rocker_range);
  const Wide rocker = fma(wide(forces::rocker_reach), s / sqrt(fma(s, s, one)),
                          wide(forces::rocker_centre - static_cast<float>(fraction::ball_forward)));
  // Heights over one another, so that a foot that hovers a little still stands on its lower end.
  const Wide heel_up = max(heel.y - ball.y, zero), ball_up = max(ball.y - heel.y, zero);
  // From the ball, which stays where it is as the heel rises.
  const Wide rolled = fma(wide(forces::toe_travel), heel_up, rocker * height);
  const Wide toes = wide(static_cast<float>(fraction::toes_length)) * height;
  const Wide heel_bears = clamp(one - heel_up / (wide(forces::heel_pad) * height), 0.0F, 1.0F);
  const Wide ball_bears = clamp(one - ball_up / (wide(forces::ball_pad) * height), 0.0F, 1.0F);
  const Wide rearmost = -(heel_bears * sole), foremost = fma(ball_bears, sole + toes, -sole);
  const Wide place = min(max(rolled, rearmost), foremost);
  store(fma(place, along_x, ball.x), contact.x_m);
  store(fma(place, along_z, ball.z), contact.z_m);
  store(along_x, contact.along_x);
  store(along_z, contact.along_z);
  store(max(place - rearmost, zero), contact.back_m);
  store(foremost - place, contact.ahead_m);
}

/// The way the thighs face, from their own axes to the left.
HWY_INLINE Plane facing(const Pose<Lanes<float>>& pose) {
  const Wide zero = wide(0.0F), one = wide(1.0F);
  const WideVec left_of_it = {one, zero, zero};
  const WideVec both = rotate(load(pose.rotation[index(Segment::thigh_right)]), left_of_it) +
                       rotate(load(pose.rotation[index(Segment::thigh_left)]), left_of_it);
  const Wide long_ = max(sqrt(fma(both.x, both.x, both.z * both.z)), wide(1e-6F));
  return {-both.z / long_, both.x / long_};
}

HWY_NOINLINE void remember(const BodySize<Lanes<float>>& size, const Pose<Lanes<float>>& pose,
                           const Feet<Lanes<float>>& feet, const StepPlan<Lanes<float>>& plan,
                           const GaitState<Lanes<float>>& state, const Motion& motion,
                           MotionHistory<Lanes<float>>& history) {
  const Wide one = wide(1.0F);
  for (std::size_t i = 0; i < tracked_points; ++i) {
    store(motion.now[i] - load(history.place_m[i]), history.step_m[i]);
    store(motion.now[i], history.place_m[i]);
  }
  for (std::size_t side = 0; side < 2; ++side) {
    touch(load(size.height_m), motion.now[tracked_point(side, hip_point)], motion.now[tracked_point(side, ankle_point)],
          load(feet.heel_m[side]), load(feet.toe_m[side]), history.contact[side]);
  }
  const Plane forward = facing(pose);
  store(forward.x, history.forward_x);
  store(forward.z, history.forward_z);
  const Wide u = clamp(load(state.time_s) / max(load(plan.double_support_s), wide(1e-6F)), 0.0F, 1.0F),
             left_over = one - u;
  const Wide over = fnma(left_over * left_over, fma(wide(forces::load_curve), u, one), one);
  const Wide from = load(plan.load_from), share = fma(over, load(plan.load_to) - from, from);
  store(select(equal(state.stance_side, right), share, one - share), history.load_right);
  store(min(load(history.ticks_known) + one, wide(2.0F)), history.ticks_known);
}

void forces_block(const BodySize<Lanes<float>>& size, const Pose<Lanes<float>>& pose, const Feet<Lanes<float>>& feet,
                  const CentreOfMass<Lanes<float>>& centre, const StepPlan<Lanes<float>>& plan,
                  const GaitState<Lanes<float>>& state, MotionHistory<Lanes<float>>& history,
                  GroundReaction<Lanes<float>>& reaction, JointMoments<Lanes<float>>& moments, float tick_s) {
  Motion motion;
  track(size, pose, centre, motion.now);
  const Wide per_tick2 = wide(1.0F / (tick_s * tick_s)), zero = wide(0.0F);
  for (std::size_t i = 0; i < tracked_points; ++i) {
    const WideVec second = motion.now[i] - load(history.place_m[i]) - load(history.step_m[i]);
    motion.acceleration[i] = {second.x * per_tick2, second.y * per_tick2, second.z * per_tick2};
  }
  Support ground;
  support(size, history, motion, tick_s, ground);
  const WideMask known = load(history.ticks_known) >= wide(2.0F);
  auto where_known = [&](const WideVec& v, Vec3<Lanes<float>>& to) {
    store(WideVec{select(known, v.x, zero), select(known, v.y, zero), select(known, v.z, zero)}, to);
  };
  for (std::size_t side = 0; side < 2; ++side) {
    where_known(ground.force[side], reaction.force_n[side]);
    where_known(ground.centre[side], reaction.centre_m[side]);
    Wide joint[3];
    leg_moments(size, history, motion, ground, side, joint);
    store(select(known, joint[0], zero), moments.hip_nm[side]);
    store(select(known, joint[1], zero), moments.knee_nm[side]);
    store(select(known, joint[2], zero), moments.ankle_nm[side]);
  }
  remember(size, pose, feet, plan, state, motion, history);
}

}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil {

HWY_EXPORT(forces_block);

void joint_forces(const BodySize<Lanes<float>>& size, const Pose<Lanes<float>>& pose, const Feet<Lanes<float>>& feet,
                  const CentreOfMass<Lanes<float>>& centre, const StepPlan<Lanes<float>>& plan,
                  const GaitState<Lanes<float>>& state, MotionHistory<Lanes<float>>& history,
                  GroundReaction<Lanes<float>>& reaction, JointMoments<Lanes<float>>& moments, float tick_s) {
  HWY_DYNAMIC_DISPATCH(forces_block)(size, pose, feet, centre, plan, state, history, reaction, moments, tick_s);
}

}  // namespace mobil
#endif
