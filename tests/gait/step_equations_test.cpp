// What solves a step in sixteen lanes of single precision, against the same models in double precision: the support
// integrated by the Adams methods under the force law of run_support (systems/gait/support-inl.h), the swing put back
// into its equations of motion.
#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <cmath>

#include "systems/gait/step_math.h"
#include "systems/gait/support-inl.h"
#include "systems/gait/swing-inl.h"
#include "tests/gait/adams.h"
#include "tests/gait/step_dynamics.h"
#include "tests/gait/walkers.h"

namespace mobil::step_equations_test {
namespace wide_step = HWY_NAMESPACE;  // the compiler's own instruction set
using wide_step::Wide;

constexpr double pi = step::pi;
constexpr std::size_t knots = wide_step::support_steps + 1;

/// The same sizes as support_masses and swing_masses, from Winter's fractions.
step::SupportModel support_model(double height, double mass) {
  const double trunk = 0.288 * height, leg = (fraction::thigh + fraction::shank) * height;
  return {.leg_mass = 0.161 * mass,
          .leg_centre = 0.553,
          .leg_inertia = 0.161 * mass * std::pow(0.326 * leg, 2),
          .hip_mass = 0.161 * mass,
          .trunk_mass = 0.678 * mass,
          .trunk_centre = 0.626 * trunk,
          .trunk_inertia = 0.678 * mass * std::pow(0.496 * trunk, 2)};
}

step::SwingModel swing_model(double height) {
  const double thigh = fraction::thigh * height, shank = fraction::shank * height;
  return {0.100,
          thigh,
          0.433 * thigh,
          0.100 * std::pow(0.323 * thigh, 2),
          0.061,
          0.606 * shank,
          0.061 * std::pow(0.416 * shank, 2)};
}

double ease(double u) {
  const double v = std::fmin(std::fmax(u, 0.0), 1.0);
  return v * v * (3.0 - 2.0 * v);
}

double hermite(double u, double a, double a_slope, double b, double b_slope) {
  const double v = 1.0 - u;
  return v * v * ((1.0 + 2.0 * u) * a + u * a_slope) + u * u * ((1.0 + 2.0 * v) * b - v * b_slope);
}

/// One walker's step over the support leg, everything that run_support reads, as functions of time.
struct Support {
  double height, mass, duration;
  double stiffness, damping, lean, trunk_stiffness, trunk_damping, trunk_hold, lever, scale;
  std::array<double, 2> unknown{};
  step::Unknowns<6> first;  // ω, θ₁, θ₂ and rates
  // The hips' wave: mean and amplitude at both ends, rates of the phase over the part of the step.
  double mean[2], wave[2], phase_rate[2];
  double behind, load_from, load_to, double_support;
  double swing[2];  // greatest level force of the other leg on the hips, N, and moment of its weight, N m

  double up(double t) const {
    const double u = t / duration, e = ease(u);
    const double phase = hermite(u, 0.0, phase_rate[0], 1.0, phase_rate[1]);
    return mean[0] + (mean[1] - mean[0]) * e -
           (wave[0] + (wave[1] - wave[0]) * e) * std::cos(2.0 * pi * (phase - 1.0 / 12.0));
  }
  double up_rate(double t) const { return (up(t + 1e-5) - up(t - 1e-5)) / 2e-5; }
  double up_acceleration(double t) const { return (up(t + 1e-4) - 2.0 * up(t) + up(t - 1e-4)) / 1e-8; }
  double weight(double t) const { return mass * (step::gravity + up_acceleration(t)); }
  double swing_force(double t) const { return -swing[0] * std::sin(2.0 * pi * t / duration); }
  double swing_weight(double t) const { return -swing[1] * std::cos(pi * t / duration); }
  double borne(double t) const {
    return behind * (1.0 - (load_from + (load_to - load_from) * ease(t / double_support)));
  }

