// The swing of one leg from toe-off to heel strike, sixteen walkers at a time. The knee bends and stretches, and the
// leg's centre of mass goes forward, each with the least mean square change of acceleration between its boundary
// conditions: so the hip feels no jerk either. The torques that it takes follow from the equations that
// tests/gait/step_dynamics.h has in double precision. Include it as engine/wide-inl.h says.

#if defined(MOBIL_SYSTEMS_GAIT_SWING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_GAIT_SWING_INL_H_
#undef MOBIL_SYSTEMS_GAIT_SWING_INL_H_
#else
#define MOBIL_SYSTEMS_GAIT_SWING_INL_H_
#endif

#include "systems/gait/leg-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {

constexpr std::size_t swing_steps = 2 * (knot_count - 1);
/// When the knee is bent most, of the swing.
constexpr float bent_part = 0.2354F;
/// What hip and knee may be asked, N m per kg of body mass.
constexpr float most_torque = 4.0F;

/// Thigh and shank with foot (Winter's fractions of the body's mass), per kg of it.
struct SwingMasses {
  Wide a11, a22, coupling, moment, shank_moment, length;
};

HWY_NOINLINE inline SwingMasses swing_masses(const LegSize& leg) {
  constexpr float thigh_mass = 0.100F, shank_mass = 0.061F;
  const Wide thigh_centre = 0.433F * leg.thigh, shank_centre = 0.606F * leg.shank;
  const Wide thigh_gyration = 0.323F * leg.thigh, shank_gyration = 0.416F * leg.shank;
  return {
      thigh_mass * (thigh_gyration * thigh_gyration + thigh_centre * thigh_centre) + shank_mass * leg.thigh * leg.thigh,
      shank_mass * (shank_gyration * shank_gyration + shank_centre * shank_centre),
      shank_mass * leg.thigh * shank_centre,
      thigh_mass * thigh_centre + shank_mass * leg.thigh,
      shank_mass * shank_centre,
      leg.thigh};
}

/// q = [θ₃, θ₄] and rates.
struct SwingLanes {
  Wide q[2], rate[2];
};

struct SwingTorques {
  Wide hip, knee;  // F_θ₃ = hip − knee, F_θ₄ = knee; N m per kg of body mass
};

/// The torques of given accelerations (equations 4 and 5 of the two-link swing leg), the hip accelerating by (forward,
/// up) in m/s².
MOBIL_WIDE_INLINE SwingTorques swing_torques(const SwingMasses& m, const SwingLanes& s, const Wide (&acceleration)[2],
                                             const Wide& hip_forward, const Wide& hip_up) {
  Wide t_s, t_c, s_s, s_c;
  sin_cos(s.q[0], t_s, t_c);
  sin_cos(s.q[1], s_s, s_c);
  const Wide d_s = fnma(t_c, s_s, t_s * s_c), d_c = fma(t_c, s_c, t_s * s_s);
  const Wide down = hip_up + gravity_f;
  const Wide a12 = m.coupling * d_c, turning = m.coupling * d_s;
  const Wide thigh = m.a11 * acceleration[0] + a12 * acceleration[1] + turning * s.rate[1] * s.rate[1] +
                     m.moment * fma(hip_forward, t_c, down * t_s);
  const Wide knee = m.a22 * acceleration[1] + a12 * acceleration[0] - turning * s.rate[0] * s.rate[0] +
                    m.shank_moment * fma(hip_forward, s_c, down * s_s);
  return {thigh + knee, knee};
}

/// An angle with its rate and acceleration.
struct Turning {
  Wide value, rate, acceleration;
};

/// The fifth-degree polynomial between two angles with their rates and accelerations over a span of time, at a part of
/// it: the motion of least mean square jerk between them.
MOBIL_WIDE_INLINE Turning least_jerk(const Wide& u, const Wide& span, const Turning& a, const Turning& b) {
  const Wide da = a.rate * span, db = b.rate * span;
  const Wide ea = 0.5F * a.acceleration * span * span, eb = 0.5F * b.acceleration * span * span;
  const Wide rise = b.value - a.value - da - ea, slope = db - da - 2.0F * ea, bend = eb - ea;
  const Wide c3 = 10.0F * rise - 4.0F * slope + bend;
  const Wide c4 = -15.0F * rise + 7.0F * slope - 2.0F * bend;
  const Wide c5 = 6.0F * rise - 3.0F * slope + bend;
  return {fma(fma(fma(fma(fma(c5, u, c4), u, c3), u, ea), u, da), u, a.value),
          fma(fma(fma(fma(5.0F * c5, u, 4.0F * c4), u, 3.0F * c3), u, 2.0F * ea), u, da) / span,
          fma(fma(fma(20.0F * c5, u, 12.0F * c4), u, 6.0F * c3), u, 2.0F * ea) / (span * span)};
}

