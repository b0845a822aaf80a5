#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include "systems/gait/knee_frames.h"
#include "systems/gait/step_now-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace {

struct SineCosine {
  Wide sine, cosine;
};

/// Transform from the frame that faces along the pelvis' heading to the frame of a thigh, mirrored to a right one.
class IntoThigh {
 public:
  /// `aside` is the thigh's rotation about z, `thigh` the backward rotation about x after it.
  IntoThigh(const SineCosine& aside, const SineCosine& thigh, std::size_t side)
      : aside_(aside), thigh_(thigh), mirror_(wide(side == Side::left ? -1.0F : 1.0F)) {}

  HWY_INLINE WideVec place(const WideVec& v) const {
    const WideVec at = turned(v);
    return {mirror_ * at.x, at.y, at.z};
  }
  HWY_INLINE WideVec x_axis(const WideVec& v) const {
    const WideVec at = turned(v);
    return {at.x, mirror_ * at.y, mirror_ * at.z};
  }

 private:
  HWY_INLINE WideVec turned(const WideVec& v) const {
    const Wide x = fma(aside_.cosine, v.x, aside_.sine * v.y), y = fnma(aside_.sine, v.x, aside_.cosine * v.y);
    return {x, fnma(thigh_.sine, v.z, thigh_.cosine * y), fma(thigh_.sine, y, thigh_.cosine * v.z)};
  }

  SineCosine aside_, thigh_;
  Wide mirror_;
};

HWY_INLINE SineCosine sine_cosine(const Wide& angle) {
  SineCosine of;
  sin_cos(angle, of.sine, of.cosine);
  return of;
}

/// Computes a leg's frame. Only the knee's angle of the leg's triangle is evaluated: its sides give sines and cosines.
HWY_NOINLINE void knee_frame(const StepNow& now, const WideVec (&pelvis)[3], std::size_t side, const Wide& height,
                             KneeFrame<Lanes<float>>& frame) {
  const LegPlane leg = leg_plane(now, side, height);
  const WideVec& d = leg.to_ankle;
  const Wide across = sqrt(leg.across2), whole = sqrt(fma(d.z, d.z, leg.across2));
  const Wide per_across = 1.0F / across, per_whole = 1.0F / whole;
  const Wide per_upper = 1.0F / (static_cast<float>(fraction::thigh) * height);
  const Wide per_lower = 1.0F / (static_cast<float>(fraction::shank) * height);
  const SineCosine ahead = {d.z * per_whole, across * per_whole};
  const SineCosine above = {leg.bulge * per_upper, leg.near * per_upper};
  const SineCosine below = {leg.bulge * per_lower, (leg.distance - leg.near) * per_lower};
  const IntoThigh into({d.x * per_across, -d.y * per_across},
                       {fma(ahead.sine, above.cosine, ahead.cosine * above.sine),
                        fnma(ahead.sine, above.sine, ahead.cosine * above.cosine)},
                       side);
  const Wide sine = fma(above.sine, below.cosine, above.cosine * below.sine);
  const Wide cosine = fnma(above.sine, below.sine, above.cosine * below.cosine);
  store(sine, frame.sine);
  store(cosine, frame.cosine);
  store(atan2(sine, cosine), frame.flexion_rad);

  const Vec3<float> knee = unit_skeleton.joint_offset[index(Segment::shank_right)];
  const WideVec hip = scaled({-knee.x, -knee.y, -knee.z}, height);
  store(hip, frame.hip_m);
  store(hip + into.place(d), frame.ankle_m);
  store(into.x_axis(pelvis[0]), frame.pelvis[0]);
  for (const std::size_t axis : {std::size_t{1}, std::size_t{2}}) store(into.place(pelvis[axis]), frame.pelvis[axis]);
  const FootMotion& foot = now.foot[side];
  const SineCosine yaw =
      sine_cosine(now.at[side].heading - now.pelvis.heading + foot.toe_out * (side == Side::left ? 1.0F : -1.0F));
  SineCosine pitch = sine_cosine(-foot.pitch);
  const SineCosine shank = {fnma(ahead.cosine, below.sine, ahead.sine * below.cosine),
                            fma(ahead.cosine, below.cosine, ahead.sine * below.sine)};
  // An ankle below 29 degrees up is not near its limit, so its pitch stays and the shank's angle is not needed.
  constexpr float near = 0.49F;
  const Wide ankle_sine = -fma(pitch.sine, shank.cosine, pitch.cosine * shank.sine);
  if (any(ankle_sine > near)) pitch = sine_cosine(-held_pitch(foot, atan2(shank.sine, shank.cosine)));
  store(into.x_axis({yaw.cosine, wide(0.0F), -yaw.sine}), frame.foot[0]);
  store(into.place({yaw.sine * pitch.sine, pitch.cosine, yaw.cosine * pitch.sine}), frame.foot[1]);
  store(into.place({yaw.sine * pitch.cosine, -pitch.sine, yaw.cosine * pitch.cosine}), frame.foot[2]);
}

