// Walking requests, the equations of a step against a Lagrangian differentiated here, and the solved steps.
#include "systems/gait/gait.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "assets/anthropometry.h"
#include "systems/gait/step_leg.h"
#include "systems/gait/step_math.h"
#include "systems/gait/step_swing.h"

namespace mobil {
namespace {

using step::gravity;

struct Dice {
  std::mt19937 engine;
  double operator()(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine()) / 4294967296.0);
  }
};

Body body_of(double height, double mass) {
  return *make_body({.height_m = static_cast<float>(height), .mass_kg = static_cast<float>(mass)});
}

TEST(StepMath, AgreesWithTheCLibrary) {
  Dice dice{std::mt19937(1)};
  for (int i = 0; i < 20000; ++i) {
    const double x = dice(-100, 100), y = dice(-3, 3), z = dice(-3, 3), c = dice(-1, 1);
    EXPECT_NEAR(step::sin_cos(x).sine, std::sin(x), 1e-13);
    EXPECT_NEAR(step::sin_cos(x).cosine, std::cos(x), 1e-13);
    EXPECT_NEAR(step::arc_tangent(y, z), std::atan2(y, z), 1e-13);
    EXPECT_NEAR(step::arc_cosine(c), std::acos(c), 1e-12);
  }
}

// d/dt ∂L/∂q̇ − ∂L/∂q by central differences along q(t) = q + q̇ t + ½ q̈ t².
template <std::size_t N, class Lagrangian>
std::array<double, N> generalised_force(Lagrangian lagrangian, const std::array<double, N>& q,
                                        const std::array<double, N>& rate, const std::array<double, N>& acceleration) {
  const double h = 3e-5;
  std::array<double, N> force{};
  for (std::size_t k = 0; k < N; ++k) {
    auto momentum = [&](double t) {
      std::array<double, N> at, faster, slower;
      for (std::size_t i = 0; i < N; ++i) {
        at[i] = q[i] + rate[i] * t + 0.5 * acceleration[i] * t * t;
        faster[i] = slower[i] = rate[i] + acceleration[i] * t;
      }
      faster[k] += h;
      slower[k] -= h;
      return (lagrangian(t, at, faster) - lagrangian(t, at, slower)) / (2.0 * h);
    };
    std::array<double, N> ahead = q, behind = q;
    ahead[k] += h;
    behind[k] -= h;
    force[k] = (momentum(h) - momentum(-h)) / (2.0 * h) -
               (lagrangian(0.0, ahead, rate) - lagrangian(0.0, behind, rate)) / (2.0 * h);
  }
  return force;
}

TEST(StepDynamics, SupportObeysItsLagrangian) {
  Dice dice{std::mt19937(2)};
  for (int trial = 0; trial < 300; ++trial) {
    const step::SupportModel m = {dice(5, 30),   dice(0.3, 0.7), dice(0.2, 2), dice(5, 30),
                                  dice(20, 130), dice(0.2, 0.4), dice(0.3, 4)};
    auto lagrangian = [&](double, const std::array<double, 3>& q, const std::array<double, 3>& v) {
      // Places and velocities of the three masses, from the geometry alone.
      const double s1 = std::sin(q[1]), c1 = std::cos(q[1]), s2 = std::sin(q[2]), c2 = std::cos(q[2]);
      const double hip_x = v[0] * s1 + q[0] * c1 * v[1], hip_y = v[0] * c1 - q[0] * s1 * v[1];
      const double trunk_x = hip_x + m.trunk_centre * c2 * v[2], trunk_y = hip_y - m.trunk_centre * s2 * v[2];
      const double kinetic = 0.5 * m.leg_mass * m.leg_centre * m.leg_centre * (hip_x * hip_x + hip_y * hip_y) +
                             0.5 * m.leg_inertia * v[1] * v[1] + 0.5 * m.hip_mass * (hip_x * hip_x + hip_y * hip_y) +
                             0.5 * m.trunk_mass * (trunk_x * trunk_x + trunk_y * trunk_y) +
                             0.5 * m.trunk_inertia * v[2] * v[2];
      const double potential = gravity * ((m.leg_mass * m.leg_centre + m.hip_mass) * q[0] * c1 +
                                          m.trunk_mass * (q[0] * c1 + m.trunk_centre * c2));
      return kinetic - potential;
    };
    const step::SupportState s = {{dice(0.6, 1.2), dice(-0.7, 0.7), dice(-0.5, 0.5)},
                                  {dice(-1, 1), dice(-3, 3), dice(-3, 3)}};
    const std::array<double, 3> force = {dice(-500, 2000), dice(-200, 200), dice(-200, 200)};
    const auto found = generalised_force<3>(lagrangian, s.q, s.rate, step::support_acceleration(m, s, force));
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found[i], force[i], 4e-3) << i;
  }
}

