// The body over its support leg from one heel strike to the next, sixteen walkers at a time: the forces that bring it
// from the state at the one to the state at the other. Model and equations as tests/gait/step_dynamics.h has them in
// double precision. Include it as engine/wide-inl.h says.

#if defined(MOBIL_SYSTEMS_GAIT_SUPPORT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_GAIT_SUPPORT_INL_H_
#undef MOBIL_SYSTEMS_GAIT_SUPPORT_INL_H_
#else
#define MOBIL_SYSTEMS_GAIT_SUPPORT_INL_H_
#endif

#include "systems/gait/shoot-inl.h"
#include "systems/gait/strike-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {

constexpr std::size_t support_steps = knot_count - 1;
constexpr std::size_t support_halves = 2 * support_steps;

/// Masses (kg), lengths (m), moments of inertia (kg m²): Winter's fractions, leg 0.161 of the mass, head, arms and
/// trunk 0.678; the trunk's length is 0.288 of the height.
struct SupportMasses {
  Wide leg, moment, leg_inertia;  // 𝓜 and 𝓖 of the equations stand in `leg` and `moment`
  Wide coupling, trunk_inertia;   // m₂ r₂ and m₂ r₂² + I₂
};

HWY_NOINLINE inline SupportMasses support_masses(const Wide& height, const Wide& mass) {
  constexpr float leg_part = 0.161F, trunk_part = 0.678F, centre = 0.553F;
  const Wide trunk = 0.288F * height;
  const Wide leg_gyration = ratio(0.326 * (fraction::thigh + fraction::shank), height);
  const Wide trunk_centre = 0.626F * trunk, gyration = 0.496F * trunk;
  const Wide above = (leg_part + trunk_part) * mass;
  return {leg_part * centre * centre * mass + above, leg_part * centre * mass + above,
          leg_part * mass * leg_gyration * leg_gyration, trunk_part * mass * trunk_centre,
          trunk_part * mass * (trunk_centre * trunk_centre + gyration * gyration)};
}

/// q = [ω, θ₁, θ₂] and rates.
struct SupportLanes {
  Wide q[3], rate[3];
};

MOBIL_WIDE_INLINE void support_acceleration(const SupportMasses& m, const SupportLanes& s, const Wide (&force)[3],
                                            Wide (&acceleration)[3]) {
  const Wide &length = s.q[0], &length_rate = s.rate[0], &leg_rate = s.rate[1], &trunk_rate = s.rate[2];
  Wide l_s, l_c, u_s, u_c;
  sin_cos(s.q[1], l_s, l_c);
  sin_cos(s.q[2], u_s, u_c);
  const Wide d_s = fnma(l_c, u_s, l_s * u_c), d_c = fma(l_c, u_c, l_s * u_s);
  const Wide a2 = fma(m.leg * length, length, m.leg_inertia);
  const Wide c1 = m.coupling * d_s, c2 = m.coupling * length * d_c;
  const Wide spin2 = trunk_rate * trunk_rate;
  const Wide b1 =
      force[0] + m.coupling * d_c * spin2 + m.leg * length * leg_rate * leg_rate - m.moment * gravity_f * l_c;
  const Wide b2 = force[1] - c1 * length * spin2 - 2.0F * m.leg * length * length_rate * leg_rate +
                  m.moment * gravity_f * length * l_s;
  const Wide b3 = force[2] - m.coupling * leg_rate * (2.0F * length_rate * d_c - length * leg_rate * d_s) +
                  m.coupling * gravity_f * u_s;
  const Wide e1 = c1 / m.leg, e2 = c2 / a2;
  const Wide x3 = (b3 - e1 * b1 - e2 * b2) / (m.trunk_inertia - e1 * c1 - e2 * c2);
  acceleration[0] = (b1 - c1 * x3) / m.leg;
  acceleration[1] = (b2 - c2 * x3) / a2;
  acceleration[2] = x3;
}

/// What time alone gives, at every half step.
struct SupportGuide {
  Wide up[support_halves + 1], up_rate[support_halves + 1], up_acceleration[support_halves + 1];  // the hips' wave
  Wide weight[support_halves + 1];                                         // vertical reaction that goes with it, N
  Wide swing_force[support_halves + 1], swing_weight[support_halves + 1];  // of the other leg on the hips, N and N m
  Wide behind[support_halves + 1];  // where the feet together bear it, for hips over the pivot, m
};

struct SupportTask {
  SupportMasses mass;
  Wide duration, stiffness, damping;
  Wide lean, trunk_stiffness, trunk_damping, trunk_hold;
  Wide lever;  // of the reaction about the pivot, of the hips' distance from where it is borne
  SupportLanes first;
  Wide last[2];  // forward, its rate
  Wide scale;    // of the unknown moments, N m
  Wide guess[2];
  SupportGuide guide;
};

/// What was found: the hips relative to the pivot and the trunk, with rates, at equal times.
struct SupportPath {
  Wide forward[support_steps + 1], forward_velocity[support_steps + 1];
  Wide up[support_steps + 1], up_velocity[support_steps + 1];
  Wide trunk[support_steps + 1], trunk_rate[support_steps + 1];
};

/// The unknowns are a moment in the first fifth of the cycle (of the step: early_end) and a shift of the centre of
/// pressure throughout.
constexpr float early_end = 0.4F;

