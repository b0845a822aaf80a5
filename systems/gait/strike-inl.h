// Heel strike of a walker with a given body and gait. See engine/wide-inl.h for how to include it.

#if defined(MOBIL_SYSTEMS_GAIT_STRIKE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_GAIT_STRIKE_INL_H_
#undef MOBIL_SYSTEMS_GAIT_STRIKE_INL_H_
#else
#define MOBIL_SYSTEMS_GAIT_STRIKE_INL_H_
#endif

#include <algorithm>
#include <array>
#include <iterator>
#include <numbers>

#include <mobil/anthropometry.h>
#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/components/step_plan.h>
#include "assets/gait/step_curves-inl.h"
#include "assets/gait/step_lookup.h"
#include "engine/wide_curve-inl.h"
#include "systems/gait/heading-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

constexpr float degree_f = pi_f / 180.0F;
constexpr float gravity_f = 9.81F;

HWY_INLINE Wide ratio(double fraction_of_height, const Wide& height) {
  return wide(static_cast<float>(fraction_of_height)) * height;
}

/// Inputs of a strike, in lanes.
struct StrikeRequest {
  Wide height, mass, stature;  // height: the scale of the legs
  Wide stoop;
  Wide woman, child;        // parts of their steps
  Wide speed, step_length;  // of the gait at the strike; speed 0 stands
  Wide length;              // of the step that ends here
  Wide slower;              // extra duration relative to the mean step
};

/// Returns the height of a standing person's hips relative to straight legs. Legs of equal stiffness sink under the
/// weight above 24.5 kg/m² of a body of this height, with a saturating sag.
HWY_NOINLINE inline Wide sunk(const StrikeRequest& r, const GaitStyleOf<Lanes<float>>& style) {
  const Wide& height = r.height;
  const Wide stand = ratio(fraction::hip_height, height);
  const Wide stiffness = load(style.leg_stiffness_n_per_m) * height / 1.8F;
  const Wide excess = max(r.mass - 24.5F * r.stature * r.stature, 0.0F) * gravity_f / (stiffness * stand);
  constexpr float most = 0.005F;  // heavy people walk on straighter legs (DeVita & Hortobagyi 2003)
  const Wide sag = most * excess / sqrt(most * most + excess * excess);
  return stand * (load(style.mid_stance_height) - 1.0F - sag);
}

/// Returns the factor by which heavier people's steps are wider than at 24.5 kg/m²: 30 % from 22.1 to 35.5 kg/m²
/// (Browning and Kram 2007). At one speed, step length and double support are the same (Vartiainen and others 2012).
HWY_INLINE Wide wider_steps(const Wide& stature, const Wide& mass) {
  return fma(max(mass / (stature * stature) - 24.5F, 0.0F), wide(0.0224F), wide(1.0F));
}

/// Amounts by style_effects, and the largest of them, which is 0 for the usual walk.
struct StyleAmounts {
  Lanes<float> of[style_effects.size()];
  Lanes<float> most;
};

/// Sink of the pelvis in uneven steps, of the height, per relative difference in length or time. Without it a leg would
/// have to be longer than it is.
constexpr float limping_sink = 0.06F, late_sink = 0.12F;

/// Difference in standing height to straight legs, of the height: knees are bent by about 6°.
constexpr float soft_knees = 0.0006F;

/// Returns the differences of a walk's posture from the usual one, in the units and order of style_effects.
HWY_NOINLINE inline StyleAmounts style_amounts(const Wide& height, const GaitStyleOf<Lanes<float>>& style) {
  constexpr GaitStyle usual;
  // More damping bends the leg less under load. The amount is the overshoot of a spring with this damping (of
  // critical), relative to that at 0.4, by a parabola through 0.2, 0.4 and 1.
  const Wide damping = load(style.leg_damping) - usual.leg_damping;
  const Wide amounts[] = {
      load(style.strike_pitch_deg) - usual.strike_pitch_deg,
      load(style.strike_knee_deg) - usual.strike_knee_deg,
      load(style.stance_knee_deg) - usual.stance_knee_deg,
      load(style.toe_off_knee_deg) - usual.toe_off_knee_deg,
      load(style.knee_release_cycle) - usual.knee_release_cycle,
      load(style.swing_knee_deg) - usual.swing_knee_deg,
      load(style.swing_ankle_deg) - usual.swing_ankle_deg,
      (load(style.toe_clearance_m) - usual.toe_clearance_m) * (1.75F / height),
      load(style.foot_pivot_h) - usual.foot_pivot_h,
      load(style.hip_fall) - usual.hip_fall,
      damping * fma(wide(0.94F), damping, wide(-0.90F)),
      load(style.roll_over) - usual.roll_over,
      load(style.trunk_lean_deg) - usual.trunk_lean_deg,
      usual.trunk_stiffness / load(style.trunk_stiffness) - 1.0F,
  };
  static_assert(std::size(amounts) == style_effects.size());
  StyleAmounts out;
  Wide most = wide(0.0F);
  for (std::size_t k = 0; k < style_effects.size(); ++k) {
    store(amounts[k], out.of[k]);
    most = max(most, abs(amounts[k]));
  }
  store(most, out.most);
  return out;
}

