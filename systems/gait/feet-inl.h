// Both feet over a step: the one that stands, the other until it leaves the ground, and its swing. Include it as
// engine/wide-inl.h says.

#if defined(MOBIL_SYSTEMS_GAIT_FEET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_GAIT_FEET_INL_H_
#undef MOBIL_SYSTEMS_GAIT_FEET_INL_H_
#else
#define MOBIL_SYSTEMS_GAIT_FEET_INL_H_
#endif

#include "systems/gait/step-inl.h"
#include "systems/gait/swing-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {

/// No foot leaves the ground steeper than the calf allows.
constexpr float steepest_pitch = -70.0F * degree_f;
/// How much less the knee bends in a swing of no length, of what the style asks.
constexpr float shorter_swing = 0.478F;
/// How fast the heel rises as the foot leaves the ground, of its mean rate in double support.
constexpr float leaving_rate = 1.79F;

/// A foot's pitch as the heel of the other strikes, from the strike alone: both steps that meet there agree on it.
HWY_NOINLINE inline Pitch trailing_at_strike(const LegSize& leg, const Strike<Lanes<float>>& strike,
                                             const Footing& foot) {
  const PelvisManner pelvis = pelvis_manner(strike.manner, strike.manner, wide(0.0F));
  const HipsAtStrike hips = hips_at(strike);
  auto at = [&](float time) {
    const Place offset = hip_offset(leg, pelvis, 1.0F + load(strike.pace_hz) * time);
    const Place hip = {
        offset.out, offset.up + hips.up + hips.up_velocity * time,
        offset.forward + load(strike.length_m) - load(strike.behind_m) + load(strike.forward_velocity) * time};
    return heel_rise(leg, foot, hip, load(strike.knee) + load(strike.knee_rate) * time);
  };
  return {at(0.0F), (at(dt) - at(-dt)) * (0.5F / dt)};
}

/// The stance foot after foot flat, and the other until it leaves the ground. Gives the latter's pitch then.
HWY_NOINLINE inline Pitch plan_standing_feet(Step& step) {
  StepPlan<Lanes<float>>& plan = *step.plan;
  const Strike<Lanes<float>>&from = plan.from, &to = plan.to;
  const LegSize& leg = step.leg;

  const Wide release = load(to.release) * step.duration;
  const Wide yielding = max(step.duration - release, 0.05F);
  const Wide least = select(step.to_stands, load(from.stance_knee), load(to.stance_knee));
  fit(plan.support_pitch, step.flat, step.duration - step.flat, {wide(0.0F), wide(0.0F)},
      trailing_at_strike(leg, to, step.support), [&](const Wide& t) {
        const Wide u = max((t - release) / yielding, 0.0F);
        const Wide knee = hermite(u, least, wide(0.0F), load(to.knee), load(to.knee_rate) * yielding);
        return heel_rise(leg, step.support, step.hip(t, 0.0F), knee);
      });

  // The trailing foot, places relative to its own foothold. Double support ends early where the foot would have to
  // leave the ground steeper than the calf allows.
  auto hip_behind = [&](const Wide& t) {
    Place hip = step.hip(t, 1.0F);
    hip.forward = hip.forward + load(plan.length_before_m);
    return hip;
  };
  const Place steepest = planted_ankle(leg, step.trailing, wide(steepest_pitch));
  const Wide asked = select(step.to_stands, load(from.toe_off_knee), load(to.toe_off_knee));
  const WideMask stays = step.from_stands & step.to_stands;
  Wide off = step.double_support, knee_off = asked;
  WideMask found = wide(0.0F) > wide(1.0F);
  for (const float part : {1.0F, 0.85F, 0.7F, 0.55F}) {
    const Wide t = step.double_support * part;
    const Place hip = hip_behind(t);
    const Wide dx = hip.out - steepest.out, dy = hip.up - steepest.up, dz = hip.forward - steepest.forward;
    const Wide most = knee_at(leg, sqrt(fma(dx, dx, fma(dy, dy, dz * dz))));
    const WideMask fits = (most >= min(asked, 22.0F * degree_f));
    off = select(found, off, t);
    knee_off = select(found, knee_off, min(asked, most));
    found = found | fits;
  }
  off = select(stays, step.double_support, off);
  knee_off = select(stays, asked, knee_off);
  step.double_support = off;
  store(off, plan.double_support_s);
  const Pitch first = trailing_at_strike(leg, from, step.trailing);
  const Wide last = heel_rise(leg, step.trailing, hip_behind(off), knee_off);
  const Pitch toe_off = {last, (last - first.value) / off * leaving_rate};
  fit(plan.trailing_pitch, wide(0.0F), off, first, toe_off, [&](const Wide& t) {
    return hermite(t / off, first.value, first.rate * off, toe_off.value, toe_off.rate * off);
  });
  return toe_off;
}