  step::Unknowns<6> operator()(double t, const step::Unknowns<6>& y) const {
    const step::SupportModel m = support_model(height, mass);
    const double whole = m.leg_mass * m.leg_centre * m.leg_centre + m.hip_mass + m.trunk_mass;
    const double moment = m.leg_mass * m.leg_centre + m.hip_mass + m.trunk_mass;
    const double sine = std::sin(y[1]), cosine = std::cos(y[1]);
    const double forward = y[0] * sine, at_height = y[0] * cosine, rising = y[3] * cosine - forward * y[4];
    const double a = t / duration / 0.4;
    const double pulse = a < 1.0 ? 16.0 * a * a * (1.0 - a) * (1.0 - a) : 0.0;
    const double trunk = -trunk_hold - trunk_stiffness * (y[2] - lean) - trunk_damping * y[5];
    const double leg = scale * (unknown[0] * pulse + unknown[1]) - trunk -
                       weight(t) * (forward - lever * (forward - borne(t))) + swing_force(t) * at_height +
                       swing_weight(t);
    const double lift = whole * up_acceleration(t) + moment * step::gravity + stiffness * (up(t) - at_height) +
                        damping * (up_rate(t) - rising);
    const auto q = step::support_acceleration(m, {{y[0], y[1], y[2]}, {y[3], y[4], y[5]}},
                                              {(lift + leg * sine / y[0]) / cosine, leg, trunk});
    return {y[3], y[4], y[5], q[0], q[1], q[2]};
  }
};

/// The hips and the trunk at the knots.
struct Path {
  std::array<double, knots> forward, up, trunk;
  double end_velocity;
};

Path exact(const Support& s) {
  Path path;
  step::AdamsOptions<6> options;
  options.absolute = step::alike<6>(1e-9);
  const double kink[2] = {0.4 * s.duration, s.double_support};
  options.breaks_s = kink;
  const auto end = step::integrate_adams<6>(
      s, s.first, 0.0, s.duration, options,
      step::at_equal_times<6>(0.0, s.duration, static_cast<int>(knots), [&](int i, double, const step::Unknowns<6>& y) {
        const auto k = static_cast<std::size_t>(i);
        path.forward[k] = y[0] * std::sin(y[1]);
        path.up[k] = y[0] * std::cos(y[1]);
        path.trunk[k] = y[2];
      }));
  if (!end) throw std::runtime_error(end.error().message);
  const auto& y = end->state;
  path.end_velocity = y[3] * std::sin(y[1]) + y[0] * std::cos(y[1]) * y[4];
  return path;
}

/// The start of a run: the hips at a place with a velocity, the trunk at an angle, at rest.
step::Unknowns<6> start_of(double x, double y, double vx, double vy, double trunk) {
  const double l = std::sqrt(x * x + y * y);
  return {l, std::atan2(x, y), trunk, (x * vx + y * vy) / l, (y * vx - x * vy) / (l * l), 0.0};
}

/// A natural step of a random walker under moments of some size.
Support random_support(Dice& dice) {
  Support s{};
  s.height = dice(1.2, 2.2);
  s.mass = dice(18, 35) * s.height * s.height;
  s.duration = dice(0.42, 0.65) * std::sqrt(s.height / 1.8);
  s.stiffness = dice(8000, 30000) * s.height / 1.8;
  s.damping = 2.0 * dice(0.2, 0.8) * std::sqrt(s.stiffness * s.mass);
  const step::SupportModel m = support_model(s.height, s.mass);
  const double topple = m.trunk_mass * m.trunk_centre * step::gravity;
  s.lean = dice(-0.05, 0.15);
  s.trunk_stiffness = dice(4, 12) * topple;
  s.trunk_damping = std::sqrt(s.trunk_stiffness * (m.trunk_inertia + m.trunk_mass * m.trunk_centre * m.trunk_centre));
  s.trunk_hold = topple * s.lean;
  s.lever = 1.0 - dice(0.2, 0.7);
  const double leg = 0.53 * s.height, length = dice(0.30, 0.44) * s.height;
  s.scale = 0.3 * s.mass * step::gravity * leg;
  s.unknown = {dice(-0.3, 0.3), dice(-0.15, 0.15)};
  for (std::size_t i = 0; i < 2; ++i) {
    s.wave[i] = dice(0.007, 0.013) * s.height;
    s.mean[i] = leg - s.wave[i];
    s.phase_rate[i] = dice(0.9, 1.1);
  }
  s.behind = -length;
  s.load_to = 1.0;
  s.double_support = dice(0.15, 0.3) * s.duration;
  s.swing[0] = dice(0.02, 0.06) * s.mass * step::gravity;
  s.swing[1] = 0.161 * s.mass * step::gravity * 0.2 * length;
  s.first = start_of(-0.5 * length, s.up(0), length / s.duration, s.up_rate(0), s.lean);
  return s;
}

/// Sixteen of them as a task of the wide functions.
wide_step::SupportTask task_of(const std::array<Support, lane_count>& support, Wide (&unknown)[2]) {
  auto lanes = [&](auto value) {
    Lanes<float> l;
    for (std::size_t i = 0; i < lane_count; ++i) l[i] = static_cast<float>(value(support[i]));
    return wide_step::load(l);
  };
  wide_step::SupportTask task;
  task.mass = wide_step::support_masses(lanes([](auto& s) { return s.height; }), lanes([](auto& s) { return s.mass; }));
  task.duration = lanes([](auto& s) { return s.duration; });
  task.stiffness = lanes([](auto& s) { return s.stiffness; });
  task.damping = lanes([](auto& s) { return s.damping; });
  task.lean = lanes([](auto& s) { return s.lean; });
  task.trunk_stiffness = lanes([](auto& s) { return s.trunk_stiffness; });
  task.trunk_damping = lanes([](auto& s) { return s.trunk_damping; });
  task.trunk_hold = lanes([](auto& s) { return s.trunk_hold; });
  task.lever = lanes([](auto& s) { return s.lever; });
  task.scale = lanes([](auto& s) { return s.scale; });
  for (std::size_t i = 0; i < 3; ++i) {
    task.first.q[i] = lanes([i](auto& s) { return s.first[i]; });
    task.first.rate[i] = lanes([i](auto& s) { return s.first[3 + i]; });
  }
  for (std::size_t i = 0; i < 2; ++i) {
    unknown[i] = lanes([i](auto& s) { return s.unknown[i]; });
    task.guess[i] = wide_step::wide(0.0F);
  }
  for (std::size_t i = 0; i <= wide_step::support_halves; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(wide_step::support_halves);
    task.guide.up[i] = lanes([part](auto& s) { return s.up(part * s.duration); });
    task.guide.up_rate[i] = lanes([part](auto& s) { return s.up_rate(part * s.duration); });
    task.guide.up_acceleration[i] = lanes([part](auto& s) { return s.up_acceleration(part * s.duration); });
    task.guide.weight[i] = lanes([part](auto& s) { return s.weight(part * s.duration); });
    task.guide.behind[i] = lanes([part](auto& s) { return s.borne(part * s.duration); });
    task.guide.swing_force[i] = lanes([part](auto& s) { return s.swing_force(part * s.duration); });
    task.guide.swing_weight[i] = lanes([part](auto& s) { return s.swing_weight(part * s.duration); });
  }
  return task;
}

float lane_of(const Wide& w, std::size_t l) {
  Lanes<float> lanes;
  wide_step::store(w, lanes);
  return lanes[l];
}

/// The greatest distance between a path and the exact one.
struct Off {
  double hips_mm = 0, trunk = 0, velocity = 0;
  void compare(const Path& truth, const wide_step::SupportPath& path, std::size_t l) {
    for (std::size_t k = 0; k < knots; ++k) {
      const double x = lane_of(path.forward[k], l) - truth.forward[k], y = lane_of(path.up[k], l) - truth.up[k];
      hips_mm = std::fmax(hips_mm, 1000.0 * std::sqrt(x * x + y * y));
      trunk = std::fmax(trunk, std::fabs(lane_of(path.trunk[k], l) - truth.trunk[k]));
    }
    velocity = std::fmax(velocity, std::fabs(lane_of(path.forward_velocity[knots - 1], l) - truth.end_velocity));
  }
};

TEST(SupportEquations, SixteenLanesFollowTheExactPathOfTheHips) {
  Dice dice{std::mt19937(1)};
  Off off;
  for (int block = 0; block < 12; ++block) {
    std::array<Support, lane_count> support;
    for (Support& s : support) s = random_support(dice);
    Wide unknown[2], end[2];
    const wide_step::SupportTask task = task_of(support, unknown);
    wide_step::SupportPath path;
    wide_step::run_support(task, unknown, &path, end);
    for (std::size_t l = 0; l < lane_count; ++l) {
      const Path truth = exact(support[l]);
      off.compare(truth, path, l);
      EXPECT_EQ(lane_of(end[0], l), lane_of(path.forward[knots - 1], l));
      EXPECT_EQ(lane_of(end[1], l), lane_of(path.forward_velocity[knots - 1], l));
    }
  }
  EXPECT_LT(off.hips_mm, 1.0);
  EXPECT_LT(off.trunk, 0.003);
  EXPECT_LT(off.velocity, 0.01);
}

TEST(SupportEquations, ShootingFindsTheMomentsThatBroughtTheHipsThere) {
  Dice dice{std::mt19937(2)};
  Off off;
  for (int block = 0; block < 12; ++block) {
    std::array<Support, lane_count> support;
    std::array<Path, lane_count> truth;
    Lanes<float> last[2];
    for (std::size_t l = 0; l < lane_count; ++l) {
      support[l] = random_support(dice);
      truth[l] = exact(support[l]);
      last[0][l] = static_cast<float>(truth[l].forward[knots - 1]);
      last[1][l] = static_cast<float>(truth[l].end_velocity);
    }
    Wide unknown[2];
    wide_step::SupportTask task = task_of(support, unknown);
    for (std::size_t i = 0; i < 2; ++i) task.last[i] = wide_step::load(last[i]);
    // Where height and trunk end is not asked for here: what a run with those moments gives.
    wide_step::SupportPath path;
    Wide end[2];
    wide_step::run_support(task, unknown, &path, end);
    const std::size_t n = knots - 1;
    const Wide ends[6] = {task.last[0],        task.last[1],  path.up[n],
                          path.up_velocity[n], path.trunk[n], path.trunk_rate[n]};
    const auto held = wide_step::solve_support(task, ends, path);
    const Wide flag = wide_step::select(held, wide_step::wide(1.0F), wide_step::wide(0.0F));
    for (std::size_t l = 0; l < lane_count; ++l) {
      EXPECT_EQ(lane_of(flag, l), 0.0F);
      EXPECT_NEAR(lane_of(path.forward[n], l), truth[l].forward[n], 1e-6);
      EXPECT_NEAR(lane_of(path.forward_velocity[n], l), truth[l].end_velocity, 1e-5);
      off.compare(truth[l], path, l);
    }
  }
  EXPECT_LT(off.hips_mm, 1.5);
}

TEST(SwingEquations, TorquesPutIntoTheEquationsGiveBackTheAccelerations) {
  Dice dice{std::mt19937(4)};
  for (int block = 0; block < 100; ++block) {
    Lanes<float> height, angle[2], rate[2], acceleration[2], hip[2], torque[2];
    for (std::size_t l = 0; l < lane_count; ++l) {
      height[l] = dice.single(1.2, 2.2);
      angle[0][l] = dice.single(-0.6, 0.8);
      angle[1][l] = angle[0][l] - dice.single(0, 1.4);
      for (std::size_t i = 0; i < 2; ++i) {
        rate[i][l] = dice.single(-7, 7);
        acceleration[i][l] = dice.single(-80, 80);
        hip[i][l] = dice.single(-4, 4);
      }
    }
    const wide_step::LegSize leg = wide_step::leg_size(wide_step::load(height));
    const wide_step::SwingLanes state = {{wide_step::load(angle[0]), wide_step::load(angle[1])},
                                         {wide_step::load(rate[0]), wide_step::load(rate[1])}};
    const Wide wanted[2] = {wide_step::load(acceleration[0]), wide_step::load(acceleration[1])};
    const auto torques = wide_step::swing_torques(wide_step::swing_masses(leg), state, wanted, wide_step::load(hip[0]),
                                                  wide_step::load(hip[1]));
    wide_step::store(torques.hip, torque[0]);
    wide_step::store(torques.knee, torque[1]);
    for (std::size_t l = 0; l < lane_count; ++l) {
      const auto found =
          step::swing_acceleration(swing_model(height[l]), {{angle[0][l], angle[1][l]}, {rate[0][l], rate[1][l]}},
                                   {double{torque[0][l]} - double{torque[1][l]}, torque[1][l]}, {hip[0][l], hip[1][l]});
      for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(found[i], acceleration[i][l], 1e-3);
    }
  }
}

TEST(SwingEquations, TheSwingMeetsItsEndsAndBendsTheKneeAsMuchAsAsked) {
  constexpr std::size_t n = wide_step::swing_steps;
  constexpr double span = 0.4, interval = span / static_cast<double>(n);
  Dice dice{std::mt19937(5)};
  for (int block = 0; block < 20; ++block) {
    // Thigh, shank and their rates at both ends.
    Lanes<float> first[4], last[4], bent;
    for (std::size_t l = 0; l < lane_count; ++l) {
      first[0][l] = dice.single(-0.3, 0.0);
      first[1][l] = first[0][l] - dice.single(0.5, 0.7);
      first[2][l] = dice.single(1, 3);
      first[3][l] = first[2][l] - dice.single(3, 6);
      last[0][l] = dice.single(0.3, 0.5);
      last[1][l] = last[0][l] - dice.single(0.05, 0.2);
      last[2][l] = dice.single(-1, 0);
      last[3][l] = dice.single(-1, 1);
      bent[l] = dice.single(0.9, 1.2);
    }
    using wide_step::load, wide_step::wide;
    wide_step::SwingTask task;
    task.mass = wide_step::swing_masses(wide_step::leg_size(wide(1.8F)));
    task.span = wide(static_cast<float>(span));
    task.first = {{load(first[0]), load(first[1])}, {load(first[2]), load(first[3])}};
    task.last = {{load(last[0]), load(last[1])}, {load(last[2]), load(last[3])}};
    task.first_acceleration[0] = task.first_acceleration[1] = wide(0.0F);
    task.bent = load(bent);
    for (std::size_t i = 0; i <= n; ++i) task.hip_forward[i] = task.hip_up[i] = wide(0.0F);
    wide_step::SwingLanes path[n + 1];
    wide_step::solve_swing(task, path);
    for (std::size_t l = 0; l < lane_count; ++l) {
      auto q = [&](std::size_t at_step, std::size_t i) { return double{lane_of(path[at_step].q[i], l)}; };
      double most = 0;
      for (std::size_t i = 0; i <= n; ++i) {
        const double knee = q(i, 0) - q(i, 1);
        EXPECT_GT(knee, 0.0);
        most = std::fmax(most, knee);
      }
      EXPECT_NEAR(most, bent[l], 0.03);
      for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_NEAR(q(0, i), first[i][l], 1e-5);
        EXPECT_NEAR(q(n, i), last[i][l], 1e-2);  // a knee that is all but straight is rounded
        // One-sided differences of second order.
        EXPECT_NEAR((-3 * q(0, i) + 4 * q(1, i) - q(2, i)) / (2 * interval), first[2 + i][l], 0.6);
        EXPECT_NEAR((3 * q(n, i) - 4 * q(n - 1, i) + q(n - 2, i)) / (2 * interval), last[2 + i][l], 0.6);
      }
    }
  }
}

