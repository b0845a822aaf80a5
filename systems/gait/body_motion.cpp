#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include "assets/body/segment_inertia.h"
#include "engine/exact_math.h"
#include "systems/gait/body_motion.h"
#include "systems/gait/kinematics.h"
#include "systems/gait/kinematics_wide-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

constexpr float gravity_m_s2 = 9.81F;
/// Share of the toes in the mass of a foot with its toes.
constexpr auto toes_of_foot = static_cast<float>(unit_body.mass_share[index(Segment::toes_right)]);

HWY_INLINE Vec3<float> single(const Vec3<double>& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

HWY_INLINE WideVec centre_of(const WideScales& scale, const Pose<Lanes<float>>& pose, std::size_t segment) {
  return load(pose.position_m[segment]) +
         rotate(load(pose.rotation[segment]),
                scaled(single(unit_body.centre_of_mass[segment]), scale, segment_groups[segment]));
}

/// Returns the angular velocity between two orientations of a segment, in its own axes.
HWY_INLINE WideVec turning(const WideQuat& a, const WideQuat& b, const Wide& per_half) {
  const Wide w = fma(a.w, b.w, fma(a.x, b.x, fma(a.y, b.y, a.z * b.z)));
  const WideVec va = {a.x, a.y, a.z}, vb = {b.x, b.y, b.z};
  const WideVec v = fma(a.w, vb, fma(-b.w, va, cross(vb, va)));
  const Wide sign = select(w < 0.0F, -per_half, per_half);
  return {v.x * sign, v.y * sign, v.z * sign};
}

void motion_block(const BodySize<Lanes<float>>& size, const Pose<Lanes<float>>& before, const Pose<Lanes<float>>& now,
                  const Pose<Lanes<float>>& after, float apart_s, BodyMotion<Lanes<float>>& motion) {
  const WideScales scale(size);
  const WideMasses masses(size);
  const Wide zero = wide(0.0F);
  const Wide per2 = wide(1.0F / (apart_s * apart_s)), per = wide(1.0F / apart_s), per_half = wide(2.0F / apart_s);
  auto bend = [&](const WideVec& a, const WideVec& b, const WideVec& c) {
    const WideVec d = (c - b) - (b - a);
    return WideVec{d.x * per2, d.y * per2, d.z * per2};
  };
  WideVec force = {zero, zero, zero}, moment = force;
  Wide centre_height = zero;
  for (std::size_t s = 0; s < segment_count; ++s) {
    const Wide mass = masses[mass_group[s]] * static_cast<float>(unit_body.mass_share[s]);
    const WideVec r = centre_of(scale, now, s);
    WideVec a = bend(centre_of(scale, before, s), r, centre_of(scale, after, s));
    a.y = a.y + gravity_m_s2;
    const WideVec f = {mass * a.x, mass * a.y, mass * a.z};
    const WideQuat q0 = load(before.rotation[s]), q1 = load(now.rotation[s]), q2 = load(after.rotation[s]);
    const WideVec first = turning(q0, q1, per_half), second = turning(q1, q2, per_half);
    const Wide& thick = scale[segment_groups[s].z];
    const WideVec inertia = scaled(single(unit_inertia[s]), mass * thick * thick);
    const WideVec spin = {0.5F * (first.x + second.x), 0.5F * (first.y + second.y), 0.5F * (first.z + second.z)};
    const WideVec whirl = cross(spin, WideVec{inertia.x * spin.x, inertia.y * spin.y, inertia.z * spin.z});
    const WideVec own = {fma(inertia.x, (second.x - first.x) * per, whirl.x),
                         fma(inertia.y, (second.y - first.y) * per, whirl.y),
                         fma(inertia.z, (second.z - first.z) * per, whirl.z)};
    force = force + f;
    moment = moment + cross(r, f) + rotate(q1, own);
    centre_height = fma(mass, r.y, centre_height);
  }
  store(force, motion.force_per_kg);
  store(moment, motion.moment_per_kg);
  store(centre_height, motion.centre_height_m);

  using enum Segment;
  const WideVec left_of_it = {wide(1.0F), zero, zero}, ahead_of_it = {zero, zero, wide(1.0F)};
  auto ahead = [](const WideVec& leftward, Lanes<float>& x, Lanes<float>& z) {
    const Wide long_ = max(sqrt(fma(leftward.x, leftward.x, leftward.z * leftward.z)), wide(1e-6F));
    store(-leftward.z / long_, x);
    store(leftward.x / long_, z);
  };
  ahead(rotate(load(now.rotation[index(thigh_right)]), left_of_it) +
            rotate(load(now.rotation[index(thigh_left)]), left_of_it),
        motion.facing_x, motion.facing_z);
  for (std::size_t side = 0; side < 2; ++side) {
    const WideQuat foot_turn = load(now.rotation[index(on_side(foot_right, side))]);
    ahead(rotate(foot_turn, left_of_it), motion.foot_x[side], motion.foot_z[side]);
    const WideVec sole = rotate(foot_turn, ahead_of_it);
    store(atan2(sole.y, fma(sole.x, load(motion.foot_x[side]), sole.z * load(motion.foot_z[side]))),
          motion.foot_pitch[side]);
    auto keep = [&](LegPoint p, auto place) {
      const WideVec at = place(now);
      store(at, motion.place_m[leg_point(side, p)]);
      store(bend(place(before), at, place(after)), motion.acceleration[leg_point(side, p)]);
    };
    auto joint = [&](Segment right_one) {
      return [s = index(on_side(right_one, side))](const Pose<Lanes<float>>& pose) { return load(pose.position_m[s]); };
    };
    keep(hip_point, joint(thigh_right));
    keep(knee_point, joint(shank_right));
    keep(ankle_point, joint(foot_right));
    keep(ball_point, joint(toes_right));
    keep(foot_centre_point, [&](const Pose<Lanes<float>>& pose) {
      const WideVec foot = centre_of(scale, pose, index(on_side(foot_right, side)));
      return fma(wide(toes_of_foot), centre_of(scale, pose, index(on_side(toes_right, side))) - foot, foot);
    });
  }
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {

HWY_EXPORT(motion_block);

namespace {

/// Returns the ground in the frame of the stance foothold: relative heights, +Z along the walking line's heading there.
Footing<Lanes<float>> seen_from_stance(const Footing<Lanes<float>>& footing, const GaitState<Lanes<float>>& state) {
  constexpr auto stance = index(FootholdOf::stance);
  Footing<Lanes<float>> seen = footing;
  for (std::size_t l = 0; l < lane_count; ++l) {
    const float s = exact::sin(state.heading_rad[l]), c = exact::cos(state.heading_rad[l]);
    for (std::size_t i = 0; i < 3; ++i) {
      const float x = footing.rise_x[i][l], z = footing.rise_z[i][l];
      seen.height_m[i][l] = footing.height_m[i][l] - footing.height_m[stance][l];
      seen.rise_x[i][l] = x * c - z * s;
      seen.rise_z[i][l] = x * s + z * c;
      const float moved_x = footing.moved_x_m[i][l], moved_z = footing.moved_z_m[i][l];
      seen.moved_x_m[i][l] = moved_x * c - moved_z * s;
      seen.moved_z_m[i][l] = moved_x * s + moved_z * c;
    }
  }
  return seen;
}

}  // namespace

void motion_of_poses(const BodySize<Lanes<float>>& size, const Pose<Lanes<float>>& before,
                     const Pose<Lanes<float>>& now, const Pose<Lanes<float>>& after, float apart_s,
                     BodyMotion<Lanes<float>>& motion) {
  HWY_DYNAMIC_DISPATCH(motion_block)(size, before, now, after, apart_s, motion);
}

void walker_motion(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                   const GaitState<Lanes<float>>& state, const Footing<Lanes<float>>* footing,
                   BodyMotion<Lanes<float>>& motion) {
  GaitState<Lanes<float>> at = state;  // at the origin, where single precision is finest
  at.line_x_m = at.line_z_m = at.heading_rad = {};
  Footing<Lanes<float>> under;
  if (footing != nullptr) under = seen_from_stance(*footing, state);
  Pose<Lanes<float>> pose[3];
  JointAngles<Lanes<float>> angles;
  Feet<Lanes<float>> feet;
  for (std::size_t k = 0; k < 3; ++k) {
    // A step's curves continue smoothly beyond either strike.
    for (std::size_t l = 0; l < lane_count; ++l)
      at.time_s[l] = state.time_s[l] + (static_cast<float>(k) - 1) * motion_difference_s;
    pose_skeleton(size, plan, at, footing != nullptr ? &under : nullptr, pose[k], angles, feet);
  }
  motion_of_poses(size, pose[0], pose[1], pose[2], motion_difference_s, motion);
}

}  // namespace mobil::inline v0_3
#endif
