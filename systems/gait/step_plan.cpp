// From one heel strike to the next: sixteen steps solved side by side.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/gait/step_plan.cpp"
#include <hwy/foreach_target.h>

#include "systems/gait/gait.h"
#include "systems/gait/support-inl.h"
#include "systems/gait/swing-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {

constexpr std::size_t intervals = knot_count - 1;
/// How far speed may change from step to step, and what a walk starts with and stops from, m/s at a leg of 0.90 m.
constexpr float most_faster = 0.45F, most_slower = 0.55F, first_speed = 0.80F, last_speed = 0.70F;
/// No foot leaves the ground steeper than the calf allows.
constexpr float steepest_pitch = -70.0F * degree_f;
/// For difference quotients, s.
constexpr float dt = 2e-3F;

/// Everything about one step that its parts share.
struct Step {
  LegSize leg;
  Wide height, mass, duration, double_support, flat;
  Wide rate_from, rate_to;  // of the phase
  WideMask from_stands, to_stands;
  Footing support, trailing, landing;
  const GaitStyleOf<Lanes<float>>* style;
  StepPlan<Lanes<float>>* plan;

  HWY_INLINE Wide phase(const Wide& u) const { return hermite(u, wide(0.0F), rate_from, wide(1.0F), rate_to); }

  /// A leg's own hip at time t, relative to the stance foothold; `turns` 0 for the stance leg, 1 for the other.
  HWY_NOINLINE Place hip(const Wide& t, float turns) const {
    const Wide u = t / duration;
    const PelvisManner pelvis = pelvis_manner(plan->from.manner, plan->to.manner, u);
    const Place middle = {wide(0.0F), curve_at(plan->hip_up_m, u), curve_at(plan->hip_forward_m, u)};
    return middle + hip_offset(leg, pelvis, phase(u) + turns);
  }
};

HWY_INLINE WideMask either(const WideMask& m, const Wide& yes, const Wide& no) {
  return select(m, yes, no) > 0.5F;
}

/// The steps toward the wanted gait: the strike at the end of this one.
HWY_NOINLINE void next_strike(const Wide& height, const Wide& mass, const Gait<Lanes<float>>& wanted,
                              const Strike<Lanes<float>>& from, const WideMask& fresh, const WideMask& right_lands,
                              Strike<Lanes<float>>& to) {
  const Wide leg = ratio(fraction::thigh + fraction::shank, height);
  const Wide scale = sqrt(leg / 0.90F);
  const Wide aim = load(wanted.speed_m_s), now = load(from.speed_m_s);
  const WideMask standing = now <= 0.0F, to_stand = aim <= 0.0F;
  const Wide slower = now - most_slower * scale, faster = now + most_faster * scale;
  const Wide stopping = select(now <= last_speed * scale, wide(0.0F), max(slower, last_speed * scale));
  const Wide walking = select(standing, min(aim, first_speed * scale), min(max(aim, slower), faster));
  StrikeRequest r;
  r.height = height;
  r.mass = mass;
  r.speed = select(fresh, aim, select(to_stand, stopping, walking));
  const Wide law = sqrt(0.24F * height * r.speed);
  const Wide length = load(wanted.step_length_m);
  const Wide scaled = length * sqrt(r.speed / max(aim, 1e-3F));
  r.step_length = select(to_stand, law, select(abs(r.speed - aim) < 1e-6F, length, scaled));
  const Wide uneven = load(wanted.style.step_asymmetry);
  r.length = r.step_length * (1.0F + select(right_lands, uneven, -uneven));
  const Wide cadence = 60.0F * r.speed / max(r.step_length, 1e-3F) * sqrt(height / 1.8F);
  r.double_support_cycle = double_support_of(cadence, load(wanted.style.double_support_scale));
  make_strike(r, wanted.style, to);
}