/// Height of the lowest of heel, ball and toe tip over the ground.
HWY_NOINLINE inline Wide clearance(const LegSize& leg, const Wide& toes_length, const Wide& ankle_up, const Wide& pitch,
                                   const Wide& toes) {
  Wide p_s, p_c, t_s, t_c;
  sin_cos(pitch, p_s, p_c);
  sin_cos(pitch + toes, t_s, t_c);
  const Wide heel = ankle_up - leg.heel_back * p_s - leg.ankle_height * p_c;
  const Wide joint = ankle_up + leg.ball_forward * p_s - (leg.ankle_height - leg.toe_joint_height) * p_c;
  const Wide ball = joint - leg.toe_joint_height * t_c;
  return min(heel, min(ball, fma(toes_length, t_s, ball)));
}

HWY_INLINE SwingLanes swing_state(const LegAngles& before, const LegAngles& now, const LegAngles& after) {
  SwingLanes s;
  s.q[0] = now.thigh;
  s.q[1] = now.shank;
  s.rate[0] = (after.thigh - before.thigh) * (0.5F / dt);
  s.rate[1] = (after.shank - before.shank) * (0.5F / dt);
  return s;
}

/// Thigh and shank as the foot leaves the ground, and the acceleration of thigh and knee.
HWY_NOINLINE inline SwingLanes at_leaving(const Step& step, const Pitch& toe_off, Wide (&acceleration)[2]) {
  auto with = [&](float later, const Wide& pitch) {
    Place ankle = planted_ankle(step.leg, step.trailing, pitch);
    ankle.forward = ankle.forward - load(step.plan->length_before_m);
    return leg_angles(step.leg, step.hip(step.double_support + later, 1.0F), ankle);
  };
  auto at = [&](float later) { return with(later, toe_off.value + toe_off.rate * later); };
  auto before = [&](float later) {
    return with(later, curve_at(step.plan->trailing_pitch, 1.0F + later / step.double_support));
  };
  const LegAngles now = at(0.0F), once = before(-4.0F * dt), twice = before(-8.0F * dt);
  constexpr float per = 1.0F / (16.0F * dt * dt), most = 120.0F;  // rad/s²
  acceleration[0] = clamp((now.thigh - 2.0F * once.thigh + twice.thigh) * per, -most, most);
  const Wide shank = (now.shank - 2.0F * once.shank + twice.shank) * per;
  acceleration[1] = clamp(acceleration[0] - shank, -most, most);
  return swing_state(at(-dt), now, at(dt));
}

/// The same as the heel strikes, from the strike alone.
HWY_NOINLINE inline SwingLanes at_landing(const Step& step) {
  const Strike<Lanes<float>>& to = step.plan->to;
  const PelvisManner pelvis = pelvis_manner(to.manner, to.manner, wide(0.0F));
  const HipsAtStrike hips = hips_at(to);
  auto at = [&](float later) {
    const Place offset = hip_offset(step.leg, pelvis, load(to.pace_hz) * later);
    const Place hip = {offset.out, offset.up + hips.up + hips.up_velocity * later,
                       offset.forward - load(to.behind_m) + load(to.forward_velocity) * later};
    return leg_angles(step.leg, hip,
                      planted_ankle(step.leg, step.landing, load(to.foot_pitch) + load(to.foot_pitch_rate) * later));
  };
  return swing_state(at(-dt), at(0.0F), at(dt));
}

