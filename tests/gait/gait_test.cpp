// Gait requests, the table of parameters, and the equations of a step compared with a numerically differentiated
// Lagrangian.
#include "systems/gait/gait.h"
#include "assets/gait/step_lookup.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "tests/gait/step_dynamics.h"
#include "tests/gait/step_math.h"
#include "tests/gait/walkers.h"

namespace mobil::gait_test {
using step::gravity;

Body body_of(double height, double mass) {
  return *make_body({.height_m = static_cast<float>(height), .mass_kg = static_cast<float>(mass)});
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
      // Positions and velocities of the three masses, from geometry only.
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

// Returns a speed as a fraction of the range in which usual steps are also within their range.
float some_speed(Dice& dice, const Body& body, double low, double high) {
  const double leg = body.thigh_length_m + body.shank_length_m;
  return static_cast<float>(dice(low, high) * std::sqrt(leg / 0.90));
}

TEST(GaitRequest, TwoValuesGiveTheThirdAndOneTheUsualStep) {
  Dice dice{std::mt19937(4)};
  for (int trial = 0; trial < 300; ++trial) {
    const double height = dice(1.2, 2.2);
    const Body body = body_of(height, 70);
    const auto alone = resolve_gait(body, {.speed_m_s = some_speed(dice, body, 0.31, 2.29)}, Footwear::barefoot);
    ASSERT_TRUE(alone.has_value()) << alone.error().message;
    const double leg = body.hip_height_m;
    const double usual = usual_step_length(static_cast<float>(alone->speed_m_s / std::sqrt(9.81 * leg)));
    EXPECT_NEAR(alone->step_length_m, usual * leg, 1e-5);
    EXPECT_NEAR(alone->step_length_m * alone->step_frequency_hz, alone->speed_m_s, 1e-5);
    const float v = alone->speed_m_s, l = alone->step_length_m, f = alone->step_frequency_hz;
    for (const GaitRequest& request :
         {GaitRequest{.speed_m_s = v}, GaitRequest{.step_length_m = l}, GaitRequest{.step_frequency_hz = f},
          GaitRequest{.speed_m_s = v, .step_length_m = l}, GaitRequest{.speed_m_s = v, .step_frequency_hz = f},
          GaitRequest{.step_length_m = l, .step_frequency_hz = f},
          GaitRequest{.speed_m_s = v, .step_length_m = l, .step_frequency_hz = f}}) {
      const auto same = resolve_gait(body, request, Footwear::barefoot);
      ASSERT_TRUE(same.has_value()) << same.error().message;
      EXPECT_NEAR(same->speed_m_s, v, 1e-5);
      EXPECT_NEAR(same->step_length_m, l, 1e-5);
      EXPECT_NEAR(same->step_frequency_hz, f, 1e-5);
    }
  }
}

TEST(GaitRequest, TwoRequestedValuesOverrideTheUsualStep) {
  Dice dice{std::mt19937(5)};
  for (int trial = 0; trial < 300; ++trial) {
    const Body body = body_of(dice(1.2, 2.2), 70);
    const float v = some_speed(dice, body, 0.6, 1.9), law = resolve_gait(body, {.speed_m_s = v})->step_length_m;
    const float l = law * dice.single(0.85, 1.15);
    const auto gait = resolve_gait(body, {.speed_m_s = v, .step_length_m = l});
    ASSERT_TRUE(gait.has_value()) << gait.error().message;
    EXPECT_EQ(gait->speed_m_s, v);
    EXPECT_EQ(gait->step_length_m, l);
    EXPECT_NEAR(gait->step_frequency_hz, v / l, 1e-5);
  }
}

TEST(GaitRequest, DefaultIsFiveKilometresAnHourAndZeroStands) {
  const Body body = body_of(1.8, 80);
  EXPECT_NEAR(resolve_gait(body, {})->speed_m_s, 5.0 / 3.6, 1e-6);
  GaitRequest request{.speed_m_s = 0.0F};
  request.style.toe_out_deg = 11.0F;
  const auto standing = resolve_gait(body, request);
  ASSERT_TRUE(standing.has_value()) << standing.error().message;
  EXPECT_EQ(standing->speed_m_s, 0.0F);
  EXPECT_EQ(standing->step_length_m, 0.0F);
  EXPECT_EQ(standing->step_frequency_hz, 0.0F);
  EXPECT_EQ(standing->style.toe_out_deg, 11.0F);
  EXPECT_TRUE(resolve_gait(body, {.speed_m_s = -0.0F}).has_value());
}

void expect_refused(const Body& body, const GaitRequest& request, const std::string& named) {
  const auto gait = resolve_gait(body, request);
  ASSERT_FALSE(gait.has_value()) << named;
  const std::string& line = gait.error().message;
  EXPECT_EQ(line.find('\n'), std::string::npos);
  EXPECT_EQ(line.find("  "), std::string::npos) << line;
  EXPECT_EQ(line.rfind("gait: ", 0), 0U) << line;
  EXPECT_NE(line.find(named), std::string::npos) << line;
}

TEST(GaitRequest, ValuesOutOfRangeAreRefusedByName) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  for (const double height : {1.2, 1.8, 2.2}) {
    const Body body = body_of(height, 80);
    const float leg = body.thigh_length_m + body.shank_length_m, scale = std::sqrt(leg / 0.90F);
    for (const float v : {0.29F, 2.31F, 3.0F}) expect_refused(body, {.speed_m_s = v * scale}, "speed");
    for (const float v : {-1.0F, nan, inf}) expect_refused(body, {.speed_m_s = v}, "speed");
    for (const float l : {0.24F, 1.26F})
      expect_refused(body, {.speed_m_s = 1.2F * scale, .step_length_m = l * leg}, "step length");
    for (const float l : {0.0F, -0.5F, nan, inf})
      expect_refused(body, {.speed_m_s = 1.2F * scale, .step_length_m = l}, "step length");
    for (const float f : {0.49F, 3.01F})
      expect_refused(body, {.step_length_m = 0.5F * leg, .step_frequency_hz = f / scale}, "");
    for (const float f : {0.0F, -2.0F, nan, inf}) expect_refused(body, {.step_frequency_hz = f}, "step frequency");
    expect_refused(body, {.speed_m_s = 0.0F, .step_length_m = 0.5F}, "speed");
  }
}

TEST(GaitRequest, ThreeMustAgreeWithinOnePerCent) {
  const Body body = body_of(1.8, 80);
  for (const float off : {0.97F, 0.985F, 1.015F, 1.03F})
    expect_refused(body, {.speed_m_s = 1.4F, .step_length_m = 0.7F, .step_frequency_hz = 2.0F * off}, "leave one");
  for (const float off : {0.993F, 1.0F, 1.007F})
    EXPECT_TRUE(
        resolve_gait(body, {.speed_m_s = 1.4F, .step_length_m = 0.7F, .step_frequency_hz = 2.0F * off}).has_value());
}

TEST(GaitRequest, EveryParameterIsLimitedToItsRange) {
  const Body body = body_of(1.8, 80);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const GaitParameter& p : gait_parameters) {
    const float room = 0.01F * (p.high - p.low);
    for (const float value : {p.low - room, p.high + room, nan}) {
      GaitRequest request;
      request.style.*p.value = value;
      expect_refused(body, request, std::string(p.name));
    }
    for (const float value : {p.low, p.high}) {
      GaitRequest request;
      request.style.*p.value = value;
      const auto gait = resolve_gait(body, request);
      ASSERT_TRUE(gait.has_value()) << gait.error().message;
      EXPECT_EQ(gait->style.*p.value, value);
    }
  }
}