/// Looks up the table's step of each lane, in the body's own lengths; zero for standing lanes. `length` is that of the
/// step that ends here, which can differ from the mean of both sides.
HWY_NOINLINE inline void look_up(const StrikeRequest& r, const Wide& length, const StyleAmounts& amounts,
                                 HeelStrike<Lanes<float>>& strike) {
  const Wide &height = r.height, &speed = r.speed;
  const Wide leg = ratio(fraction::hip_height, height);
  Lanes<float> tall, fast, far, woman, child;
  store(height, tall);
  store(r.woman, woman);
  store(r.child, child);
  store(speed / sqrt(gravity_f * leg), fast);
  store(length / leg, far);
  for (std::size_t l = 0; l < lane_count; ++l) {
    TabledStep step = tabled_step(fast[l], far[l], {woman[l], child[l]});
    if (fast[l] > 0 && amounts.most[l] > 0) {
      std::array<float, style_effects.size()> by;
      for (std::size_t k = 0; k < by.size(); ++k) by[k] = amounts.of[k][l];
      add_styles(fast[l], by, step.shape);
    }
    strike.double_support[l] = static_cast<float>(step.usual.double_support);
    const float longer = std::clamp(far[l] / static_cast<float>(step.usual.step_length), 0.5F, 1.5F);
    strike.posture.pelvis_rotation[l] = longer * static_cast<float>(step.usual.pelvis_rotation);
    strike.posture.pelvis_list[l] = static_cast<float>(step.usual.pelvis_list);
    strike.posture.pelvis_tilt[l] = static_cast<float>(step.usual.pelvis_tilt);
    // Hips keep their share of a step that is shorter or longer than the table's.
    const float tabled = std::clamp(far[l], static_cast<float>(step_table::length.front() * step.usual.step_length),
                                    static_cast<float>(step_table::length.back() * step.usual.step_length));
    const float beyond = -0.42F * (far[l] - tabled) * tall[l] * static_cast<float>(fraction::hip_height);
    for (const ShapePart& part : step_shape::parts) {
      const float times = part.is_length ? tall[l] : 1.0F;
      for (std::size_t i = part.first; i < part.first + part.count; ++i) strike.shape[i][l] = times * step.shape[i];
    }
    if (fast[l] <= 0) continue;
    strike.shape[step_shape::hips_forward.first][l] += beyond;
    // Legs that reach further than the table's lower the hips: straight legs by this much, to second order. People
    // cannot make much longer steps.
    const float reach = std::min(far[l], 1.15F * tabled);
    const float further = std::max(reach * reach - tabled * tabled, 0.0F);
    strike.shape[step_shape::hips_up.first][l] -= 0.125F * further * tall[l] * static_cast<float>(fraction::hip_height);
  }
}

/// Multiplies the time until foot flat by `times`, with the same landing. Pitch and its first three derivatives at heel
/// strike stay, where the swing meets them. A factor of 1 changes no bit.
HWY_NOINLINE inline void flatten_within(const Wide& times, HeelStrike<Lanes<float>>& strike) {
  Lanes<float>* const k = strike.shape + step_shape::strike.first;
  const Wide pitch = load(k[0]), k1 = load(k[1]), k2 = load(k[2]), k3 = load(k[3]);
  const Wide times2 = times * times;
  const Wide first = times * k1, second = fma(times2, k2, 3.0F * k1 * (times - times2));
  const Wide cubic = 3.0F * (k1 - k2) + k3 - 10.0F * pitch;  // of the pitch as a function of the part of that time
  const Wide third = fma(times2 * times, cubic, 10.0F * pitch) - 3.0F * (first - second);
  const WideMask other = abs(times - 1.0F) > 0.0F;
  store(select(other, first, k1), k[1]);
  store(select(other, second, k2), k[2]);
  store(select(other, third, k3), k[3]);
}