struct SwingTask {
  SwingMasses mass;
  Wide span;  // s
  SwingLanes first, last;
  Wide first_acceleration[2];                                  // of thigh and knee as the foot leaves the ground
  Wide bent;                                                   // greatest knee flexion
  Wide hip_forward[swing_steps + 1], hip_up[swing_steps + 1];  // the hip's acceleration
};

/// Thigh and shank at equal times. True where the torques are beyond what hip and knee can.
HWY_NOINLINE inline WideMask solve_swing(const SwingTask& task, SwingLanes (&path)[swing_steps + 1]) {
  const SwingLanes &a = task.first, &b = task.last;
  const SwingMasses& m = task.mass;
  const Wide zero = wide(0.0F), bending = task.span * bent_part, stretching = task.span * (1.0F - bent_part);
  const Turning knee_off = {a.q[0] - a.q[1], a.rate[0] - a.rate[1], task.first_acceleration[1]};
  const Turning knee_last = {b.q[0] - b.q[1], b.rate[0] - b.rate[1], zero};
  // Where the knee is bent most it is slowed down as two cubics on either side would on average.
  const Wide slowing = (3.0F * (knee_off.value - task.bent) + knee_off.rate * bending) / (bending * bending) +
                       (3.0F * (knee_last.value - task.bent) - knee_last.rate * stretching) / (stretching * stretching);
  const Turning knee_bent = {task.bent, zero, slowing};
  // First moment of the leg's mass ahead of the hip, per kg of body mass.
  auto moment_of = [&](const SwingLanes& s, const Wide(&acceleration)[2]) {
    Wide t_s, t_c, s_s, s_c;
    sin_cos(s.q[0], t_s, t_c);
    sin_cos(s.q[1], s_s, s_c);
    const Wide thigh = m.moment, shank = m.shank_moment;
    return Turning{fma(thigh, t_s, shank * s_s), fma(thigh * t_c, s.rate[0], shank * s_c * s.rate[1]),
                   thigh * (t_c * acceleration[0] - t_s * s.rate[0] * s.rate[0]) +
                       shank * (s_c * acceleration[1] - s_s * s.rate[1] * s.rate[1])};
  };
  const Wide first[2] = {task.first_acceleration[0], task.first_acceleration[0] - task.first_acceleration[1]};
  const Wide still[2] = {zero, zero};
  const Turning moment_off = moment_of(a, first);
  Turning moment_last = moment_of(b, still);
  moment_last.acceleration = zero;
  for (std::size_t i = 0; i <= swing_steps; ++i) {
    const float u = static_cast<float>(i) / swing_steps, straight = (u - bent_part) / (1.0F - bent_part);
    const Wide asked = u < bent_part ? least_jerk(wide(u / bent_part), bending, knee_off, knee_bent).value
                                     : least_jerk(wide(straight), stretching, knee_bent, knee_last).value;
    // It does not bend backward: rounded with continuous curvature.
    constexpr float round = 8.0F * degree_f;
    const Wide near = max(1.0F - abs(asked) / round, 0.0F);
    const Wide knee = max(asked, 0.0F) + near * near * near * (round / 6.0F);
    const Wide ahead = least_jerk(wide(u), task.span, moment_off, moment_last).value;
    Wide k_s, k_c;
    sin_cos(knee, k_s, k_c);
    const Wide level = fma(m.shank_moment, k_c, m.moment), aside = m.shank_moment * k_s;
    const Wide sine = clamp(ahead / sqrt(fma(level, level, aside * aside)), -0.95F, 0.95F);
    SwingLanes& s = path[i];
    s.q[0] = atan2(sine, sqrt(1.0F - sine * sine)) + atan2(aside, level);
    s.q[1] = s.q[0] - knee;
  }
  const Wide interval = task.span / static_cast<float>(swing_steps);
  Wide greatest = zero;
  for (std::size_t i = 1; i < swing_steps; ++i) {
    Wide acceleration[2];
    for (std::size_t k = 0; k < 2; ++k) {
      const Wide &before = path[i - 1].q[k], &after = path[i + 1].q[k];
      path[i].rate[k] = (after - before) / (2.0F * interval);
      acceleration[k] = (after - 2.0F * path[i].q[k] + before) / (interval * interval);
    }
    const SwingTorques torques = swing_torques(m, path[i], acceleration, task.hip_forward[i], task.hip_up[i]);
    greatest = max(greatest, max(abs(torques.hip), abs(torques.knee)));
  }
  return greatest > most_torque;
}

}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