TEST(Elimination, SolvesEachLanesOwnEquations) {
  Dice dice{std::mt19937(6)};
  for (int block = 0; block < 100; ++block) {
    Lanes<float> a[3][3], b[3];
    wide_step::Elimination<3> elimination;
    Wide x[3];
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t l = 0; l < lane_count; ++l) {
        // Pivots that vanish now and then, so that rows must change places, in some lanes and not in others.
        for (std::size_t j = 0; j < 3; ++j) a[i][j][l] = i == j && dice(0, 1) < 0.3 ? 0.0F : dice.single(-1, 1);
        b[i][l] = dice.single(-1, 1);
      }
      for (std::size_t j = 0; j < 3; ++j) elimination.a[i][j] = wide_step::load(a[i][j]);
      x[i] = wide_step::load(b[i]);
    }
    elimination.factor();
    elimination.solve(x);
    for (std::size_t l = 0; l < lane_count; ++l) {
      double size = 1;
      for (const Wide& value : x) size = std::fmax(size, std::fabs(lane_of(value, l)));
      for (std::size_t i = 0; i < 3; ++i) {
        double sum = 0;
        for (std::size_t j = 0; j < 3; ++j) sum += double{a[i][j][l]} * lane_of(x[j], l);
        EXPECT_NEAR(sum, b[i][l], 1e-5 * size) << "lane " << l;
      }
    }
  }
}

}  // namespace mobil::step_equations_test