HWY_INLINE Wide step_width(const StrikeRequest& r, const GaitStyleOf<Lanes<float>>& style) {
  return load(style.step_width_h) * wider_steps(r.stature, r.mass);
}

/// Writes position and speed of a strike, from which footholds and times of steps follow.
HWY_INLINE void time_strike(const StrikeRequest& r, const GaitStyleOf<Lanes<float>>& style,
                            HeelStrike<Lanes<float>>& strike) {
  const WideMask stands = r.speed <= 0.0F;
  auto walking = [&](const Wide& value) { return select(stands, wide(0.0F), value); };
  const Wide step = select(stands, wide(1.0F), r.step_length);  // no division by zero
  store(r.speed, strike.speed_m_s);
  store(walking(r.length), strike.length_m);
  store(walking(r.speed / step), strike.pace_hz);
  store(walking(step), strike.advance_m);
  store(step_width(r, style) * (0.5F * r.height), strike.half_width_m);
  store(load(style.toe_out_deg) * degree_f, strike.toe_out);
}

/// Lateral shift of the centre of pressure by a pelvic list, which bends the column to its side: of the stature per
/// rad, and of its square per rad/s² (demo/lab/gait_fit/upper_body.h, with the arms; people differ by 4 %).
constexpr float list_shift = 0.070F, list_spin = 0.050F / gravity_f;
/// Part of the third harmonic that a stoop takes, per rad. Fitted to the 48 segments of people of 72 to 95 years.
constexpr float stoop_third = 0.35F;
/// Height of the centre of mass over gravity, of the stature.
constexpr float pendulum_h = 0.57F / gravity_f;

/// Moves the hips aside by one harmonic so that a step of `wider` times the table's width, with `listed` times the
/// table's pelvic list, is balanced like the table's. `list` is the list's amplitude in the table.
template <int K, int At>
HWY_INLINE void balance_aside(const StrikeRequest& r, const Wide& list, const Wide& wider, const Wide& listed,
                              HeelStrike<Lanes<float>>& strike) {
  const Wide turned = (K * pi_f) * load(strike.pace_hz), turned2 = turned * turned, &size = r.stature;
  const Wide shift = size * fma(list_spin * size, turned2, wide(list_shift));
  const Wide by = (wider - listed) * list * shift / fma(pendulum_h * size, turned2, wide(1.0F));
  const Wide kept = K == 3 ? fnma(wide(stoop_third), r.stoop, wide(1.0F)) : wide(1.0F);
  constexpr double at = std::numbers::pi * K * At / 1000;
  constexpr float c = cosine(at), s = cosine(at - std::numbers::pi / 2);
  Lanes<float>* const cosines = strike.shape + step_shape::aside.first + K / 2;
  store(fma(by, wide(c), kept * load(cosines[0])), cosines[0]);
  store(fma(by, wide(s), kept * load(cosines[2])), cosines[2]);
}

