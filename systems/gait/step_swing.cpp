#include "systems/gait/step_swing.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "systems/gait/step_math.h"

namespace mobil::step {
namespace {

constexpr int integration_steps = 96;
/// When the knee is bent most.
constexpr int bent_sample = 30;
/// How fast the leg goes back over the foothold as the heel strikes, of what would stop the foot over the ground.
constexpr double landing = 0.5;
/// How high the foot is to be a tenth of the swing after toe-off, m.
constexpr double early_clearance = 0.020;
/// Passive knee, in units of the shank's inertia and the swing's pace.
constexpr double passive_spring = 1.0, passive_damper = 0.4;

/// Angles of the leg standing at time t, and their rates by central difference: its path is smooth there.
SwingState standing(const Leg& leg, double t) {
  const double h = 1e-4 * leg.duration;
  auto at = [&](double when) { return leg.angles(leg.hip(when), leg.stance(when).ankle); };
  const LegAngles before = at(t - h), now = at(t), after = at(t + h);
  return {{now.thigh, now.shank}, {(after.thigh - before.thigh) / (2.0 * h), (after.shank - before.shank) / (2.0 * h)}};
}

double pitch_rate(const Leg& leg, double t) {
  const double h = 1e-4 * leg.duration;
  return (leg.stance(t + h).pitch - leg.stance(t - h).pitch) / (2.0 * h);
}

/// A smooth push over [a, b] of the swing.
double push(double u, double a, double b) {
  if (u <= a || u >= b) return 0.0;
  return 0.5 * (1.0 - sin_cos(2.0 * pi * (u - a) / (b - a)).cosine);
}

/// Height of the lowest of heel, ball and toe tip over the ground, m.
double clearance(const Leg& leg, const SwingSample& s) {
  const SinCos p = sin_cos(s.pitch), t = sin_cos(s.pitch + s.toes);
  const double heel = s.ankle.up - leg.heel_back * p.sine - leg.ankle_height * p.cosine;
  const double joint = s.ankle.up + leg.ball_forward * p.sine - (leg.ankle_height - leg.toe_joint_height) * p.cosine;
  const double ball = joint - leg.toe_joint_height * t.cosine;
  const double tip = ball + leg.toes_length * t.sine;
  return std::fmin(heel, std::fmin(ball, tip));
}

}  // namespace

SwingModel swing_model(const Leg& leg, double body_mass_kg) {
  const double shank_mass = 0.061 * body_mass_kg, thigh_mass = 0.100 * body_mass_kg;  // shank with foot
  const double thigh_gyration = 0.323 * leg.thigh, shank_gyration = 0.416 * leg.shank;
  return {thigh_mass,
          leg.thigh,
          0.433 * leg.thigh,
          thigh_mass * thigh_gyration * thigh_gyration,
          shank_mass,
          0.606 * leg.shank,
          shank_mass * shank_gyration * shank_gyration};
}

Result<Swing> solve_swing(const Leg& leg, const SwingModel& model, const GaitStyle& style) {
  const double end = 2.0 * leg.duration, span = end - leg.toe_off, h = span / integration_steps;
  const SwingState first = standing(leg, leg.toe_off);
  SwingState target = standing(leg, 0.0);
  // The loaded leg folds faster than any swing could: heel strike is an impact. Before it the leg moves as one, back
  // against the body's advance.
  target.rate.fill(-landing * leg.step_length / (leg.duration * (leg.thigh + leg.shank)));
  const double weight = gravity * (model.thigh_mass + model.shank_mass);
  const double unit = weight * leg.thigh * 0.3;

  std::array<std::array<double, 2>, 2 * integration_steps + 1> hip;
  for (std::size_t i = 0; i < hip.size(); ++i)
    hip[i] = leg.hip_acceleration(leg.toe_off + 0.5 * h * static_cast<double>(i));

  std::array<std::array<double, 6>, 2 * integration_steps + 1> pushes;
  for (std::size_t i = 0; i < pushes.size(); ++i) {
    const double u = static_cast<double>(i) / (2 * integration_steps);
    pushes[i] = {push(u, 0.0, 0.6),  push(u, 0.4, 1.0),  // hip
                 push(u, 0.0, 0.25), push(u, 0.1, 0.5), push(u, 0.3, 0.8), push(u, 0.6, 1.0)};
  }

  // The knee's passive spring resists flexion beyond its rest angle, the damper both ways.
  const double inertia = model.shank_inertia + model.shank_mass * model.shank_centre * model.shank_centre;
  const double pace = 2.0 * pi / span;
  const double knee_spring = passive_spring * inertia * pace * pace, knee_damper = passive_damper * inertia * pace;
  const double knee_rest = style.swing_knee_deg * degree * 0.6;

  auto run = [&](const std::array<double, 6>& torque, auto visit) {
    SwingState s = first;
    auto acceleration = [&](double t, const SwingState& at) {
      const auto i = static_cast<std::size_t>(t / (0.5 * h) + 0.5);
      const std::array<double, 6>& p = pushes[i];
      const double flexion = at.q[0] - at.q[1], flexing = at.rate[0] - at.rate[1];
      const double passive = knee_spring * std::fmax(flexion - knee_rest, 0.0) + knee_damper * flexing;
      const double at_hip = unit * (torque[0] * p[0] + torque[1] * p[1]);
      const double at_knee =
          unit * (torque[2] * p[2] + torque[3] * p[3] + torque[4] * p[4] + torque[5] * p[5]) + passive;
      return swing_acceleration(model, at, {at_hip - at_knee, at_knee}, hip[i]);
    };
    for (int i = 0; i < integration_steps; ++i) {
      visit(i, s);
      s = runge_kutta(s, i * h, h, acceleration);
    }
    visit(integration_steps, s);
    return s;
  };
  std::array<double, 6> torque{};
  auto residual = [&](const std::array<double, 6>& x) {
    double bent = 0.0, bending = 0.0;
    const SwingState s = run(x, [&](int i, const SwingState& at) {
      if (i != bent_sample) return;
      bent = at.q[0] - at.q[1];
      bending = at.rate[0] - at.rate[1];
    });
    return std::array<double, 6>{s.q[0] - target.q[0],
                                 s.q[1] - target.q[1],
                                 (s.rate[0] - target.rate[0]) / pace,
                                 (s.rate[1] - target.rate[1]) / pace,
                                 bent - style.swing_knee_deg * degree,
                                 bending / pace};
  };
  if (!shoot(residual, torque, 1e-9))
    return fail(
        fmt::format("gait: no swing of {:.2f} s reaches the next foothold {:.2f} m ahead; choose a speed and "
                    "step length nearer to a natural walk (1.4 m/s and 0.43 body heights)",
                    span, 2.0 * leg.step_length));

  Swing swing;
  swing.target = target;
  const Foot off = leg.stance(leg.toe_off), strike = leg.planted(leg.strike_pitch);
  const double off_rate = pitch_rate(leg, leg.toe_off), strike_rate = pitch_rate(leg, 0.0);
  const double ankle_off = off.pitch - first.q[1], ankle_strike = strike.pitch - target.q[1];
  const double middle = 0.45, early_ankle = 0.20, late_ankle = 0.88, ankle_middle = style.swing_ankle_deg * degree;
  run(torque, [&](int i, const SwingState& s) {
    const double u = static_cast<double>(i) / integration_steps, t = leg.toe_off + i * h;
    const Point at = leg.hip(t);
    const SinCos a = sin_cos(s.q[0]), b = sin_cos(s.q[1]);
    const double down = leg.thigh * a.cosine + leg.shank * b.cosine;
    const double out = off.ankle.out + (strike.ankle.out - off.ankle.out) * smooth_step(u, 0.0, 1.0);
    SwingSample sample;
    sample.state = s;
    sample.ankle = {out, at.up - std::sqrt(std::fmax(down * down - (out - at.out) * (out - at.out), 0.0)),
                    at.forward + leg.thigh * a.sine + leg.shank * b.sine};
    const double fading = std::fmax(1.0 - u / early_ankle, 0.0),
                 rising = std::fmax((u - late_ankle) / (1.0 - late_ankle), 0.0);
    const double off_slope = (off_rate - first.rate[1]) * span;
    const double dorsiflexion = ankle_off + (ankle_middle - ankle_off) * smooth_step(u, 0.0, middle) +
                                (ankle_strike - ankle_middle) * smooth_step(u, middle, 1.0) +
                                off_slope * u * fading * fading +
                                (strike_rate - target.rate[1]) * span * (u - 1.0) * rising * rising;
    sample.pitch = dorsiflexion + s.q[1];
    sample.toes = -sample.pitch * (1.0 - smooth_step(u, 0.05, 0.6));
    swing.sample.push_back(sample);
  });

  // Where the foot would come lower than asked it is lifted by smooth humps, zero with zero slope at both ends: first
  // so that it leaves the ground upward before it goes forward, then over what is left of the swing.
  const auto part = [](std::size_t i) { return static_cast<double>(i) / integration_steps; };
  const auto raise = [&](auto hump, auto asked) {
    double lift = 0.0;
    for (std::size_t i = 1; i < integration_steps; ++i)
      lift = std::fmax(lift, (asked(part(i)) - clearance(leg, swing.sample[i])) / hump(part(i)));
    for (std::size_t i = 0; i <= integration_steps; ++i) swing.sample[i].ankle.up += lift * hump(part(i));
  };
  const auto leaving = [](double u) {  // 1 where it is highest, at 2/7
    const double v = 1.0 - u;
    return 65.88 * u * u * v * v * v * v * v;
  };
  const auto passing = [](double u) { return 16.0 * u * u * (1.0 - u) * (1.0 - u); };
  raise(leaving, [](double u) { return u < 0.3 ? early_clearance * std::fmin(u * u / (0.1 * 0.1), 1.0) : -1.0; });
  raise(passing, [&](double u) { return style.toe_clearance_m * passing(u) - 0.0015 * (1.0 - passing(u)); });
  return swing;
}

}  // namespace mobil::step
