// The hips and the trunk over a step: what the support model (support-inl.h) is asked, and the curves it gives. Include
// it as engine/wide-inl.h says.

#if defined(MOBIL_SYSTEMS_GAIT_HIPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_GAIT_HIPS_INL_H_
#undef MOBIL_SYSTEMS_GAIT_HIPS_INL_H_
#else
#define MOBIL_SYSTEMS_GAIT_HIPS_INL_H_
#endif

#include "systems/gait/step-inl.h"
#include "systems/gait/support-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {

/// Hip path and trunk over the step.
HWY_NOINLINE inline WideMask plan_support(Step& step) {
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
  // What the legs do to the hips beyond what the model's straight, heavy stance leg does: after toe-off it takes a
  // force to bring the other leg forward and to stop it, and its weight turns. Its course before the swing is solved,
  // in step lengths and durations of the swing, is what solved swings have at all speeds.
  const Wide mean_length = 0.5F * (load(plan.length_before_m) + load(to.length_m));
  const Wide swinging = max(duration - step.double_support, 0.1F);
  const Wide pull = 2.53F * mean_length / (swinging * swinging);
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
    const Wide v = clamp((part * duration - step.double_support) / swinging, 0.0F, 1.0F);
    const Wide leg_bend =
        select(v > 0.0F, pull * (1.0F - v) * fma(fma(wide(-21.0F), v, wide(5.1F)), v, wide(1.0F)), wide(0.0F));
    const Wide leg_place = mean_length * (0.45F * ease(v) - 0.02F);
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
  WideMask held = solve_support(task, last, path);
  // A run that fell over, or that its spring threw about, is no walk: the hips then go evenly, along their wave.
  WideMask sound = wide(0.0F) <= wide(0.0F);
  const Wide astray = 0.3F * l;
  for (std::size_t k = 0; k <= intervals; ++k)
    sound = sound & (abs(path.forward[k] - forward[2 * k]) < astray) & (abs(path.up[k] - guide.up[2 * k]) < astray) &
            (abs(path.trunk[k]) < wide(1.0F));
  for (std::size_t k = 0; k <= intervals; ++k) {
    const Wide even = k == 0           ? vx0
                      : k == intervals ? vx1
                                       : (forward[2 * k + 1] - forward[2 * k - 1]) * (0.5F * per_half);
    const Wide u = wide(static_cast<float>(k) / intervals), lean_by = task.lean - load(from.trunk_pitch);
    path.forward[k] = select(sound, path.forward[k], forward[2 * k]);
    path.forward_velocity[k] = select(sound, path.forward_velocity[k], even);
    path.up[k] = select(sound, path.up[k], guide.up[2 * k]);
    path.up_velocity[k] = select(sound, path.up_velocity[k], guide.up_rate[2 * k]);
    path.trunk[k] = select(sound, path.trunk[k], fma(lean_by, ease(u), load(from.trunk_pitch)));
    path.trunk_rate[k] = select(sound, path.trunk_rate[k], 6.0F * u * (1.0F - u) * lean_by / duration);
  }
  held = held | (select(sound, wide(0.0F), wide(1.0F)) > 0.5F);
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

}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