struct EarlyPulse {
  float at[support_halves + 1];
  float sum, left;  // of it, and weighted by the part of the step that is left, ends half
};

constexpr EarlyPulse make_early_pulse() {
  EarlyPulse p{};
  for (std::size_t i = 0; i <= support_halves; ++i) {
    const float u = static_cast<float>(i) / support_halves;
    const float a = u < early_end ? u / early_end : 0.0F;
    p.at[i] = 16.0F * a * a * (1.0F - a) * (1.0F - a);
    p.sum += p.at[i];
    p.left += p.at[i] * (1.0F - u);
  }
  return p;
}

inline constexpr EarlyPulse early_pulse = make_early_pulse();

MOBIL_WIDE_INLINE void hips_of(const SupportLanes& s, Wide& forward, Wide& forward_rate, Wide& up, Wide& up_rate) {
  Wide sine, cosine;
  sin_cos(s.q[1], sine, cosine);
  forward = s.q[0] * sine;
  up = s.q[0] * cosine;
  forward_rate = fma(s.rate[0], sine, up * s.rate[1]);
  up_rate = fnma(forward, s.rate[1], s.rate[0] * cosine);
}

/// One run with given moments; `path` may be null. Leaves the hips' place forward and its rate in `end`.
///   F_θ₁ = −N (x − lever (x − behind)) − F_θ₂ + the unknown moments: the centre of pressure, the trunk's reaction
///          + what the other leg does to the hips as it swings
///   F_ω  = what moves the hips up and down along their wave against weight and F_θ₁, a spring and a damper about it
///   F_θ₂ = a spring and a damper about the lean
HWY_NOINLINE inline void run_support(const SupportTask& task, const Wide (&unknown)[2], SupportPath* path,
                                     Wide (&end)[2]) {
  SupportLanes s = task.first;
  const Wide h = task.duration / static_cast<float>(support_steps);
  const Wide early = unknown[0] * task.scale, shift = unknown[1] * task.scale;
  auto acceleration = [&](std::size_t half, const SupportLanes& at, Wide(&a)[3]) {
    const SupportGuide& guide = task.guide;
    Wide sine, cosine;
    sin_cos(at.q[1], sine, cosine);
    const Wide x = at.q[0] * sine, y = at.q[0] * cosine;
    const Wide rising = fnma(x, at.rate[1], at.rate[0] * cosine);
    Wide force[3];
    force[2] = -task.trunk_hold - fma(task.trunk_stiffness, at.q[2] - task.lean, task.trunk_damping * at.rate[2]);
    force[1] = fma(early, wide(early_pulse.at[half]), shift) - force[2] -
               guide.weight[half] * fnma(task.lever, x - guide.behind[half], x) +
               fma(guide.swing_force[half], y, guide.swing_weight[half]);
    // the other leg's push is level: along the leg it is borne by what follows from F_θ₁
    const Wide lift = fma(task.mass.leg, guide.up_acceleration[half], task.mass.moment * gravity_f) +
                      fma(task.stiffness, guide.up[half] - y, task.damping * (guide.up_rate[half] - rising));
    force[0] = (lift + force[1] * sine / at.q[0]) / cosine;
    support_acceleration(task.mass, at, force, a);
  };
  for (std::size_t i = 0; i <= support_steps; ++i) {
    Wide up, up_rate;
    hips_of(s, end[0], end[1], up, up_rate);
    if (path != nullptr) {
      path->forward[i] = end[0];
      path->forward_velocity[i] = end[1];
      path->up[i] = up;
      path->up_velocity[i] = up_rate;
      path->trunk[i] = s.q[2];
      path->trunk_rate[i] = s.rate[2];
    }
    if (i < support_steps) runge_kutta<3>(s, h, 2 * i, acceleration);
  }
}

/// Newton shooting from the guess on the two moments for the hips' place and speed at the step's end. What
/// is left there, of the trunk too, is spread over the step, so that both ends are met exactly. True where the moments
/// had to be held back.
HWY_NOINLINE inline WideMask solve_support(const SupportTask& task, const Wide (&last)[6], SupportPath& path) {
  constexpr float most = 3.0F;
  auto run = [&](const Wide(&x)[2], Wide(&end)[2]) { run_support(task, x, nullptr, end); };
  Wide x[2] = {task.guess[0], task.guess[1]};
  shoot<2>(run, task.last, most, 2, x);
  Wide end[2];
  run_support(task, x, &path, end);
  const WideMask held = (abs(x[0]) >= most) | (abs(x[1]) >= most);
  auto spread = [&](Wide(&place)[support_steps + 1], Wide(&rate)[support_steps + 1], const Wide& wanted,
                    const Wide& wanted_rate) {
    const Wide by = wanted - place[support_steps], by_rate = wanted_rate - rate[support_steps];
    for (std::size_t i = 1; i <= support_steps; ++i) {
      const float u = static_cast<float>(i) / support_steps, v = 1.0F - u;
      place[i] = place[i] + by * (u * u * (3.0F - 2.0F * u)) - by_rate * task.duration * (u * u * v);
      rate[i] = rate[i] + by / task.duration * (6.0F * u * v) + by_rate * (3.0F * u * u - 2.0F * u);
    }
  };
  spread(path.forward, path.forward_velocity, last[0], last[1]);
  spread(path.up, path.up_velocity, last[2], last[3]);
  spread(path.trunk, path.trunk_rate, last[4], last[5]);
  return held;
}

}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