/// Hip path and trunk over the step.
HWY_NOINLINE WideMask plan_support(Step& step) {
  StepPlan<Lanes<float>>& plan = *step.plan;
  const Strike<Lanes<float>>&from = plan.from, &to = plan.to;
  const GaitStyleOf<Lanes<float>>& style = *step.style;
  const Wide &duration = step.duration, &height = step.height;
  const Wide pivot = load(style.foot_pivot_h) * height;

  SupportTask task;
  task.mass = support_masses(height, step.mass);
  task.duration = duration;
  task.stiffness = load(style.leg_stiffness_n_per_m) * height / 1.8F;
  task.damping = 2.0F * load(style.leg_damping) * sqrt(task.stiffness * step.mass);
  const Wide topple = task.mass.coupling * gravity_f;
  task.lean = load(to.trunk_pitch);
  task.trunk_stiffness = load(style.trunk_stiffness) * topple;
  task.trunk_damping = sqrt(task.trunk_stiffness * task.mass.trunk_inertia);
  task.trunk_hold = topple * task.lean;

  // The hips' wave, and the moments that would take the hips along evenly, as a first guess.
  constexpr std::size_t n = support_halves;
  Wide forward[n + 1];
  SupportGuide& guide = task.guide;
  const Wide start_x = -load(from.behind_m) - pivot, end_x = load(to.length_m) - load(to.behind_m) - pivot;
  const Wide vx0 = load(from.forward_velocity), vx1 = load(to.forward_velocity);
  for (std::size_t i = 0; i <= n; ++i) {
    const Wide u = wide(static_cast<float>(i) / n), e = ease(u);
    Wide s, c;
    sin_cos(2.0F * pi_f * (step.phase(u) - lowest_phase), s, c);
    forward[i] = hermite(u, start_x, vx0 * duration, end_x, vx1 * duration);
    guide.up[i] =
        mix(load(from.up_mean_m), load(to.up_mean_m), e) - mix(load(from.up_wave_m), load(to.up_wave_m), e) * c;
  }
  const Wide half = duration / static_cast<float>(n), per_half = 1.0F / half;
  task.lever = 1.0F - load(style.roll_over);
  const Wide behind = -load(plan.length_before_m) + 0.9F * step.leg.ball_forward - pivot;
  const Wide load_from = load(plan.load_from), load_to = load(plan.load_to);
  // The other leg's centre goes from behind the hips to before them, at both strikes moving with a foot on the ground:
  // it takes a force to do that, and its weight turns.
  const Wide leg_behind = -0.165F * load(plan.length_before_m), leg_ahead = 0.20F * load(to.length_m);
  const Wide leg_from = -0.5F * vx0 * duration, leg_to = -0.5F * vx1 * duration;
  const Wide leg_rise = leg_ahead - leg_behind - leg_from, leg_slope = leg_to - leg_from;
  const Wide c3 = 10.0F * leg_rise - 4.0F * leg_slope, c4 = -15.0F * leg_rise + 7.0F * leg_slope;
  const Wide c5 = 6.0F * leg_rise - 3.0F * leg_slope;
  const Wide swing_mass = 0.161F * step.mass;
  Wide lacking_sum = wide(0.0F), lacking_left = wide(0.0F);  // of the moments, and weighted by the time left
  for (std::size_t i = 0; i <= n; ++i) {
    const std::size_t b = i == 0 ? 1 : i == n ? n - 1 : i;  // second differences at the ends are their neighbours'
    auto bend_of = [&](const Wide* x) { return (x[b + 1] - 2.0F * x[b] + x[b - 1]) * (per_half * per_half); };
    const Wide& y = guide.up[i];
    const Wide* ys = guide.up;
    guide.up_rate[i] = i == 0   ? hips_at(from).up_velocity
                       : i == n ? hips_at(to).up_velocity
                                : (ys[i + 1] - ys[i - 1]) * (0.5F * per_half);
    guide.up_acceleration[i] = bend_of(ys);
    guide.weight[i] = step.mass * (gravity_f + guide.up_acceleration[i]);
    const float part = static_cast<float>(i) / n;
    const Wide share = mix(load_from, load_to, ease(part * duration / step.double_support));
    guide.behind[i] = behind * (1.0F - share);
    const Wide leg_place = leg_behind + part * (leg_from + part * part * (c3 + part * (c4 + part * c5)));
    const Wide leg_bend = part * (6.0F * c3 + part * (12.0F * c4 + part * 20.0F * c5)) / (duration * duration);
    guide.swing_force[i] = -swing_mass * leg_bend;
    guide.swing_weight[i] = swing_mass * gravity_f * leg_place;

    const Wide &x = forward[i], ax = bend_of(forward);
    const Wide needed = task.mass.leg * (y * ax - x * guide.up_acceleration[i]) - task.mass.moment * gravity_f * x +
                        task.mass.coupling * (ax - gravity_f * task.lean);
    const Wide lacking =
        (needed + guide.weight[i] * fnma(task.lever, x - guide.behind[i], x)) * (i == 0 || i == n ? 0.5F : 1.0F);
    lacking_sum = lacking_sum + lacking;
    lacking_left = lacking_left + lacking * (1.0F - part);
  }

  const Wide start_y = hips_at(from).up, vy0 = hips_at(from).up_velocity;
  const Wide l = sqrt(fma(start_x, start_x, start_y * start_y));
  task.first.q[0] = l;
  task.first.q[1] = atan2(start_x, start_y);
  task.first.q[2] = load(from.trunk_pitch);
  task.first.rate[0] = fma(start_x, vx0, start_y * vy0) / l;
  task.first.rate[1] = (start_y * vx0 - start_x * vy0) / (l * l);
  task.first.rate[2] = wide(0.0F);
  task.last[0] = end_x;
  task.last[1] = vx1;
  const Wide last[6] = {end_x, vx1, hips_at(to).up, hips_at(to).up_velocity, load(to.trunk_pitch), wide(0.0F)};
  task.scale = 0.3F * step.mass * gravity_f * l;
  // Two moments of that integral and of that effect on the place at the end.
  constexpr float all = static_cast<float>(n), all_left = 0.5F * all;
  constexpr float r = 1.0F / (early_pulse.sum * all_left - all * early_pulse.left);
  task.guess[0] = (lacking_sum * all_left - lacking_left * all) * r / task.scale;
  task.guess[1] = (lacking_left * early_pulse.sum - lacking_sum * early_pulse.left) * r / task.scale;

  SupportPath path;
  const WideMask held = solve_support(task, last, path);
  const Wide per_knot = duration / static_cast<float>(intervals);
  for (std::size_t k = 0; k <= intervals; ++k) {
    store(path.forward[k] + pivot, plan.hip_forward_m.value[k]);
    store(path.forward_velocity[k] * per_knot, plan.hip_forward_m.slope[k]);
    store(path.up[k], plan.hip_up_m.value[k]);
    store(path.up_velocity[k] * per_knot, plan.hip_up_m.slope[k]);
    store(path.trunk[k], plan.trunk_pitch.value[k]);
    store(path.trunk_rate[k] * per_knot, plan.trunk_pitch.slope[k]);
  }
  return held;
}

