// What a walker of a given body and gait is like at heel strike. Include it as engine/wide-inl.h says.

#if defined(MOBIL_SYSTEMS_GAIT_STRIKE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_GAIT_STRIKE_INL_H_
#undef MOBIL_SYSTEMS_GAIT_STRIKE_INL_H_
#else
#define MOBIL_SYSTEMS_GAIT_STRIKE_INL_H_
#endif

#include "components/body.h"
#include "systems/gait/leg-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {

/// The hips are lowest this part of a step after heel strike.
constexpr float lowest_phase = 0.0975F;
/// A step at which the style's values hold, of body height.
constexpr float natural_step_h = 0.43F;
/// Speed of the hips at heel strike, of the mean; the knee's flexing then, deg/s at a natural step.
constexpr float strike_speed = 1.1065F, strike_knee_rate_deg = 102.0F;
/// How the style's values change with the step, per natural step: knees in deg, the release in cycles, the hips in
/// mid-stance in body heights. Fitted, with the style's defaults, to Schwartz (2008) and Winter (1991) at slow, natural
/// and fast speed.
constexpr float stance_knee_slope = -13.8F, toe_off_knee_slope = -9.7F, strike_knee_slope = 2.5F;
constexpr float release_slope = 0.0487F, mid_stance_slope = -0.0168F;

/// What a strike is computed from, in lanes.
struct StrikeRequest {
  Wide height, mass;
  Wide speed, step_length, double_support_cycle;  // of the gait at the strike; speed 0 stands
  Wide length;                                    // of the step that ends here
};

/// One double support as a fraction of the cycle; the cadence is in steps a minute at a height of 1.8 m.
HWY_NOINLINE inline Wide double_support_of(const Wide& cadence, const Wide& scale) {
  namespace d = double_support_law;
  constexpr auto at_rest = static_cast<float>(d::at_rest), per_cadence = static_cast<float>(d::per_cadence);
  constexpr auto least = static_cast<float>(d::least), most = static_cast<float>(d::most);
  return clamp((at_rest - per_cadence * cadence) * scale, least, most) * 0.01F;
}

/// Height of the hips in mid-stance. Legs of one stiffness sink under the weight that a body of this height carries
/// beyond 22 kg/m²; they sink less and less, and a light body's cannot become longer than straight.
HWY_NOINLINE inline Wide mid_stance_height(const Wide& height, const Wide& mass,
                                           const GaitStyleOf<Lanes<float>>& style) {
  const Wide stand = ratio(fraction::hip_height, height);
  const Wide stiffness = load(style.leg_stiffness_n_per_m) * height / 1.8F;
  const Wide excess = (mass - 22.0F * height * height) * gravity_f / (stiffness * stand);
  constexpr float most = 0.018F;
  const Wide sag = most * excess / sqrt(most * most + excess * excess);
  return stand * (load(style.mid_stance_height) - select(excess > 0.0F, sag, 0.1F * sag));
}

/// Height and speed of the hips at a strike.
struct HipsAtStrike {
  Wide up, up_velocity;
};

HWY_NOINLINE inline HipsAtStrike hips_at(const Strike<Lanes<float>>& strike) {
  Wide s, c;
  sin_cos(wide(2.0F * pi_f * lowest_phase), s, c);
  const Wide wave = load(strike.up_wave_m);
  return {load(strike.up_mean_m) - wave * c, -(2.0F * pi_f * load(strike.pace_hz)) * wave * s};
}