TEST(GaitParameters, DefaultsAreWithinRangeAndEveryParameterIsDescribed) {
  const GaitStyle style;
  std::set<std::string_view> names;
  for (const GaitParameter& p : gait_parameters) {
    EXPECT_LT(p.low, p.high) << p.name;
    EXPECT_GE(style.*p.value, p.low) << p.name;
    EXPECT_LE(style.*p.value, p.high) << p.name;
    EXPECT_TRUE(names.insert(p.name).second) << p.name << " twice";
    EXPECT_FALSE(p.meaning.empty()) << p.name;
    EXPECT_TRUE(std::set<std::string_view>({"1", "deg", "m", "height", "cycle", "N/m"}).contains(p.unit)) << p.name;
  }
}

TEST(GaitParameters, TableListsEveryFieldOnceInStructOrder) {
  const GaitStyle style;
  std::size_t next = 0;
  for (const GaitParameter& p : gait_parameters) {
    const auto offset = reinterpret_cast<const char*>(&(style.*p.value)) - reinterpret_cast<const char*>(&style);
    EXPECT_EQ(static_cast<std::size_t>(offset), next) << p.name;
    next += sizeof(float);
  }
  EXPECT_EQ(next, sizeof(GaitStyle));
}

TEST(GaitParameters, BlockDefaultsAreRowDefaultsInEveryLane) {
  const GaitStyleOf<Lanes<float>> block;
  const GaitStyle one;
  for (std::size_t l = 0; l < lane_count; ++l) {
    const GaitStyle lane = row(block, l);
    EXPECT_EQ(std::memcmp(&lane, &one, sizeof(one)), 0) << l;
  }
}

}  // namespace mobil::gait_test
