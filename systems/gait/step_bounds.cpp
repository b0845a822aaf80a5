#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include <mobil/systems/gait/step_bounds.h>
#include "assets/body/column.h"
#include "systems/gait/step_now-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace {

/// Stores the maximum of each bound.
class Furthest {
 public:
  explicit Furthest(StepBounds<Lanes<float>>& bounds) : value_(bounds.value) {}
  HWY_INLINE void note(WalkBound bound, const Wide& value) const {
    Lanes<float>& kept = value_[static_cast<std::size_t>(bound)];
    store(max(load(kept), value), kept);
  }
  /// Notes a value that is bounded in both directions.
  HWY_INLINE void note(WalkBound less, WalkBound more, const Wide& value) const {
    note(less, -value);
    note(more, value);
  }

 private:
  Lanes<float>* value_;
};

/// Notes the bounds of one leg. Returns the forward angle of the line from hip to ankle.
HWY_NOINLINE Wide leg_bounds(const StepNow& now, std::size_t side, const Wide& height, const Furthest& furthest) {
  FootMotion foot = now.foot[side];
  const LegPlane leg = leg_plane(now, side, height);
  const WideVec& d = leg.to_ankle;
  const float out = side == Side::left ? 1.0F : -1.0F;
  const Wide direction = atan2(d.z, sqrt(leg.across2)), aside = atan2(d.x, -d.y);
  const Wide thigh = direction + atan2(leg.bulge, leg.near);
  const Wide shank = direction - atan2(leg.bulge, leg.distance - leg.near);
  foot.pitch = held_pitch(foot, shank);
  furthest.note(WalkBound::under_ground, -lowest_point(foot, height));
  furthest.note(WalkBound::hip_back, WalkBound::hip_forward,
                thigh + now.motion.tilt - static_cast<float>(neutral_tilt));
  furthest.note(WalkBound::hip_inward, WalkBound::hip_outward, out * (aside + now.motion.list));
  furthest.note(WalkBound::foot_everted, WalkBound::foot_inverted, out * aside);
  furthest.note(WalkBound::hip_turned_in, WalkBound::hip_turned_out,
                fma(wide(out), now.at[side].heading - now.pelvis.heading - now.motion.rotation, foot.toe_out));
  furthest.note(WalkBound::knee_straight, WalkBound::knee_bent, thigh - shank);
  furthest.note(WalkBound::ankle_down, WalkBound::ankle_up, foot.pitch - shank);
  furthest.note(WalkBound::toes_down, WalkBound::toes_up, foot.toes);
  return direction;
}

/// Notes the bounds of the chest relative to the pelvis. The column between them bends about an axis of its own.
HWY_NOINLINE void trunk_bounds(const PelvisMotion& motion, const Wide& turned, const Wide& lean,
                               const Furthest& furthest) {
  const WideQuat& base = motion.turn;
  const WideQuat bent = WideQuat{-base.x, -base.y, -base.z, base.w} * (turn_y(turned) * turn_x(lean));
  const auto angle = [](const Wide& half_sine) HWY_ATTR {  // of less than a right angle
    return half_sine * fma(half_sine * half_sine, wide(1.0F / 3), wide(2.0F));
  };
  furthest.note(WalkBound::trunk_back, WalkBound::trunk_forward, angle(bent.x));
  furthest.note(WalkBound::trunk_aside, abs(angle(bent.z)));
  furthest.note(WalkBound::neck_bent, abs(lean));
}

void bounds_block(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                  const GaitState<Lanes<float>>& state, StepBounds<Lanes<float>>& bounds) {
  const LegSize legs = leg_size(size);
  const StepNow now = step_now(legs, plan, state, nullptr, [] {});
  const Furthest furthest(bounds);
  Wide leg[2];
  for (std::size_t side = 0; side < 2; ++side) leg[side] = leg_bounds(now, side, legs.leg, furthest);

  const PostureParameters<Lanes<float>>&from = plan.from.posture, &to = plan.to.posture;
  const auto of = [&](Lanes<float> PostureParameters<Lanes<float>>::*what)
                      HWY_ATTR { return posture(from.*what, to.*what, now.eased); };
  using M = PostureParameters<Lanes<float>>;
  const Wide leg_back = of(&M::leg_back), per_range = 1.0F / max(of(&M::leg_forward) - leg_back, 1e-3F);
  const Wide arm_back = of(&M::arm_back), arm_range = of(&M::arm_forward) + arm_back;
  const Wide elbow_back = of(&M::elbow_back), elbow_range = of(&M::elbow_forward) - elbow_back;
  for (const Wide& opposite : leg) {
    const Wide ahead = (opposite - leg_back) * per_range;
    furthest.note(WalkBound::arm_back, WalkBound::arm_forward, fma(ahead, arm_range, -arm_back));
    furthest.note(WalkBound::elbow_straight, WalkBound::elbow_bent, fma(ahead, elbow_range, elbow_back));
  }
  const Wide lean = harmonics(now.shape, step_shape::trunk, 3, now.waves);
  trunk_bounds(now.motion, -of(&M::shoulder_rotation) * now.motion.rotation, lean, furthest);
  store(now.pelvis.position.y, bounds.pelvis_up_m);
}

}  // namespace
}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {

HWY_EXPORT(bounds_block);

void step_bounds(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                 const GaitState<Lanes<float>>& state, StepBounds<Lanes<float>>& bounds) {
  HWY_DYNAMIC_DISPATCH(bounds_block)(size, plan, state, bounds);
}

}  // namespace mobil::inline v0_3
#endif