TEST(StepDynamics, SwingObeysItsLagrangianOnAMovingHip) {
  Dice dice{std::mt19937(3)};
  for (int trial = 0; trial < 300; ++trial) {
    const step::SwingModel m = {dice(3, 20), dice(0.3, 0.5),  dice(0.1, 0.2), dice(0.02, 0.5),
                                dice(2, 12), dice(0.15, 0.3), dice(0.02, 0.3)};
    const std::array<double, 2> hip = {dice(-5, 5), dice(-5, 5)};
    auto lagrangian = [&](double t, const std::array<double, 2>& q, const std::array<double, 2>& v) {
      const double hx = hip[0] * t, hy = hip[1] * t;
      const double thigh_x = hx + m.thigh_centre * std::cos(q[0]) * v[0];
      const double thigh_y = hy + m.thigh_centre * std::sin(q[0]) * v[0];
      const double shank_x = hx + m.thigh_length * std::cos(q[0]) * v[0] + m.shank_centre * std::cos(q[1]) * v[1];
      const double shank_y = hy + m.thigh_length * std::sin(q[0]) * v[0] + m.shank_centre * std::sin(q[1]) * v[1];
      const double kinetic =
          0.5 * m.thigh_mass * (thigh_x * thigh_x + thigh_y * thigh_y) + 0.5 * m.thigh_inertia * v[0] * v[0] +
          0.5 * m.shank_mass * (shank_x * shank_x + shank_y * shank_y) + 0.5 * m.shank_inertia * v[1] * v[1];
      const double potential =
          -gravity * (m.thigh_mass * m.thigh_centre * std::cos(q[0]) +
                      m.shank_mass * (m.thigh_length * std::cos(q[0]) + m.shank_centre * std::cos(q[1])));
      return kinetic - potential;
    };
    const step::SwingState s = {{dice(-0.6, 0.8), dice(-1.2, 0.6)}, {dice(-6, 6), dice(-8, 8)}};
    const std::array<double, 2> force = {dice(-60, 60), dice(-30, 30)};
    const auto found = generalised_force<2>(lagrangian, s.q, s.rate, step::swing_acceleration(m, s, force, hip));
    for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(found[i], force[i], 2e-4) << i;
  }
}

TEST(StepDynamics, APassiveSwingKeepsItsEnergyToFourthOrder) {
  const Body body = body_of(1.8, 80);
  const step::SwingModel m = step::swing_model(step::make_leg(body, *resolve_gait(body, {})), 80.0);
  auto energy = [&](const step::SwingState& s) {
    const double c = std::cos(s.q[0] - s.q[1]);
    return 0.5 *
               (m.thigh_inertia + m.thigh_mass * m.thigh_centre * m.thigh_centre +
                m.shank_mass * m.thigh_length * m.thigh_length) *
               s.rate[0] * s.rate[0] +
           0.5 * (m.shank_inertia + m.shank_mass * m.shank_centre * m.shank_centre) * s.rate[1] * s.rate[1] +
           m.shank_mass * m.thigh_length * m.shank_centre * c * s.rate[0] * s.rate[1] -
           gravity * ((m.thigh_mass * m.thigh_centre + m.shank_mass * m.thigh_length) * std::cos(s.q[0]) +
                      m.shank_mass * m.shank_centre * std::cos(s.q[1]));
  };
  auto drift = [&](int steps) {
    step::SwingState s = {{0.9, -0.4}, {0.0, 1.0}};
    const double before = energy(s), h = 2.0 / steps;
    for (int i = 0; i < steps; ++i)
      s = step::runge_kutta(s, i * h, h, [&](double, const step::SwingState& at) {
        return step::swing_acceleration(m, at, {0.0, 0.0}, {0.0, 0.0});
      });
    return std::fabs(energy(s) - before);
  };
  EXPECT_LT(drift(2000), 1e-7);
  EXPECT_GT(drift(200) / drift(400), 8.0);
}

