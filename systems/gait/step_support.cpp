#include "systems/gait/step_support.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "systems/gait/step_math.h"

namespace mobil::step {
namespace {

constexpr int integration_steps = 96;
/// The hip is lowest just after heel strike and highest half a step later.
constexpr double lowest_phase = 1.0 / 12.0;
/// The leg's turning moment acts in the first fifth of the cycle.
constexpr double turning_part = 0.4;  // of the step
constexpr int lowest_sample = 8, highest_sample = 56;

/// What is sought: the leg's and trunk's rates and the trunk's angle at heel strike, the moment that turns the leg, and
/// how the leg's neutral length moves: half the hip's rise and fall, the part of it a quarter wave later, the preload.
struct Unknown {
  double leg_rate, length_rate, leg_moment, push_off, delay, preload, trunk, trunk_rate;
};

/// What the forces know of the time alone, at every half step of the integration.
struct Schedule {
  SinCos wave;  // of the hip's rise and fall
  double turn;  // of the leg's turning moment
};

struct Problem {
  const SupportRequest& request;
  double length0, leg0;  // ω(0) and φ: θ₁ runs from −φ to φ
  double weight;
  std::array<Schedule, 2 * integration_steps + 1> schedule;

  /// From numbers of order one.
  Unknown unknown(const std::array<double, 8>& x) const {
    const double speed = request.step_length_m / request.duration_s;
    return {x[0] * speed / length0,
            x[1] * speed,
            x[2] * weight * length0 * 0.1,
            x[3] * length0 * 0.05,
            x[4] * length0 * 0.05,
            x[5] * length0,
            x[6] * 0.1,
            x[7] * 0.1 * speed / length0};
  }

  std::array<double, 3> force(const Unknown& u, double t, const SupportState& s) const {
    const double duration = request.duration_s;
    const auto [wave, turn] = schedule[static_cast<std::size_t>(t / duration * (2 * integration_steps) + 0.5)];
    const double forward = request.step_length_m * (t / duration - 0.5);
    const double up =
        0.5 * (request.mid_height_m + request.strike_height_m) - u.push_off * wave.cosine - u.delay * wave.sine;
    const double length = std::sqrt(forward * forward + up * up);
    const double length_rate = (forward * request.step_length_m / duration +
                                up * (u.push_off * wave.sine - u.delay * wave.cosine) * 2.0 * pi / duration) /
                               length;
    const double hip_torque = -request.trunk_stiffness_nm * (s.q[2] - request.trunk_lean_rad) -
                              request.trunk_damping_nm_s * s.rate[2] -
                              request.model.trunk_mass * request.model.trunk_centre * gravity * request.trunk_lean_rad;
    return {request.stiffness_n_per_m * (length + u.preload - s.q[0]) +
                request.damping_n_s_per_m * (length_rate - s.rate[0]),
            u.leg_moment * turn - hip_torque - request.roll_over * weight * s.q[0] * sin_cos(s.q[1]).sine, hip_torque};
  }

  SupportState start(const Unknown& u) const {
    return {{length0, -leg0, u.trunk}, {u.length_rate, u.leg_rate, u.trunk_rate}};
  }

  template <class Visit>
  SupportState run(const Unknown& u, Visit visit) const {
    const double h = request.duration_s / integration_steps;
    SupportState s = start(u);
    auto acceleration = [&](double t, const SupportState& at) {
      return support_acceleration(request.model, at, force(u, t, at));
    };
    for (int i = 0; i < integration_steps; ++i) {
      visit(i, s, acceleration(i * h, s));
      s = runge_kutta(s, i * h, h, acceleration);
    }
    visit(integration_steps, s, acceleration(request.duration_s, s));
    return s;
  }
};

std::array<double, 2> hip_velocity(const SupportState& s) {
  const SinCos a = sin_cos(s.q[1]);
  return {s.rate[0] * a.sine + s.q[0] * s.rate[1] * a.cosine, s.rate[0] * a.cosine - s.q[0] * s.rate[1] * a.sine};
}

}  // namespace

Result<SupportStep> solve_support(const SupportRequest& request) {
  const double half = 0.5 * request.step_length_m;
  Problem problem{request,
                  std::sqrt(half * half + request.strike_height_m * request.strike_height_m),
                  arc_tangent(half, request.strike_height_m),
                  gravity * (request.model.leg_mass + request.model.hip_mass + request.model.trunk_mass),
                  {}};
  for (std::size_t i = 0; i < problem.schedule.size(); ++i) {
    const double u = static_cast<double>(i) / (2 * integration_steps);
    problem.schedule[i] = {sin_cos(2.0 * pi * (u - lowest_phase)),
                           u < turning_part ? 0.5 * (1.0 - sin_cos(2.0 * pi * u / turning_part).cosine) : 0.0};
  }
  const double speed = request.step_length_m / request.duration_s;
  auto residual = [&](const std::array<double, 8>& x) {
    const Unknown u = problem.unknown(x);
    double highest = 0.0, falling = 0.0;
    const SupportState end = problem.run(u, [&](int i, const SupportState& s, const std::array<double, 3>&) {
      if (i == lowest_sample) falling = hip_velocity(s)[1];
      if (i == highest_sample) highest = s.q[0] * sin_cos(s.q[1]).cosine;
    });
    const auto v0 = hip_velocity(problem.start(u)), v1 = hip_velocity(end);
    return std::array<double, 8>{(end.q[1] - problem.leg0) * 10.0,
                                 (end.q[0] - problem.length0) / problem.length0 * 10.0,
                                 (v1[0] - v0[0]) / speed,
                                 (v1[1] - v0[1]) / speed,
                                 (highest - request.mid_height_m) / problem.length0 * 10.0,
                                 falling / speed,
                                 (end.q[2] - u.trunk) * 10.0,
                                 (end.rate[2] - u.trunk_rate) * problem.length0 / speed};
  };
  std::array<double, 8> x = {1.0, -0.4, 0.0, 0.4, 0.0, 0.05, request.trunk_lean_rad / 0.1, 0.0};
  if (!shoot(residual, x, 1e-9)) {
    return fail(fmt::format(
        "gait: no periodic step of {:.2f} m in {:.2f} s was found for {:.1f} kg at hip height {:.2f} m; choose a speed "
        "and step length nearer to a natural walk (1.4 m/s and 0.43 body heights)",
        request.step_length_m, request.duration_s, problem.weight / gravity, request.strike_height_m));
  }
  const Unknown u = problem.unknown(x);
  SupportStep step;
  step.first = problem.start(u);
  step.sample.reserve(integration_steps + 1);
  step.last = problem.run(u, [&](int, const SupportState& s, const std::array<double, 3>& a) {
    const SinCos c = sin_cos(s.q[1]);
    const auto v = hip_velocity(s);
    const double radial = a[0] - s.q[0] * s.rate[1] * s.rate[1];
    const double turning = s.q[0] * a[1] + 2.0 * s.rate[0] * s.rate[1];
    step.sample.push_back({s.q[0] * c.sine, s.q[0] * c.cosine, v[0], v[1], radial * c.sine + turning * c.cosine,
                           radial * c.cosine - turning * c.sine, s.q[2], s.rate[2]});
  });
  return step;
}

}  // namespace mobil::step
