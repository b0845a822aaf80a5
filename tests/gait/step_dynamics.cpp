#include "tests/gait/step_dynamics.h"

#include "tests/gait/step_math.h"

namespace mobil::step {

std::array<double, 3> support_acceleration(const SupportModel& m, const SupportState& state,
                                           const std::array<double, 3>& force) {
  const auto [length, leg, trunk] = state.q;
  const auto [length_rate, leg_rate, trunk_rate] = state.rate;
  const SinCos d = sin_cos(leg - trunk), l = sin_cos(leg), u = sin_cos(trunk);
  const double mass = m.leg_mass * m.leg_centre * m.leg_centre + m.hip_mass + m.trunk_mass;
  const double weight = (m.leg_mass * m.leg_centre + m.hip_mass + m.trunk_mass) * gravity;
  const double coupling = m.trunk_mass * m.trunk_centre;
  // The symmetric mass matrix is diagonal except for its last row and column, which are eliminated.
  const double a1 = mass, a2 = mass * length * length + m.leg_inertia;
  const double a3 = coupling * m.trunk_centre + m.trunk_inertia;
  const double c1 = coupling * d.sine, c2 = coupling * length * d.cosine;
  const double b1 = force[0] + coupling * d.cosine * trunk_rate * trunk_rate + mass * length * leg_rate * leg_rate -
                    weight * l.cosine;
  const double b2 = force[1] - coupling * length * d.sine * trunk_rate * trunk_rate -
                    2.0 * mass * length * length_rate * leg_rate + weight * length * l.sine;
  const double b3 = force[2] -
                    coupling * (2.0 * length_rate * leg_rate * d.cosine - length * leg_rate * leg_rate * d.sine) +
                    coupling * gravity * u.sine;
  const double x3 = (b3 - c1 * b1 / a1 - c2 * b2 / a2) / (a3 - c1 * c1 / a1 - c2 * c2 / a2);
  return {(b1 - c1 * x3) / a1, (b2 - c2 * x3) / a2, x3};
}

std::array<double, 2> swing_acceleration(const SwingModel& m, const SwingState& state,
                                         const std::array<double, 2>& force, const std::array<double, 2>& hip) {
  const auto [thigh, shank] = state.q;
  const auto [thigh_rate, shank_rate] = state.rate;
  const SinCos d = sin_cos(thigh - shank), t = sin_cos(thigh), s = sin_cos(shank);
  const double moment = m.thigh_mass * m.thigh_centre + m.shank_mass * m.thigh_length;
  const double coupling = m.shank_mass * m.thigh_length * m.shank_centre;
  const double a11 =
      m.thigh_inertia + m.thigh_mass * m.thigh_centre * m.thigh_centre + m.shank_mass * m.thigh_length * m.thigh_length;
  const double a22 = m.shank_inertia + m.shank_mass * m.shank_centre * m.shank_centre;
  const double a12 = coupling * d.cosine;
  const double b1 = force[0] - coupling * d.sine * shank_rate * shank_rate -
                    moment * (hip[0] * t.cosine + (hip[1] + gravity) * t.sine);
  const double b2 = force[1] + coupling * d.sine * thigh_rate * thigh_rate -
                    m.shank_mass * m.shank_centre * (hip[0] * s.cosine + (hip[1] + gravity) * s.sine);
  const double determinant = a11 * a22 - a12 * a12;
  return {(a22 * b1 - a12 * b2) / determinant, (a11 * b2 - a12 * b1) / determinant};
}

}  // namespace mobil::step