TEST(GaitRequest, AnyTwoGiveTheThirdAndOneFollowsTheLaw) {
  Dice dice{std::mt19937(4)};
  for (int trial = 0; trial < 200; ++trial) {
    const double height = dice(1.2, 2.2);
    const Body body = body_of(height, 70);
    const auto alone = resolve_gait(body, {.speed_m_s = static_cast<float>(dice(0.5, 1.7) * std::sqrt(height / 1.8))});
    ASSERT_TRUE(alone.has_value()) << alone.error().message;
    EXPECT_NEAR(alone->step_length_m, 0.004 * 60.0 * alone->step_frequency_hz * height, 1e-5);
    EXPECT_NEAR(alone->step_length_m * alone->step_frequency_hz, alone->speed_m_s, 1e-5);
    const float v = alone->speed_m_s, l = alone->step_length_m, f = alone->step_frequency_hz;
    for (const GaitRequest& request :
         {GaitRequest{.step_length_m = l}, GaitRequest{.step_frequency_hz = f},
          GaitRequest{.speed_m_s = v, .step_length_m = l}, GaitRequest{.speed_m_s = v, .step_frequency_hz = f},
          GaitRequest{.step_length_m = l, .step_frequency_hz = f},
          GaitRequest{.speed_m_s = v, .step_length_m = l, .step_frequency_hz = f}}) {
      const auto same = resolve_gait(body, request);
      ASSERT_TRUE(same.has_value()) << same.error().message;
      EXPECT_NEAR(same->speed_m_s, v, 1e-5);
      EXPECT_NEAR(same->step_length_m, l, 1e-5);
      EXPECT_NEAR(same->step_frequency_hz, f, 1e-5);
    }
  }
  EXPECT_NEAR(resolve_gait(body_of(1.8, 80), {})->speed_m_s, 5.0 / 3.6, 1e-6);
}

TEST(GaitRequest, RefusesWhatDisagreesOrIsOutOfRangeInOneLine) {
  const Body body = body_of(1.8, 80);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  auto refused = [&](const GaitRequest& request) {
    const auto gait = resolve_gait(body, request);
    ASSERT_FALSE(gait.has_value());
    EXPECT_EQ(gait.error().message.find('\n'), std::string::npos);
    EXPECT_EQ(gait.error().message.rfind("gait: ", 0), 0U) << gait.error().message;
  };
  refused({.speed_m_s = 1.4F, .step_length_m = 0.7F, .step_frequency_hz = 1.5F});
  for (float v : {0.1F, 3.0F, 0.0F, -1.0F, nan}) refused({.speed_m_s = v});
  for (float l : {0.1F, 1.3F, -0.5F, nan}) refused({.speed_m_s = 1.4F, .step_length_m = l});
  GaitRequest style;
  style.style.pelvis_list_deg = 40.0F;
  refused(style);
  style.style.pelvis_list_deg = nan;
  refused(style);
}

// Random walks within the ranges: each is solved, and keeps its conditions.
template <class Check>
void over_walks(unsigned seed, int count, Check check) {
  Dice dice{std::mt19937(seed)};
  for (int trial = 0; trial < count; ++trial) {
    const double height = dice(1.2, 2.2), mass = dice(30, 200), speed = dice(0.35, 2.2) * std::sqrt(height / 1.8);
    const Body body = body_of(height, mass);
    const auto gait = resolve_gait(body, {.speed_m_s = static_cast<float>(speed)});
    ASSERT_TRUE(gait.has_value()) << gait.error().message;
    SCOPED_TRACE(testing::Message() << height << " m, " << mass << " kg, " << speed << " m/s");
    check(body, *gait);
  }
}