void both_knees(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                const GaitState<Lanes<float>>& state, KneeFrame<Lanes<float>> (&leg)[2], LegPlanAhead& ahead) {
  const LegSize legs = leg_size(size);
  const Wide zero = wide(0.0F), one = wide(1.0F);
  constexpr std::size_t places = step_now_fetches + 2, lines = sizeof(plan) / 64 / places + 1;
  const auto fetch = [&] { ahead.fetch(lines); };
  const StepNow now = step_now(legs, plan, state, nullptr, fetch);
  const WideQuat& turn = now.motion.turn;
  const WideVec pelvis[3] = {rotate(turn, {one, zero, zero}), rotate(turn, {zero, one, zero}),
                             rotate(turn, {zero, zero, one})};
  for (std::size_t side = 0; side < 2; ++side) {
    fetch();
    knee_frame(now, pelvis, side, legs.leg, leg[side]);
  }
}

}  // namespace
}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {

namespace {

FetchAhead between(const Lanes<float>& first, const void* end) {
  return {&first, static_cast<std::size_t>(static_cast<const char*>(end) - reinterpret_cast<const char*>(&first))};
}

/// Parts of a strike: the words before the trunk, those between trunk and pressure, and the pelvis' rotations.
FetchAhead before_trunk(const Lanes<float>& first, const HeelStrike<Lanes<float>>& strike) {
  return between(first, &strike.shape[step_shape::trunk.first]);
}
FetchAhead behind_trunk(const HeelStrike<Lanes<float>>& strike) {
  return between(strike.shape[step_shape::aside.first], &strike.shape[step_shape::pressure.first]);
}
FetchAhead of_pelvis(const HeelStrike<Lanes<float>>& strike) {
  return between(strike.posture.pelvis_rotation, &strike.posture.shoulder_rotation);
}

std::array<FetchAhead, 7> leg_parts(const StepPlan<Lanes<float>>* plan) {
  const FetchAhead none(nullptr, 0);
  if (plan == nullptr) return {none, none, none, none, none, none, none};
  return {before_trunk(plan->duration_s, plan->from),    behind_trunk(plan->from), of_pelvis(plan->from),
          before_trunk(plan->to.speed_m_s, plan->to),    behind_trunk(plan->to),   of_pelvis(plan->to),
          between(plan->even_m.coefficient[0], plan + 1)};
}

}  // namespace

LegPlanAhead::LegPlanAhead(const StepPlan<Lanes<float>>* plan) : parts_(leg_parts(plan)) {}

HWY_EXPORT(both_knees);

void knee_frames(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                 const GaitState<Lanes<float>>& state, KneeFrame<Lanes<float>> (&leg)[2], LegPlanAhead& ahead) {
  HWY_DYNAMIC_DISPATCH(both_knees)(size, plan, state, leg, ahead);
}

}  // namespace mobil::inline v0_3
#endif