/// Pitch rate of the leading foot at which its knee flexes at `knee_rate`, the heel resting on the ground.
HWY_NOINLINE inline Wide foot_pitch_rate(const LegSize& leg, const Strike<Lanes<float>>& strike,
                                         const Wide& knee_rate) {
  const PelvisManner pelvis = pelvis_manner(strike.manner, strike.manner, wide(0.0F));
  const HipsAtStrike hips = hips_at(strike);
  constexpr float dt = 1e-3F;
  const Wide dphase = load(strike.pace_hz) * dt;
  const Place before = hip_offset(leg, pelvis, -dphase), after = hip_offset(leg, pelvis, dphase);
  const Place offset = hip_offset(leg, pelvis, wide(0.0F));
  const Footing foot = footing(load(strike.half_width_m), load(strike.toe_out));
  const Wide pitch = load(strike.foot_pitch);
  const Place ankle = planted_ankle(leg, foot, pitch), lever = planted_ankle_rate(leg, foot, pitch);
  const Place from = {offset.out - ankle.out, offset.up + hips.up - ankle.up,
                      offset.forward - load(strike.behind_m) - ankle.forward};
  const Wide reach = sqrt(fma(from.out, from.out, fma(from.up, from.up, from.forward * from.forward)));
  const Wide across = (after.out - before.out) / (2.0F * dt);
  const Wide rising = (after.up - before.up) / (2.0F * dt) + hips.up_velocity;
  const Wide advancing = (after.forward - before.forward) / (2.0F * dt) + load(strike.forward_velocity);
  const Wide hip_part = fma(from.out, across, fma(from.up, rising, from.forward * advancing)) / reach;
  const Wide foot_part = fma(from.out, lever.out, fma(from.up, lever.up, from.forward * lever.forward)) / reach;
  Wide s, c;
  sin_cos(knee_at(leg, reach), s, c);
  const Wide wanted = -leg.thigh * leg.shank * s / reach * knee_rate;
  return (hip_part - wanted) / foot_part;
}

/// Highest place of the middle of the hips from which the leading leg reaches the ground with its knee so bent.
HWY_NOINLINE inline Wide reachable_height(const LegSize& leg, const Strike<Lanes<float>>& strike, const Wide& knee) {
  const PelvisManner pelvis = pelvis_manner(strike.manner, strike.manner, wide(0.0F));
  const Place offset = hip_offset(leg, pelvis, wide(0.0F));
  const Footing foot = footing(load(strike.half_width_m), load(strike.toe_out));
  const Place ankle = planted_ankle(leg, foot, load(strike.foot_pitch));
  const Wide behind = offset.forward - load(strike.behind_m) - ankle.forward;
  const Wide aside = offset.out - ankle.out;
  const Wide reach = leg_reach(leg, knee);
  return ankle.up + sqrt(max(reach * reach - behind * behind - aside * aside, 0.0F)) - offset.up;
}