TEST(StepSupport, RepeatsItselfAndIsHighestInMidStance) {
  over_walks(5, 60, [](const Body& body, const Gait& gait) {
    const auto step = step::solve_support(step::support_request(body, gait, step::make_leg(body, gait)));
    ASSERT_TRUE(step.has_value()) << step.error().message;
    EXPECT_NEAR(step->last.q[0], step->first.q[0], 1e-6);
    EXPECT_NEAR(step->last.q[1], -step->first.q[1], 1e-6);
    EXPECT_NEAR(step->last.q[2], step->first.q[2], 1e-6);
    EXPECT_NEAR(step->last.rate[2], step->first.rate[2], 1e-6);
    const step::HipSample &a = step->sample.front(), &b = step->sample.back();
    EXPECT_NEAR(b.forward_m - a.forward_m, gait.step_length_m, 1e-6);
    EXPECT_NEAR(b.up_m, a.up_m, 1e-6);
    EXPECT_NEAR(b.forward_velocity, a.forward_velocity, 1e-6);
    EXPECT_NEAR(b.up_velocity, a.up_velocity, 1e-6);
    std::size_t highest = 0, lowest = 0;
    for (std::size_t i = 0; i < step->sample.size(); ++i) {
      if (step->sample[i].up_m > step->sample[highest].up_m) highest = i;
      if (step->sample[i].up_m < step->sample[lowest].up_m) lowest = i;
      EXPECT_GT(step->sample[i].forward_velocity, 0.0);
    }
    const auto whole = static_cast<double>(step->sample.size() - 1);
    EXPECT_GT(static_cast<double>(highest), 0.40 * whole);
    EXPECT_LT(static_cast<double>(highest), 0.75 * whole);
    EXPECT_LT(static_cast<double>(lowest), 0.25 * whole);
  });
}

TEST(StepSupport, HeavierBodiesOfOneHeightWalkLower) {
  double last = 10.0;
  for (double mass : {65.0, 80.0, 120.0}) {  // figure 7 of the paper
    const Body body = body_of(1.8, mass);
    const Gait gait = *resolve_gait(body, {});
    const auto step = step::solve_support(step::support_request(body, gait, step::make_leg(body, gait)));
    ASSERT_TRUE(step.has_value());
    double mean = 0, low = 10, high = 0;
    for (const auto& s : step->sample) {
      mean += s.up_m / static_cast<double>(step->sample.size());
      low = std::fmin(low, s.up_m);
      high = std::fmax(high, s.up_m);
    }
    EXPECT_LT(mean, last - 0.002);
    EXPECT_GT(high - low, 0.030);  // a natural walk: 30–60 mm
    EXPECT_LT(high - low, 0.060);
    last = mean;
  }
}

TEST(StepPlan, SwingEndsOnTheNextFootholdAndTheCurvesAreFinite) {
  over_walks(6, 60, [](const Body& body, const Gait& gait) {
    const auto plan = plan_step(body, gait);
    ASSERT_TRUE(plan.has_value()) << plan.error().message;
    const auto* word = reinterpret_cast<const float*>(&*plan);
    for (std::size_t i = 0; i < sizeof(*plan) / sizeof(float); ++i) ASSERT_TRUE(std::isfinite(word[i])) << i;
    const step::Leg leg = step::make_leg(body, gait);
    const step::Foot strike = leg.planted(leg.strike_pitch);
    const std::size_t end = knot_count - 1;
    EXPECT_NEAR(plan->swing_forward_m.value[end], 2.0 * leg.step_length + strike.ankle.forward, 1e-6);
    EXPECT_NEAR(plan->swing_up_m.value[end], strike.ankle.up, 1e-6);
    EXPECT_NEAR(plan->foot_pitch[1].value[end], strike.pitch, 1e-6);
    EXPECT_NEAR(plan->foot_pitch[0].value[end], plan->foot_pitch[1].value[0], 1e-6);
  });
}

TEST(StepPlan, AnyStyleWithinItsRangesGivesAPlanOrOneLineAndNeverNaN) {
  Dice dice{std::mt19937(7)};
  int solved = 0;
  for (int trial = 0; trial < 120; ++trial) {
    const Body body = body_of(dice(1.2, 2.2), dice(30, 200));
    GaitRequest request;
    for (const GaitParameter& p : gait_parameters) request.style.*p.value = static_cast<float>(dice(p.low, p.high));
    const auto gait = resolve_gait(body, request);
    if (!gait) continue;
    const auto plan = plan_step(body, *gait);
    if (!plan) {
      EXPECT_EQ(plan.error().message.find('\n'), std::string::npos);
      continue;
    }
    ++solved;
    const auto* word = reinterpret_cast<const float*>(&*plan);
    for (std::size_t i = 0; i < sizeof(*plan) / sizeof(float); ++i) ASSERT_TRUE(std::isfinite(word[i])) << i;
  }
  EXPECT_GT(solved, 30);
}

TEST(GaitParameters, DefaultsLieWithinTheirRanges) {
  const GaitStyle style;
  for (const GaitParameter& p : gait_parameters) {
    EXPECT_GE(style.*p.value, p.low) << p.name;
    EXPECT_LE(style.*p.value, p.high) << p.name;
  }
}

}  // namespace
}  // namespace mobil
