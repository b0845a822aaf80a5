// Both feet at a phase of a step. Include it as engine/wide-inl.h describes.

#if defined(MOBIL_ASSETS_GAIT_STEP_FEET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_ASSETS_GAIT_STEP_FEET_INL_H_
#undef MOBIL_ASSETS_GAIT_STEP_FEET_INL_H_
#else
#define MOBIL_ASSETS_GAIT_STEP_FEET_INL_H_
#endif

#include "assets/gait/step_curves-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

/// A foot: pitch, bend of the toes and toe-out. Its ankle has a height, a distance from the body's middle line on the
/// leg's own side, and a place along the line.
struct FootMotion {
  Wide pitch, toes, toe_out, ankle_up, ankle_out, ankle_forward;
  Wide part;        // of the time of the swing
  Wide swung;       // part of the way from its last foothold to the next
  Wide in_the_air;  // 64 u³ (1 − u)³ of the swing
};

/// Returns a planted foot of that pitch.
HWY_NOINLINE inline FootMotion plant(const Wide& height, const Wide& pitch, const Wide& toe_out,
                                     const Wide& half_width) {
  const PlantedAnkle ankle = planted_ankle(height, pitch);
  Wide s, c;
  sin_cos(toe_out, s, c);
  return {
      pitch,      ankle.toes, toe_out,   ankle.up.value, fma(s, ankle.along.value, half_width), c * ankle.along.value,
      wide(0.0F), wide(0.0F), wide(0.0F)};
}

HWY_NOINLINE inline FootMotion stance_foot(const StepPlan<Lanes<float>>& plan, const MixedShape& of, const Wide& height,
                                           const Wide& phase) {
  const OneShape from{plan.from.shape};
  const Wide cycle = 0.5F * phase;
  FootMotion foot = plant(height, stance_pitch(plan, of, phase), load(plan.from.toe_out), load(plan.from.half_width_m));
  const Wide yielding = cycle * (1.0F / pad_part);
  Wide s, c;
  sin_cos(foot.toe_out, s, c);
  const Wide slid = falling(from, step_shape::pad_forward, yielding);
  foot.ankle_up = foot.ankle_up + falling(from, step_shape::pad_up, yielding);
  foot.ankle_out = fma(s, slid, foot.ankle_out);
  foot.ankle_forward = fma(c, slid, foot.ankle_forward);
  return foot;
}

/// Returns the height of the lowest point of a sole: under the heel's rim, the toes' joint or their tips.
HWY_NOINLINE inline Wide lowest_point(const FootMotion& foot, const Wide& height) {
  using namespace unit_foot;
  Wide s, c, t_s, t_c;
  sin_cos(foot.pitch, s, c);
  sin_cos(foot.pitch + foot.toes, t_s, t_c);
  const Wide heel = fma(wide(-back), s, -over_rim * c) - rim;
  const Wide on_joint = fma(wide(ball), s, -over_joint * c) - joint * t_c;
  return fma(min(min(heel, on_joint), fma(wide(unit_foot::toes), t_s, on_joint)), height, foot.ankle_up);
}

/// Returns the ankle's height, raised smoothly for a foot in the air that would enter the ground.
HWY_NOINLINE inline Wide above_ground(const FootMotion& foot, const Wide& height) {
  const Wide lowest = lowest_point(foot, height);
  // the missing height where positive, rounded: twice continuously differentiable, and 0 from `within` on
  const Wide within = 0.0005F * height;
  const Wide x = clamp(0.5F - 0.5F * lowest / within, 0.0F, 1.0F);
  const Wide rounded = 2.0F * within * x * x * x * (1.0F - 0.5F * x);
  const Wide lacking = select(lowest < -within, -lowest, rounded);
  return fma(smooth(64.0F * foot.in_the_air), lacking, foot.ankle_up);
}

/// The other foot's pitch on the ground and in the air, and its ankle's place there relative to its last foothold.
struct OtherAnkle {
  Wide part;  // of the time of the swing
  WideMask swings;
  Wide standing_pitch, swing_pitch, up, forward;
};

HWY_NOINLINE inline OtherAnkle other_ankle(const StepPlan<Lanes<float>>& plan, const MixedShape& of, const Wide& height,
                                           const Wide& phase) {
  const Wide off = load(plan.double_support), landing = load(plan.landing);
  const LeavingShape leaving(plan);
  const Wide lift = leaving.begins(), stride = load(plan.stride_part);
  // A walker who continues to stand does not swing. A foot that lands at the end of the step moves a little further
  // when its curves are evaluated beyond it.
  const Wide most = select(landing > 0.0F, select(landing < 1.0F, wide(1.0F), wide(1.25F)), wide(0.0F));
  OtherAnkle a;
  a.swings = phase >= off;
  const Wide u = min(max((phase - off) / max(landing - off, 1e-3F), 0.0F), most);
  a.part = u;
  a.swing_pitch = quintic_at(plan.swing_pitch, u) + bumps(of, step_shape::swing_pitch, u);
  a.standing_pitch = heel_rise(leaving, (phase - lift) / max(off - lift, 1e-3F));
  // A walker who turns on the spot lifts the foot.
  const Wide lifted = select(stands_still(plan), 0.014F * height, wide(0.0F)) * bump(u);
  a.up = quintic_at(plan.swing_up_m, u) + stride * bumps(of, step_shape::swing_up, u) +
         other_way(plan.swing_by_up_m, u) + lifted;
  a.forward = quintic_at(plan.swing_forward_m, u) + stride * bumps(of, step_shape::swing_forward, u) +
              other_way(plan.swing_by_forward_m, u) + load(plan.length_before_m);
  return a;
}

/// Returns the other foot by its curves alone, which can lead through the ground. Places are relative to its last
/// foothold.
HWY_NOINLINE inline FootMotion other_foot_planned(const StepPlan<Lanes<float>>& plan, const MixedShape& of,
                                                  const Wide& height, const Wide& phase) {
  const OtherAnkle a = other_ankle(plan, of, height, phase);
  const Wide& u = a.part;
  const Wide swung = smooth(u);
  FootMotion foot =
      plant(height, select(a.swings, a.swing_pitch, a.standing_pitch),
            mix(load(plan.trailing_toe_out), load(plan.to.toe_out), swung), load(plan.trailing_half_width_m));
  constexpr float straighten = 1.0F / (swing_toes::to - swing_toes::from);
  // They also straighten smoothly if the foot becomes level before that.
  constexpr float nearly_level = 0.2F;
  const Wide bent = mix(wide(1.0F), smooth(-a.swing_pitch * (1.0F / nearly_level)), smooth(4.0F * u));
  foot.toes = foot.toes * (1.0F - smooth((u - swing_toes::from) * straighten)) * bent;
  foot.part = u;
  foot.swung = swung;
  foot.in_the_air = max(bump(u), 0.0F);
  foot.ankle_up = select(a.swings, a.up, foot.ankle_up);
  foot.ankle_out = select(a.swings, quintic_at(plan.swing_out_m, u), foot.ankle_out);
  foot.ankle_forward = select(a.swings, a.forward, foot.ankle_forward);
  return foot;
}

/// Returns the other foot, kept above the ground.
HWY_INLINE FootMotion other_foot(const StepPlan<Lanes<float>>& plan, const MixedShape& of, const Wide& height,
                                 const Wide& phase) {
  FootMotion foot = other_foot_planned(plan, of, height, phase);
  foot.ankle_up = select(phase >= load(plan.double_support), above_ground(foot, height), foot.ankle_up);
  return foot;
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
