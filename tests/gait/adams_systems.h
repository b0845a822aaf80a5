#pragma once
// Test systems for the integrator, and their independent solution by Boost.Odeint.

#include <array>
#include <boost/numeric/odeint.hpp>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <stdexcept>

#include "tests/gait/adams.h"
#include "tests/gait/step_dynamics.h"

namespace mobil::step {

inline constexpr double g = 9.81;

/// Test systems: a derivative, a start, an end.
struct Oscillator {
  static constexpr std::size_t size = 2;
  Unknowns<2> start{1.0, 0.5};
  double end = 3.0;
  Unknowns<2> operator()(double, const Unknowns<2>& y) const { return {y[1], -4.0 * y[0]}; }
};

struct Pendulum {
  static constexpr std::size_t size = 2;
  Unknowns<2> start{0.5, 3.0};
  double end = 3.0;
  Unknowns<2> operator()(double, const Unknowns<2>& y) const { return {y[1], -g * std::sin(y[0])}; }
};

/// The support leg and trunk of 80 kg, y = [ω, θ₁, θ₂ and their rates], with a spring and damper along the leg, a
/// smooth torque that turns it, and a spring and damper on the trunk. At strength 0 no force acts.
struct Support {
  static constexpr std::size_t size = 6;
  Unknowns<6> start{0.95, -0.35, 0.05, -0.3, 1.5, -0.2};
  double end = 0.5, strength = 1.0;
  SupportModel model{12.0, 0.55, 0.9, 14.0, 54.0, 0.35, 2.5};
  Unknowns<6> operator()(double t, const Unknowns<6>& y) const {
    const double push = 0.5 * (1.0 - std::cos(2.0 * std::numbers::pi * t / end));
    const double hold = -600.0 * (y[2] - 0.05) - 60.0 * y[5];
    const auto a = support_acceleration(
        model, {{y[0], y[1], y[2]}, {y[3], y[4], y[5]}},
        {strength * (15000.0 * (0.98 - y[0]) - 500.0 * y[3]), strength * (40.0 * push - hold), strength * hold});
    return {y[3], y[4], y[5], a[0], a[1], a[2]};
  }
  double energy(const Unknowns<6>& y) const {
    const SupportModel& m = model;
    const double mass = m.leg_mass * m.leg_centre * m.leg_centre + m.hip_mass + m.trunk_mass;
    const double moment = m.trunk_mass * m.trunk_centre, d = y[1] - y[2];
    return 0.5 * mass * (y[3] * y[3] + y[0] * y[0] * y[4] * y[4]) + 0.5 * m.leg_inertia * y[4] * y[4] +
           moment * y[5] * (y[3] * std::sin(d) + y[0] * y[4] * std::cos(d)) +
           0.5 * (moment * m.trunk_centre + m.trunk_inertia) * y[5] * y[5] +
           (m.leg_mass * m.leg_centre + m.hip_mass + m.trunk_mass) * g * y[0] * std::cos(y[1]) +
           moment * g * std::cos(y[2]);
  }
};

/// The swing leg on a moving hip, y = [θ₃, θ₄ and their rates]. At strength 0 no force acts and the hip is fixed.
struct Swing {
  static constexpr std::size_t size = 4;
  Unknowns<4> start{-0.3, -0.9, 2.0, -3.0};
  double end = 0.5, strength = 1.0;
  SwingModel model{8.0, 0.44, 0.19, 0.16, 4.9, 0.26, 0.15};
  Unknowns<4> operator()(double t, const Unknowns<4>& y) const {
    const double wave = std::sin(2.0 * std::numbers::pi * t / end);
    const double hip = 30.0 * wave, knee = -8.0 * wave + 2.0 * (y[2] - y[3]);
    const auto a = swing_acceleration(model, {{y[0], y[1]}, {y[2], y[3]}}, {strength * (hip - knee), strength * knee},
                                      {strength * 2.0 * wave, strength * 1.5 * wave});
    return {y[2], y[3], a[0], a[1]};
  }
  double energy(const Unknowns<4>& y) const {
    const SwingModel& m = model;
    return 0.5 *
               (m.thigh_inertia + m.thigh_mass * m.thigh_centre * m.thigh_centre +
                m.shank_mass * m.thigh_length * m.thigh_length) *
               y[2] * y[2] +
           0.5 * (m.shank_inertia + m.shank_mass * m.shank_centre * m.shank_centre) * y[3] * y[3] +
           m.shank_mass * m.thigh_length * m.shank_centre * y[2] * y[3] * std::cos(y[0] - y[1]) -
           (m.thigh_mass * m.thigh_centre + m.shank_mass * m.thigh_length) * g * std::cos(y[0]) -
           m.shank_mass * g * m.shank_centre * std::cos(y[1]);
  }
};

inline constexpr int samples = 9;
template <std::size_t N>
using Path = std::array<Unknowns<N>, samples>;

/// Returns an independent solution at equal times: Dormand and Prince's fifth order to 1e-13.
template <class System, std::size_t N = System::size>
Path<N> reference(const System& system) {
  namespace odeint = boost::numeric::odeint;
  Path<N> path;
  Unknowns<N> y = system.start;
  std::size_t i = 0;
  odeint::integrate_const(
      odeint::make_controlled(1e-13, 1e-13, odeint::runge_kutta_dopri5<Unknowns<N>>()),
      [&](const Unknowns<N>& at, Unknowns<N>& f, double t) { f = system(t, at); }, y, 0.0, system.end * (1.0 + 1e-12),
      system.end / (samples - 1), [&](const Unknowns<N>& at, double) { path.at(i++) = at; });
  if (i != path.size()) throw std::logic_error("reference: not all samples were taken");
  return path;
}

template <std::size_t N>
double distance(const Unknowns<N>& a, const Unknowns<N>& b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < N; ++i) worst = std::fmax(worst, std::fabs(a[i] - b[i]));
  return worst;
}

template <std::size_t N>
double distance(const Path<N>& a, const Path<N>& b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) worst = std::fmax(worst, distance(a[i], b[i]));
  return worst;
}

}  // namespace mobil::step
