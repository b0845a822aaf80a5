// The forward-integrated swing, compared with double precision, an independent integrator, and the step that it belongs
// to.
#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "systems/gait/forward_swing-inl.h"
#include "tests/gait/adams.h"
#include "tests/gait/step_dynamics.h"
#include "tests/gait/walkers.h"

namespace mobil::forward_swing_test {
namespace wide_step = HWY_NAMESPACE;  // the compiler's own instruction set
using wide_step::swing_instants;
using wide_step::swing_steps;
using wide_step::SwingState;
using wide_step::SwingToMeet;
using wide_step::torque_count;
using wide_step::Wide;

constexpr double degree = 3.14159265358979 / 180;

double lane_of(const Wide& w, std::size_t l) {
  Lanes<float> lanes;
  wide_step::store(w, lanes);
  return static_cast<double>(lanes[l]);
}
step::SwingState state_of(const SwingState& y, std::size_t l) {
  return {{lane_of(y.thigh, l), lane_of(y.shank, l)}, {lane_of(y.thigh_rate, l), lane_of(y.shank_rate, l)}};
}

/// Returns a thigh, and a shank with the foot's mass at its end, per kg, in body heights.
step::SwingModel model() {
  using namespace forces;
  const double a = fraction::thigh, b = fraction::shank, thigh_mass = 0.1416, shank_mass = 0.0433, foot_mass = 0.0137,
               below = shank_mass + foot_mass;
  const double centre = (shank_mass * shank.centre + foot_mass) / below, off = 1 - centre, up = shank.centre - centre;
  auto square = [](double x) { return x * x; };
  return {thigh_mass,
          a,
          thigh.centre * a,
          thigh_mass * square(thigh.gyration * a),
          below,
          centre * b,
          (shank_mass * (square(shank.gyration) + square(up)) + foot_mass * square(off)) * b * b};
}

struct Swing {
  SwingToMeet to_meet;
  Wide first[torque_count], number[torque_count];
  SwingState way[swing_steps + 1];

  explicit Swing(const Walkers& w, int rounds = 3) {
    wide_step::swing_to_meet(w.plan, wide_step::unit_swing_leg, wide_step::leg_size(w.size), to_meet);
    wide_step::first_numbers(wide_step::unit_swing_leg, to_meet, first);
    for (std::size_t k = 0; k < torque_count; ++k) number[k] = first[k];
    for (int round = 0; round < rounds; ++round) {
      for (std::size_t k = 0; k < torque_count; ++k) used[k] = number[k];
      wide_step::swing_forward(wide_step::unit_swing_leg, to_meet, first, number, way);
    }
  }
  Wide used[torque_count];  // the parameters of that path
};

/// Torques at hip and knee as in forward_swing-inl.h, computed independently in double precision.
struct Torques {
  const Swing& swing;
  std::size_t lane;
  double span_s;