/// Torques of the swing and the way of its foot.
HWY_NOINLINE inline WideMask plan_swing(Step& step, const Pitch& toe_off) {
  StepPlan<Lanes<float>>& plan = *step.plan;
  const Strike<Lanes<float>>& to = plan.to;
  const GaitStyleOf<Lanes<float>>& style = *step.style;
  const LegSize& leg = step.leg;
  constexpr std::size_t n = swing_steps;

  SwingTask task;
  task.mass = swing_masses(leg);
  task.span = max(step.duration - step.double_support, 0.05F);
  task.first = at_leaving(step, toe_off, task.first_acceleration);
  const SwingLanes target = at_landing(step);
  const Wide covered =
      min((load(plan.length_before_m) + load(to.length_m)) / (2.0F * natural_step_h * step.height), 1.0F);
  const Wide bent = load(style.swing_knee_deg) * degree_f * (1.0F + shorter_swing * (covered - 1.0F));
  task.bent = bent;
  task.last = target;

  Place hip[n + 1];
  const Wide interval = task.span / static_cast<float>(n), per_interval2 = 1.0F / (interval * interval);
  for (std::size_t i = 0; i <= n; ++i)
    hip[i] = step.hip(fma(interval, wide(static_cast<float>(i)), step.double_support), 1.0F);
  for (std::size_t i = 0; i <= n; ++i) {
    const std::size_t m = i == 0 ? 1 : i == n ? n - 1 : i;
    task.hip_forward[i] = (hip[m + 1].forward - 2.0F * hip[m].forward + hip[m - 1].forward) * per_interval2;
    task.hip_up[i] = (hip[m + 1].up - 2.0F * hip[m].up + hip[m - 1].up) * per_interval2;
  }
  SwingLanes path[n + 1];
  const WideMask held = solve_swing(task, path);

  // The foot: its ankle turns from where toe-off has it through mid-swing to where the strike wants it.
  const Wide ankle_off = toe_off.value - task.first.q[1], ankle_strike = load(to.foot_pitch) - target.q[1];
  const Wide ankle_middle = load(style.swing_ankle_deg) * degree_f;
  const Wide off_slope = (toe_off.rate - task.first.rate[1]) * task.span;
  const Wide strike_slope = (load(to.foot_pitch_rate) - target.rate[1]) * task.span;
  constexpr float middle = 0.5657F, early_ankle = 0.053F, late_ankle = 0.88F;
  Place off = planted_ankle(leg, step.trailing, toe_off.value);
  const Place strike = planted_ankle(leg, step.landing, load(to.foot_pitch));
  const Place off_rate = planted_ankle_rate(leg, step.trailing, toe_off.value);
  const Place strike_rate = planted_ankle_rate(leg, step.landing, load(to.foot_pitch));
  const Wide pitch_rate = load(to.foot_pitch_rate);
  const Wide out_slope[2] = {off_rate.out * toe_off.rate * task.span, strike_rate.out * pitch_rate * task.span};
  store(off.out, plan.swing_out_m[0]);
  store(strike.out, plan.swing_out_m[1]);
  store(out_slope[0], plan.swing_out_slope[0]);
  store(out_slope[1], plan.swing_out_slope[1]);
  Wide pitch[n + 1], up[n + 1], forward[n + 1], lowest[n + 1], turned[n + 1], out[n + 1];
  const Wide toes_length = ratio(fraction::toes_length, step.height);
  auto find_lowest = [&](std::size_t i, const Wide& u) {
    const Wide toes = -pitch[i] * (1.0F - ease((u - swing_toes::from) / (swing_toes::to - swing_toes::from)));
    lowest[i] = clearance(leg, toes_length, up[i], pitch[i], toes);
  };
  for (std::size_t i = 0; i <= n; ++i) {
    const Wide u = wide(static_cast<float>(i) / n);
    const Wide fading = max(1.0F - u / early_ankle, 0.0F), rising = max((u - late_ankle) / (1.0F - late_ankle), 0.0F);
    const Wide dorsiflexion = ankle_off + (ankle_middle - ankle_off) * ease(u / middle) +
                              (ankle_strike - ankle_middle) * ease((u - middle) / (1.0F - middle)) +
                              off_slope * u * fading * fading + strike_slope * (u - 1.0F) * rising * rising;
    pitch[i] = dorsiflexion + path[i].q[1];
    turned[i] = dorsiflexion;
    const Place& at = hip[i];
    Wide t_s, t_c, s_s, s_c;
    sin_cos(path[i].q[0], t_s, t_c);
    sin_cos(path[i].q[1], s_s, s_c);
    const Wide down = fma(leg.thigh, t_c, leg.shank * s_c);
    out[i] = hermite(u, off.out, out_slope[0], strike.out, out_slope[1]);
    const Wide aside = out[i] - at.out;
    up[i] = at.up - sqrt(max(down * down - aside * aside, 0.0F));
    forward[i] = at.forward + fma(leg.thigh, t_s, leg.shank * s_s);
    find_lowest(i, u);
  }

  // Where the foot would come lower than asked it is lifted by smooth humps, zero with zero slope at both ends: so that
  // it leaves the ground upward before it goes forward, so that it does not come to the ground before it lands, and
  // over what is left of the swing.
  constexpr float early_clearance = 0.010F;
  auto raise = [&](std::size_t first, std::size_t last, auto hump, auto asked) {
    Wide lift = wide(0.0F);
    for (std::size_t i = first; i <= last; ++i) {
      const float u = static_cast<float>(i) / n;
      lift = max(lift, (asked(u) - lowest[i]) / hump(u));
    }
    lift = min(lift, 0.04F * step.height);
    for (std::size_t i = 0; i <= n; ++i) {
      const Wide by = lift * hump(static_cast<float>(i) / n);
      up[i] = up[i] + by;
      lowest[i] = lowest[i] + by;
    }
  };
  const Wide toe_clearance = load(style.toe_clearance_m);
  auto leaving = [](float u) { return 91.0F * u * u * u * (1 - u) * (1 - u) * (1 - u) * (1 - u) * (1 - u); };
  auto landing = [](float u) { return 65.88F * u * u * u * u * u * (1 - u) * (1 - u); };
  auto passing = [](float u) { return 64.0F * u * u * u * (1.0F - u) * (1.0F - u) * (1.0F - u); };
  auto parting = [&](float u) {
    return landing(1.0F - u);
  };  // less smooth at its start than leaving: only where needed
  auto raise_all = [&] {
    raise(1, n / 8, parting, [](float) { return wide(-0.003F); });
    raise(2, n / 3, leaving, [](float u) {
      const float part = u * u * u / (0.1F * 0.1F * 0.1F);
      return wide(early_clearance * (part < 1.0F ? part : 1.0F));
    });
    raise(3 * n / 4, n - 1, landing, [](float) { return wide(0.0F); });
    raise(n / 4, 3 * n / 4, passing, [&](float u) { return toe_clearance * passing(u); });
  };
  raise_all();
  // Lifting the foot has turned the shank: the foot turns with it, and the lift makes up for that.
  for (std::size_t i = 1; i < n; ++i) {
    const Wide u = wide(static_cast<float>(i) / n);
    pitch[i] = turned[i] + leg_angles(leg, hip[i], {out[i], up[i], forward[i]}).shank;
    find_lowest(i, u);
  }
  raise_all();

  off.forward = off.forward - load(plan.length_before_m);
  fit_samples(plan.swing_pitch, pitch, task.span, toe_off, {load(to.foot_pitch), pitch_rate});
  fit_samples(plan.swing_forward_m, forward, task.span, {off.forward, off_rate.forward * toe_off.rate},
              {strike.forward + load(to.length_m), strike_rate.forward * pitch_rate});
  fit_samples(plan.swing_up_m, up, task.span, {off.up, off_rate.up * toe_off.rate},
              {strike.up, strike_rate.up * pitch_rate});
  return held;
}

}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