/// Writes the strike of a gait at its own pace, or of standing at speed 0.
HWY_NOINLINE inline void make_strike(const StrikeRequest& r, const GaitStyleOf<Lanes<float>>& style,
                                     HeelStrike<Lanes<float>>& strike) {
  constexpr GaitStyle usual;
  const WideMask stands = r.speed <= 0.0F;
  auto walking = [&](const Wide& value) { return select(stands, wide(0.0F), value); };
  const Wide step = select(stands, wide(1.0F), r.step_length);  // no division by zero
  const Wide stride = min(r.step_length / ratio(natural_step_h, r.height), 1.25F);
  look_up(r, select(stands, wide(1.0F), r.length), style_amounts(r.height, style), strike);
  time_strike(r, style, strike);
  const Wide width = step_width(r, style);
  store(clamp(load(strike.double_support) * load(style.double_support_scale), 0.04F, 0.24F), strike.double_support);

  auto more = [&](const ShapePart& part, std::size_t i, const Wide& by) {
    Lanes<float>& number = strike.shape[part.first + i];
    store(load(number) + by, number);
  };
  auto times = [&](const ShapePart& part, const Wide& by) {
    for (std::size_t i = part.first; i < part.first + part.count; ++i)
      store(load(strike.shape[i]) * by, strike.shape[i]);
  };
  auto beyond = [](const Lanes<float>& value, float than) { return load(value) - than; };
  const Wide flat_as_tabled = load(strike.shape[step_shape::times.first]);
  more(step_shape::times, 0, walking(beyond(style.foot_flat_cycle, usual.foot_flat_cycle)));
  // For any sum of style effects a foot lands heel first, foot flat follows heel strike, and toe-off follows heel rise.
  auto within = [&](const ShapePart& part, std::size_t i, float low, float high) {
    Lanes<float>& number = strike.shape[part.first + i];
    store(clamp(load(number), low, high), number);
  };
  within(step_shape::strike, 0, 0, 0.7F);
  within(step_shape::times, 0, -0.05F, 0.08F);
  within(step_shape::times, 1, -0.27F, 0.15F);
  flatten_within((usual_flat + load(strike.shape[step_shape::times.first])) / (usual_flat + flat_as_tabled), strike);
  // In uneven steps the hips keep a constant speed. A longer step of the table already has them further back.
  constexpr float further_back = 0.42F;
  more(step_shape::hips_forward, 0, walking(fma(wide(further_back - 0.5F), r.length - step, 0.5F * step * r.slower)));
  const Wide sink = sunk(r, style), lean = load(style.trunk_lean_deg) * degree_f;
  more(step_shape::hips_up, 0,
       select(stands, sink - soft_knees * r.height,
              sink - (usual.mid_stance_height - 1.0F) * ratio(fraction::hip_height, r.height) -
                  r.height * fma(wide(late_sink), abs(r.slower), limping_sink * abs(r.length / step - 1.0F))));
  more(step_shape::trunk, 0, select(stands, lean, wide(0.0F)));
  times(step_shape::aside, width * (1.0F / usual.step_width_h) +
                               beyond(style.pelvis_shift_h, usual.pelvis_shift_h) * (1.0F / usual.pelvis_shift_h));

  PostureParameters<Lanes<float>>& m = strike.posture;
  const Wide rotated = load(style.pelvis_rotation_deg) * (1.0F / usual.pelvis_rotation_deg);
  const Wide listed = load(style.pelvis_list_deg) * (1.0F / usual.pelvis_list_deg), list = walking(load(m.pelvis_list));
  const Wide wider = width * (1.0F / usual.step_width_h);
  balance_aside<1, pelvis_phase::list_first_1000>(r, pelvis_phase::list_first * list, wider, listed, strike);
  balance_aside<3, pelvis_phase::list_third_1000>(r, pelvis_phase::list_third * list, wider, listed, strike);
  // Legs of a pelvis that turns less reach less far, so that the hips must be lower.
  const Wide less = ratio(fraction::hip_half_spacing, r.height) * load(m.pelvis_rotation) * max(1.0F - rotated, 0.0F);
  more(step_shape::hips_up, 0, walking(-0.5F * step * less / ratio(fraction::hip_height, r.height)));
  store(walking(load(m.pelvis_rotation) * rotated), m.pelvis_rotation);
  store(list * listed, m.pelvis_list);
  store(load(m.pelvis_tilt) + beyond(style.pelvis_tilt_deg, usual.pelvis_tilt_deg) * degree_f, m.pelvis_tilt);
  store(load(style.pelvis_tilt_wave_deg) * degree_f * walking(wide(1.0F)), m.pelvis_tilt_wave);
  store(load(style.shoulder_rotation), m.shoulder_rotation);
  const Wide hip_height = ratio(fraction::hip_height, r.height);
  const Wide swinging =
      walking(min(static_cast<float>(arm_swing::by_speed) * r.speed / sqrt(gravity_f * hip_height), 1.0F) * stride);
  store(load(style.arm_back_deg) * degree_f * swinging, m.arm_back);
  store(load(style.arm_forward_deg) * degree_f * swinging, m.arm_forward);
  store(load(style.elbow_back_deg) * degree_f, m.elbow_back);
  store(mix(load(style.elbow_back_deg), load(style.elbow_forward_deg), swinging) * degree_f, m.elbow_forward);
  store(load(style.arm_abduction_deg) * degree_f, m.arm_abduction);
  store(load(style.forearm_pronation_deg) * degree_f, m.forearm_pronation);
  store(load(style.finger_flexion_deg) * degree_f, m.finger_flexion);
  const Wide most = max(0.5F * step / ratio(fraction::thigh + fraction::shank, r.height), 0.15F);
  store(-static_cast<float>(arm_swing::reach_back) * most, m.leg_back);
  store(most, m.leg_forward);
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