struct Pitch {
  Wide value, rate;
};

/// A foot's pitch as the heel of the other strikes, from the strike alone: both steps that meet there agree on it.
HWY_NOINLINE Pitch trailing_at_strike(const LegSize& leg, const Strike<Lanes<float>>& strike, const Footing& foot) {
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

/// A curve through value(t) at equal times from `start` over `span`, slopes by central differences; the ends as given.
template <class Value>
HWY_INLINE void fit(Curve<Lanes<float>>& curve, const Wide& start, const Wide& span, const Pitch& first,
                    const Pitch& last, Value value) {
  Wide at[2 * intervals + 1];
  at[0] = first.value;
  at[2 * intervals] = last.value;
  for (std::size_t i = 1; i < 2 * intervals; ++i)
    at[i] = value(fma(span, wide(static_cast<float>(i) / (2 * intervals)), start));
  const Wide per_knot = span / static_cast<float>(intervals);
  for (std::size_t k = 0; k <= intervals; ++k) {
    store(at[2 * k], curve.value[k]);
    const Wide slope = k == 0           ? first.rate * per_knot
                       : k == intervals ? last.rate * per_knot
                                        : at[2 * k + 1] - at[2 * k - 1];
    store(slope, curve.slope[k]);
  }
}

/// The stance foot after foot flat, and the other until it leaves the ground. Gives the latter's pitch then.
HWY_NOINLINE Pitch plan_standing_feet(Step& step) {
  StepPlan<Lanes<float>>& plan = *step.plan;
  const Strike<Lanes<float>>&from = plan.from, &to = plan.to;
  const LegSize& leg = step.leg;

  const Wide release = load(to.release) * step.duration;
  const Wide yielding = max(step.duration - release, 0.05F);
  const Wide least = load(step.style->stance_knee_deg) * degree_f;
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
  const Wide asked_rate = select(step.to_stands, load(from.toe_off_knee_rate), load(to.toe_off_knee_rate));
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
  auto trailing = [&](const Wide& t) {
    const Wide knee = hermite(t / off, load(from.knee), load(from.knee_rate) * off, knee_off, asked_rate * off);
    return heel_rise(leg, step.trailing, hip_behind(t), knee);
  };
  const Pitch toe_off = {trailing(off), (trailing(off + dt) - trailing(off - dt)) * (0.5F / dt)};
  fit(plan.trailing_pitch, wide(0.0F), off, trailing_at_strike(leg, from, step.trailing), toe_off, trailing);
  return toe_off;
}

/// Height of the lowest of heel, ball and toe tip over the ground.
HWY_INLINE Wide clearance(const LegSize& leg, const Wide& toes_length, const Wide& ankle_up, const Wide& pitch,
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
HWY_NOINLINE SwingLanes at_leaving(const Step& step, const Pitch& toe_off, Wide (&acceleration)[2]) {
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
  constexpr float per = 1.0F / (16.0F * dt * dt), most = 150.0F;  // rad/s²
  acceleration[0] = clamp((now.thigh - 2.0F * once.thigh + twice.thigh) * per, -most, most);
  const Wide shank = (now.shank - 2.0F * once.shank + twice.shank) * per;
  acceleration[1] = clamp(acceleration[0] - shank, -most, most);
  return swing_state(at(-dt), now, at(dt));
}

/// The same as the heel strikes, from the strike alone.
HWY_NOINLINE SwingLanes at_landing(const Step& step) {
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
HWY_NOINLINE WideMask plan_swing(Step& step, const Pitch& toe_off) {
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
  const Wide bent = load(style.swing_knee_deg) * degree_f * (0.5F + 0.5F * covered);
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
  constexpr float middle = 0.45F, early_ankle = 0.20F, late_ankle = 0.88F;
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
    const Wide toes = -pitch[i] * (1.0F - ease((u - swing_toes::from) / (swing_toes::to - swing_toes::from)));
    lowest[i] = clearance(leg, toes_length, up[i], pitch[i], toes);
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
  auto raise_all = [&] {
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
    const Wide toes = -pitch[i] * (1.0F - ease((u - swing_toes::from) / (swing_toes::to - swing_toes::from)));
    lowest[i] = clearance(leg, toes_length, up[i], pitch[i], toes);
  }
  raise_all();

  const Wide per_knot = task.span / static_cast<float>(intervals);
  auto write = [&](Curve<Lanes<float>>& curve, const Wide* at, const Pitch& first, const Pitch& last) {
    for (std::size_t k = 0; k <= intervals; ++k) {
      const Wide slope = k == 0           ? first.rate * per_knot
                         : k == intervals ? last.rate * per_knot
                                          : at[2 * k + 1] - at[2 * k - 1];
      store(k == 0 ? first.value : k == intervals ? last.value : at[2 * k], curve.value[k]);
      store(slope, curve.slope[k]);
    }
  };
  off.forward = off.forward - load(plan.length_before_m);
  write(plan.swing_pitch, pitch, toe_off, {load(to.foot_pitch), pitch_rate});
  write(plan.swing_forward_m, forward, {off.forward, off_rate.forward * toe_off.rate},
        {strike.forward + load(to.length_m), strike_rate.forward * pitch_rate});
  write(plan.swing_up_m, up, {off.up, off_rate.up * toe_off.rate}, {strike.up, strike_rate.up * pitch_rate});
  return held;
}

/// Whether all words of two components are the same, lane by lane.
template <class C>
HWY_INLINE WideMask same_words(const C& a, const C& b) {
  constexpr std::size_t words = sizeof(C) / sizeof(Lanes<float>);
  const auto* x = reinterpret_cast<const float*>(&a);
  const auto* y = reinterpret_cast<const float*>(&b);
  Wide off = wide(0.0F);
  for (std::size_t i = 0; i < words; ++i) off = max(off, abs(load(x + i * lane_count) - load(y + i * lane_count)));
  return off <= 0.0F;
}

HWY_INLINE void store_flags(const WideMask& mask, Lanes<std::uint32_t>& words) {
  Lanes<float> one;
  store(select(mask, wide(1.0F), wide(0.0F)), one);
  for (std::size_t l = 0; l < lane_count; ++l) words[l] = static_cast<std::uint32_t>(one[l]);
}

/// Solves the step from plan.from to plan.to.
HWY_NOINLINE void solve_step(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted,
                             const WideMask& right_lands, StepPlan<Lanes<float>>& plan) {
  const Strike<Lanes<float>>&from = plan.from, &to = plan.to;
  Step step;
  step.height = load(size.height_m);
  step.mass = load(size.mass_kg);
  step.leg = leg_size(step.height);
  step.style = &wanted.style;
  step.plan = &plan;
  step.from_stands = load(from.speed_m_s) <= 0.0F;
  step.to_stands = load(to.speed_m_s) <= 0.0F;
  const WideMask stays = step.from_stands & step.to_stands;
  const Wide pace_from = load(from.pace_hz), pace_to = load(to.pace_hz);
  const Wide uneven = load(wanted.style.time_asymmetry);
  const Wide even = select(step.from_stands | step.to_stands, 1.3F / max(max(pace_from, pace_to), 0.1F),
                           2.0F / max(pace_from + pace_to, 0.1F));
  step.duration = select(stays, wide(0.25F), even * (1.0F + select(right_lands, uneven, -uneven)));
  step.rate_from = pace_from * step.duration;
  step.rate_to = pace_to * step.duration;
  const Wide part =
      select(step.from_stands, select(step.to_stands, wide(1.0F), wide(0.45F)), load(from.double_support));
  step.double_support = part * step.duration;
  step.flat = min(select(step.from_stands, wide(0.1F), load(from.flat) / max(pace_from, 0.1F)), 0.6F * step.duration);
  step.support = footing(load(from.half_width_m), load(from.toe_out));
  step.trailing = footing(load(plan.trailing_half_width_m), load(plan.trailing_toe_out));
  step.landing = footing(load(to.half_width_m), load(to.toe_out));
  store(step.duration, plan.duration_s);
  store(step.double_support, plan.double_support_s);
  store(step.flat, plan.flat_s);
  store(select(stays, wide(0.5F), wide(1.0F)), plan.load_to);
  store(load(to.length_m), plan.step_length_m);
  store(load(from.length_m), plan.length_before_m);
  store(step.rate_from, plan.phase_rate_from);
  store(step.rate_to, plan.phase_rate_to);

  WideMask held = plan_support(step);
  const Pitch toe_off = plan_standing_feet(step);
  held = held | plan_swing(step, toe_off);
  store_flags(held & either(stays, wide(0.0F), wide(1.0F)), plan.clamped);

  const Wide load_from = load(plan.load_from);
  const WideMask even_load = either(stays, select(load_from >= 0.5F, wide(1.0F), wide(0.0F)), wide(1.0F));
  const WideMask even_steps = (abs(load(wanted.style.step_asymmetry)) + abs(uneven)) <= 0.0F;
  const WideMask there = abs(load(to.speed_m_s) - load(wanted.speed_m_s)) <= 0.0F;
  const WideMask same_feet = (abs(load(plan.trailing_half_width_m) - load(from.half_width_m)) +
                              abs(load(plan.trailing_toe_out) - load(from.toe_out))) <= 0.0F;
  store_flags(same_words(from, to) & (even_load & even_steps) & (there & same_feet), plan.settled);
  plan.revision = wanted.revision;
}

void first_block(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted, StepPlan<Lanes<float>>& plan) {
  const Wide zero = wide(0.0F), one = wide(1.0F);
  const WideMask all = one > zero, left_lands = zero > one;
  store(load(wanted.speed_m_s), plan.from.speed_m_s);
  next_strike(load(size.height_m), load(size.mass_kg), wanted, plan.from, all, all, plan.from);
  next_strike(load(size.height_m), load(size.mass_kg), wanted, plan.from, all, left_lands, plan.to);
  plan.trailing_half_width_m = plan.from.half_width_m;
  plan.trailing_toe_out = plan.from.toe_out;
  store(select(load(wanted.speed_m_s) <= 0.0F, wide(0.5F), zero), plan.load_from);
  solve_step(size, wanted, left_lands, plan);
}

void next_block(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted,
                const GaitState<Lanes<float>>& state, StepPlan<Lanes<float>>& plan) {
  const Wide zero = wide(0.0F), one = wide(1.0F);
  const WideMask right_lands = equal(state.stance_side, left), fresh = zero > one;
  const WideMask stood = (load(plan.from.speed_m_s) <= 0.0F) & (load(plan.to.speed_m_s) <= 0.0F);
  store(select(stood, wide(0.5F), zero), plan.load_from);
  plan.trailing_half_width_m = plan.from.half_width_m;
  plan.trailing_toe_out = plan.from.toe_out;
  plan.from = plan.to;
  next_strike(load(size.height_m), load(size.mass_kg), wanted, plan.from, fresh, right_lands, plan.to);
  solve_step(size, wanted, right_lands, plan);
}

}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil {

HWY_EXPORT(first_block);
HWY_EXPORT(next_block);

void plan_first_step(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted,
                     StepPlan<Lanes<float>>& plan) {
  HWY_DYNAMIC_DISPATCH(first_block)(size, wanted, plan);
}

void plan_next_step(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& wanted,
                    const GaitState<Lanes<float>>& state, StepPlan<Lanes<float>>& plan) {
  HWY_DYNAMIC_DISPATCH(next_block)(size, wanted, state, plan);
}

}  // namespace mobil
#endif