/// The strike of a gait at its own pace, or of standing where the speed is 0.
HWY_NOINLINE inline void make_strike(const StrikeRequest& r, const GaitStyleOf<Lanes<float>>& style,
                                     Strike<Lanes<float>>& strike) {
  const LegSize leg = leg_size(r.height);
  const WideMask stands = r.speed <= 0.0F;
  auto walking = [&](const Wide& value) { return select(stands, wide(0.0F), value); };
  const Wide step = select(stands, wide(1.0F), r.step_length);  // no division by zero
  const Wide stride = min(r.step_length / (natural_step_h * r.height), 1.25F);
  const Wide pace = walking(r.speed / step), longer = walking(stride - 1.0F);
  auto knee_of = [&](const Lanes<float>& natural_deg, float slope) {
    return max(load(natural_deg) + slope * longer, 1.0F) * degree_f;
  };
  store(r.speed, strike.speed_m_s);
  store(walking(r.length), strike.length_m);
  store(walking(0.5F * r.length - ratio(1.0, r.height) * load(style.foot_pivot_h)), strike.behind_m);
  store(r.speed * strike_speed, strike.forward_velocity);
  store(pace, strike.pace_hz);
  store(load(style.trunk_lean_deg) * degree_f, strike.trunk_pitch);
  store(load(style.step_width_h) * (0.5F * r.height), strike.half_width_m);
  store(load(style.toe_out_deg) * degree_f, strike.toe_out);
  store(walking(load(style.strike_pitch_deg) * degree_f * stride), strike.foot_pitch);

  Manner<Lanes<float>>& m = strike.manner;
  store(load(style.pelvis_rotation_deg) * degree_f * walking(stride), m.pelvis_rotation);
  store(load(style.pelvis_list_deg) * degree_f * walking(stride), m.pelvis_list);
  store(walking(load(style.pelvis_shift_h) * r.height), m.pelvis_shift_m);
  store(load(style.pelvis_tilt_deg) * degree_f, m.pelvis_tilt);
  store(load(style.pelvis_tilt_wave_deg) * degree_f * walking(wide(1.0F)), m.pelvis_tilt_wave);
  store(load(style.shoulder_rotation), m.shoulder_rotation);
  const Wide hip_height = ratio(fraction::hip_height, r.height);
  const Wide swinging = min(1.5F * r.speed / sqrt(gravity_f * hip_height), 1.0F) * stride;
  store(load(style.arm_back_deg) * degree_f * swinging, m.arm_back);
  store(load(style.arm_forward_deg) * degree_f * swinging, m.arm_forward);
  store(load(style.elbow_back_deg) * degree_f, m.elbow_back);
  store(mix(load(style.elbow_back_deg), load(style.elbow_forward_deg), swinging) * degree_f, m.elbow_forward);
  store(load(style.arm_abduction_deg) * degree_f, m.arm_abduction);
  store(load(style.forearm_pronation_deg) * degree_f, m.forearm_pronation);
  store(load(style.finger_flexion_deg) * degree_f, m.finger_flexion);
  const Wide most = max(0.5F * step / (leg.thigh + leg.shank), 0.15F);
  store(-1.15F * most, m.leg_back);
  store(most, m.leg_forward);

  // The hips: highest in mid-stance, lowest after the strike, never out of the leading leg's reach.
  const Wide mid = mid_stance_height(r.height, r.mass, style) + walking(mid_stance_slope * r.height * longer);
  const Wide stiff = mid - sqrt(max(mid * mid - 0.25F * r.length * r.length, 0.0F));
  const Wide reachable = reachable_height(leg, strike, knee_of(style.strike_knee_deg, strike_knee_slope));
  const Wide fall = max(mid - reachable, load(style.hip_fall) * stiff);
  const Wide low = mid - walking(fall);
  Wide s, c;
  sin_cos(wide(2.0F * pi_f * lowest_phase), s, c);
  const Wide wave = (mid - low) / (1.0F + c);
  store(wave, strike.up_wave_m);
  store(mid - wave, strike.up_mean_m);

  const Wide part = 2.0F * r.double_support_cycle;
  const Wide flat = 2.0F * load(style.foot_flat_cycle);
  const Wide release = 2.0F * fma(wide(release_slope), longer, load(style.knee_release_cycle));
  store(select(stands, wide(1.0F), part), strike.double_support);
  store(flat, strike.flat);
  store(release, strike.release);
  // The knee yields as a square from its release to toe-off.
  const Wide least = knee_of(style.stance_knee_deg, stance_knee_slope);
  const Wide last = knee_of(style.toe_off_knee_deg, toe_off_knee_slope);
  const Wide until = max(1.0F + part - release, 0.2F), now = max(1.0F - release, 0.0F) / until;
  store(select(stands, wide(-20.0F * degree_f), least + (last - least) * now * now), strike.knee);
  store(walking(2.0F * (last - least) * now / until * pace), strike.knee_rate);
  store(select(stands, wide(-20.0F * degree_f), least), strike.stance_knee);
  store(select(stands, wide(-20.0F * degree_f), last), strike.toe_off_knee);

  const Wide pitch = load(strike.foot_pitch);
  const Wide span = flat / max(pace, 0.1F);
  const Wide knee_rate = strike_knee_rate_deg * degree_f * stride;
  const Wide rate = foot_pitch_rate(leg, strike, knee_rate);
  store(walking(min(max(rate, -3.9F * pitch / span), wide(0.0F))), strike.foot_pitch_rate);
}

}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