  std::array<double, torque_count> parts(double u, const step::SwingState& y) const {
    auto pulse = [&](double middle, double width) { return std::exp(-(u - middle) * (u - middle) / (width * width)); };
    return {pulse(0.1, 0.25), pulse(0.9, 0.2), y.q[0] - y.q[1], -1, y.rate[0] - y.rate[1], pulse(0.9, 0.12)};
  }
  std::array<double, 2> operator()(double u, const step::SwingState& y) const {
    const double off = std::pow(std::max(1 - u / 0.15, 0.0), 3), on = std::pow(std::max((u - 0.9) / 0.1, 0.0), 3);
    const SwingToMeet& m = swing.to_meet;
    const auto now = parts(u, y), first = parts(0, state_of(m.at[0], lane)),
               last = parts(1, state_of(m.at[swing_instants - 1], lane));
    std::array<double, 2> sum = {off * lane_of(m.off.hip, lane) + on * lane_of(m.on.hip, lane),
                                 off * lane_of(m.off.knee, lane) + on * lane_of(m.on.knee, lane)};
    for (std::size_t k = 0; k < torque_count; ++k)
      sum[k < 2 ? 0 : 1] += lane_of(swing.used[k], lane) * (now[k] - off * first[k] - on * last[k]);
    return sum;
  }
  std::array<double, 2> pull(double u) const {
    const double at = u * (swing_instants - 1);
    const auto i = std::min(static_cast<std::size_t>(std::max(at, 0.0)), swing_instants - 2);
    const wide_step::Pull &a = swing.to_meet.pull[i], &b = swing.to_meet.pull[i + 1];
    const double part = at - static_cast<double>(i);
    auto mix = [&](const Wide& x, const Wide& y) { return lane_of(x, lane) * (1 - part) + lane_of(y, lane) * part; };
    return {mix(a.forward, b.forward), mix(a.up, b.up) - 9.81};
  }
};

std::unique_ptr<Walkers> walkers(unsigned seed, double style_part, bool unlike) {
  auto w = random_walkers(seed, style_part);
  if (!unlike) return w;
  Dice dice{std::mt19937(seed + 1000)};
  for (std::size_t l = 0; l < lane_count; ++l) ask_natural(*w, l, dice, style_part);
  w->strike();
  return w;
}

/// Eight Runge–Kutta steps in single precision, compared with Adams' method in double precision to 1e-9.
TEST(ForwardSwing, FollowsItsTorques) {
  const step::SwingModel leg = model();
  double sum = 0, count = 0;
  for (const bool unlike : {false, true}) {
    const auto w = walkers(unlike ? 5 : 4, 0, unlike);
    const Swing swing(*w);
    for (std::size_t l = 0; l < lane_count; ++l) {
      const double span = lane_of(swing.to_meet.apart_s, l) * (swing_instants - 1);
      const Torques torques{swing, l, span};
      const step::SwingState start = state_of(swing.to_meet.at[0], l);
      step::AdamsOptions<4> options;
      for (std::size_t i = 0; i < 4; ++i) options.absolute[i] = options.relative[i] = 1e-9;
      std::size_t next = 1;
      auto at = [&](std::size_t i) { return static_cast<double>(i) * span / swing_steps; };
      const auto end = step::integrate_adams<4>(
          [&](double t, const step::Unknowns<4>& y) {
            const double u = std::clamp(t / span, 0.0, 1.0);
            const step::SwingState now{{y[0], y[1]}, {y[2], y[3]}};
            const auto torque = torques(u, now);
            const auto bend = step::swing_acceleration(leg, now, {torque[0] - torque[1], torque[1]}, torques.pull(u));
            return step::Unknowns<4>{y[2], y[3], bend[0], bend[1]};
          },
          {start.q[0], start.q[1], start.rate[0], start.rate[1]}, 0.0, span, options,
          [&](const step::DenseStep<4>& piece) {
            while (next <= swing_steps && at(next) <= piece.end_s + 1e-12) {
              const auto y = piece.state(at(next));
              const step::SwingState is = state_of(swing.way[next], l);
              for (std::size_t i = 0; i < 2; ++i) {
                EXPECT_NEAR(is.q[i], y[i], 0.6 * degree) << next << " lane " << l;
                sum += std::fabs(is.q[i] - y[i]);
                ++count;
              }
              ++next;
            }
          });
      ASSERT_TRUE(end);
      EXPECT_EQ(next, swing_steps + 1);
    }
  }
  EXPECT_LT(sum / count, 0.1 * degree);
}

/// At toe-off and at heel strike the torques equal those of the step for any parameters.
TEST(ForwardSwing, TorquesAreContinuousAtBothEnds) {
  const auto w = walkers(6, 0.3, true);
  const Swing swing(*w);
  for (const bool off : {true, false}) {
    wide_step::SwingFlow y, rate;
    y.state = swing.to_meet.at[off ? 0 : swing_instants - 1];
    for (auto& by : y.by) by = y.state;
    const std::size_t at = off ? 0 : swing_instants - 1;
    wide_step::swing_rates(wide_step::unit_swing_leg, swing.to_meet, swing.used, at, y, rate);
    const wide_step::Torques taken = wide_step::unit_swing_leg.torques(y.state, rate.state.thigh_rate,
                                                                       rate.state.shank_rate, swing.to_meet.pull[at]);
    const wide_step::Torques& meant = off ? swing.to_meet.off : swing.to_meet.on;
    for (std::size_t l = 0; l < lane_count; ++l) {
      const double size = std::fabs(lane_of(meant.hip, l)) + std::fabs(lane_of(meant.knee, l));
      EXPECT_NEAR(lane_of(taken.hip, l), lane_of(meant.hip, l), 1e-3 * size + 1e-4) << off << " lane " << l;
      EXPECT_NEAR(lane_of(taken.knee, l), lane_of(meant.knee, l), 1e-3 * size + 1e-4) << off << " lane " << l;
    }
  }
}

/// Derivatives of the state's rates with respect to the torque parameters, compared with differences.
TEST(ForwardSwing, DerivativesMatchDifferencesOfRates) {
  const auto w = walkers(7, 0, true);
  const Swing swing(*w);
  constexpr float by = 0.01F;
  for (std::size_t i = 1; i < swing_steps; ++i) {
    for (std::size_t k = 0; k < torque_count; ++k) {
      wide_step::SwingFlow y, rate;
      y.state = swing.way[i];
      for (auto& d : y.by)
        d = {wide_step::wide(0.3F), wide_step::wide(-0.2F), wide_step::wide(1.0F), wide_step::wide(2.0F)};
      wide_step::swing_rates(wide_step::unit_swing_leg, swing.to_meet, swing.used, 2 * i, y, rate);
      auto shifted = [&](float sign) {
        wide_step::SwingFlow there = y, out;
        there.state = wide_step::moved(y.state, y.by[k], wide_step::wide(sign * by));
        Wide number[torque_count];
        for (std::size_t j = 0; j < torque_count; ++j) number[j] = swing.used[j] + (j == k ? sign * by : 0.0F);
        wide_step::swing_rates(wide_step::unit_swing_leg, swing.to_meet, number, 2 * i, there, out);
        return out.state;
      };
      const SwingState up = shifted(1), down = shifted(-1);
      for (std::size_t l = 0; l < lane_count; ++l) {
        const double thigh = (lane_of(up.thigh_rate, l) - lane_of(down.thigh_rate, l)) / (2 * double{by});
        const double shank = (lane_of(up.shank_rate, l) - lane_of(down.shank_rate, l)) / (2 * double{by});
        const double size = std::fabs(thigh) + std::fabs(shank) + 10;
        EXPECT_NEAR(lane_of(rate.by[k].thigh_rate, l), thigh, 5e-3 * size) << "number " << k << " at " << i;
        EXPECT_NEAR(lane_of(rate.by[k].shank_rate, l), shank, 5e-3 * size) << "number " << k << " at " << i;
      }
    }
  }
}

/// Any body, natural speeds, uneven steps.
TEST(ForwardSwing, LandsAsTheStepAndStaysNearIt) {
  double sum = 0, count = 0;
  for (unsigned seed = 20; seed < 40; ++seed) {
    const auto w = walkers(seed, 0, seed % 2 == 0);
    const Swing swing(*w);
    for (std::size_t l = 0; l < lane_count; ++l) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", lane " + std::to_string(l));
      const step::SwingState is = state_of(swing.way[swing_steps], l),
                             meant = state_of(swing.to_meet.at[swing_instants - 1], l);
      for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_NEAR(is.q[i], meant.q[i], 1.5 * degree);
        sum += std::fabs(is.q[i] - meant.q[i]);
        ++count;
        EXPECT_NEAR(is.rate[i], meant.rate[i], 20 * degree);
      }
      for (std::size_t i = 1; i < swing_steps; ++i) {
        const wide_step::AnkleBelow now(wide_step::unit_swing_leg, swing.way[i]),
            was(wide_step::unit_swing_leg, swing.to_meet.at[2 * i]);
        EXPECT_NEAR(lane_of(now.forward, l), lane_of(was.forward, l), 0.030) << i;
        EXPECT_NEAR(lane_of(now.up, l), lane_of(was.up, l), 0.015) << i;
      }
      // The knee acts as a spring and a damper.
      EXPECT_GT(lane_of(swing.used[2], l), 0.0);
    }
  }
  EXPECT_LT(sum / count, 0.2 * degree);
}

/// A walker with the option uses it. Others in the block keep their bits.
TEST(ForwardSwing, AffectsOnlyWalkersThatEnableIt) {
  const auto all = walkers(8, 0, true), some = walkers(8, 0, true);
  for (std::size_t l = 0; l < lane_count; l += 2) some->gait.style.forward_swing[l] = 1;
  for (Walkers* w : {all.get(), some.get()}) {
    w->strike();
    w->place_at(0.6F);
  }
  for (std::size_t l = 0; l < lane_count; ++l) {
    const Pose<float> a = row(all->pose, l), b = row(some->pose, l);
    EXPECT_EQ(std::memcmp(&a, &b, sizeof a) == 0, l % 2 == 1) << l;
    EXPECT_EQ(some->plan.swing_by_up_m[0][l] != 0, l % 2 == 0) << l;
    EXPECT_LT(std::fabs(all->angles.knee_flexion[Side::left][l] - some->angles.knee_flexion[Side::left][l]),
              6 * degree);
    EXPECT_LT(std::fabs(all->angles.knee_flexion[Side::right][l] - some->angles.knee_flexion[Side::right][l]),
              6 * degree);
  }
}

}  // namespace mobil::forward_swing_test
