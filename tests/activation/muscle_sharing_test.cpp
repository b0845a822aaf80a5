// Muscle activations from a walk's own moments by static optimisation, compared with measured EMG.
#include "tests/activation/muscle_sharing.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <string_view>

#include <mobil/components/activation.h>
#include <mobil/components/pose.h>
#include <mobil/engine/world.h>
#include <mobil/forces.h>
#include <mobil/simulation.h>
#include "systems/activation/moment_sharing.h"
#include "tests/activation/hill_reference.h"
#include "tests/activation/pulling_walker.h"

namespace mobil::muscle_sharing_test {
namespace {

using test::MomentVector, test::share_moments, test::SharingMember, test::SharingReserves;

/// All joints have all their muscles and nearly no reserve.
const SharingReserves nearly_none = {{{2, 1e-3}, {2, 1e-3}, {2, 1e-3}, {2, 1e-3}, {2, 1e-3}}};

MomentVector any_moments(std::mt19937& dice, std::uniform_real_distribution<double>& each) {
  MomentVector made;
  for (double& one : made) one = each(dice);
  return made;
}

std::vector<SharingMember> random_leg(std::mt19937& dice) {
  std::uniform_real_distribution<double> arm(-0.07, 0.07), force(200, 3000), volume(5e-5, 1e-3);
  std::vector<SharingMember> leg(leg_member_count);
  for (SharingMember& one : leg) one = {volume(dice), force(dice), force(dice) / 50, any_moments(dice, arm)};
  return leg;
}

double cost(const std::vector<SharingMember>& leg, const SharingReserves& reserves, const std::vector<double>& a,
            const MomentVector& reserve_nm) {
  double sum = 0;
  for (std::size_t i = 0; i < leg.size(); ++i) sum += leg[i].volume_m3 * a[i] * a[i];
  for (std::size_t j = 0; j < leg_moment_count; ++j)
    sum += reserves[j].volume_m3 * std::pow(reserve_nm[static_cast<Eigen::Index>(j)] / reserves[j].size_nm, 2);
  return sum;
}

/// Any other activations need more reserve and cost more.
TEST(MuscleSharing, IsTheCheapestThatMakesTheMoments) {
  std::mt19937 dice(7);
  std::uniform_real_distribution<double> moment(-120, 120), other(0.01, 1);
  for (int leg_number = 0; leg_number < 200; ++leg_number) {
    const auto leg = random_leg(dice);
    const MomentVector asked = any_moments(dice, moment);
    const auto shared = share_moments(leg, asked, nearly_none);
    const auto lacks = [&](const std::vector<double>& a) {
      MomentVector left = asked;
      for (std::size_t i = 0; i < leg.size(); ++i) left -= (a[i] * leg[i].active_n + leg[i].passive_n) * leg[i].arm_m;
      return left;
    };
    ASSERT_LT((lacks(shared.activation) - shared.reserve_nm).norm(), 1e-6);
    const double least = cost(leg, nearly_none, shared.activation, shared.reserve_nm);
    for (int step = 1; step <= 40; ++step) {
      auto a = shared.activation;
      for (double& x : a) x += std::pow(0.7, step) * (other(dice) - x);
      ASSERT_GE(cost(leg, nearly_none, a, lacks(a)), least * (1 - 1e-9));
    }
  }
}

MomentVector vector_of(const LegMoments<Lanes<float>>& moments, std::size_t lane) {
  MomentVector to;
  to << moments.hip[lane], moments.hip_abduction[lane], moments.hip_rotation[lane], moments.knee[lane],
      moments.ankle[lane];
  return to;
}

/// A leg of random muscles in each lane, with moments that some legs cannot make. At its flexion the hip's passive
/// tissue is nearly slack.
struct MadeUpLegs {
  LegDesign<Lanes<float>> design{};
  std::array<Lanes<float>, leg_member_count> path;
  std::array<LegMoments<Lanes<float>>, leg_member_count> arm;
  LegMoments<Lanes<float>> moments, price{}, left;
  std::array<Lanes<float>, leg_member_count> smooth{}, of_most;
  Lanes<std::uint32_t> at_most;
  static constexpr float hip_rad = 0.4F, knee_rad = 0.3F;

  explicit MadeUpLegs(std::mt19937& dice) {
    std::uniform_real_distribution<float> arm_m(-0.06F, 0.06F), moment(-60, 60), force(200, 1500), fibre(0.05F, 0.3F),
        stretch(0.9F, 1.15F);
    const auto fill = [&](LegMoments<Lanes<float>>& of, auto& each, std::size_t lane) {
      for (auto* one : {&of.hip, &of.hip_abduction, &of.hip_rotation, &of.knee, &of.ankle}) (*one)[lane] = each(dice);
    };
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      for (std::size_t i = 0; i < leg_member_count; ++i) {
        auto& of = design.member[i];
        of.fibre_m[lane] = fibre(dice), of.force_n[lane] = force(dice);
        of.tendon_m[lane] = 0.01F * of.fibre_m[lane];  // so short that forces do not depend on tendon length
        of.height_m[lane] = 0.2F * of.fibre_m[lane];
        path[i][lane] = of.tendon_m[lane] + stretch(dice) * of.fibre_m[lane];
        fill(arm[i], arm_m, lane);
      }
      fill(moments, moment, lane);
    }
  }

  /// Shares the same moments in several ticks.
  void share(int ticks) {
    SharedLeg leg{path.data(), arm.data(), {}, {}};
    for (std::size_t lane = 0; lane < lane_count; ++lane)
      leg.flexion_rad.hip[lane] = hip_rad, leg.flexion_rad.knee[lane] = knee_rad, leg.size[lane] = 1;
    for (int tick = 0; tick < ticks; ++tick)
      share_moments(design, leg, moments, price, smooth.data(), of_most.data(), left, at_most);
  }

  MomentVector asked(std::size_t lane) const {
    MomentVector all = vector_of(moments, lane);
    all[0] += passive_hip_nm(double{hip_rad}, double{knee_rad});
    return all;
  }
  std::vector<SharingMember> leg(std::size_t lane) const {
    std::vector<SharingMember> members;
    for (std::size_t i = 0; i < leg_member_count; ++i) {
      const auto& of = design.member[i];
      const double most = of.force_n[lane], along = (path[i][lane] - of.tendon_m[lane]) / of.fibre_m[lane];
      const double m = std::hypot(along, 0.2), cos = along / m;
      members.push_back({most * of.fibre_m[lane] / 30e4, most * test::hill_active(m) * cos,
                         most * test::hill_passive(m) * cos, vector_of(arm[i], lane)});
    }
    return members;
  }
};

/// In a few ticks the fixed number of steps reaches the solution. The residual of the other legs is reported.
TEST(MuscleSharing, LanesMatchTheReference) {
  std::mt19937 dice(11);
  int legs = 0, near = 0;
  for (int block = 0; block < 20; ++block) {
    MadeUpLegs made_up(dice);
    made_up.share(6);
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      const auto leg = made_up.leg(lane);
      const auto exact = share_moments(leg, made_up.asked(lane), nearly_none);
      MomentVector left = made_up.asked(lane);
      double off = 0;
      std::uint32_t full = 0;
      for (std::size_t i = 0; i < leg_member_count; ++i) {
        const double force = double{made_up.of_most[i][lane]} * made_up.design.member[i].force_n[lane];
        left -= force * leg[i].arm_m;
        off = std::max(off, std::abs((force - leg[i].passive_n) / leg[i].active_n - exact.activation[i]));
        full += exact.activation[i] >= 1 ? 1 : 0;
      }
      ASSERT_LT((left - vector_of(made_up.left, lane)).norm(), 2e-3);
      ++legs;
      if (off > 0.03) continue;
      ++near;
      EXPECT_LT((left - exact.reserve_nm).norm(), 2);
      EXPECT_NEAR(made_up.at_most[lane], full, 1);
    }
  }
  EXPECT_GE(near, 0.98 * legs);
}

TEST(MuscleSharing, NanStaysInItsLane) {
  std::mt19937 dice(5);
  const MadeUpLegs start(dice);
  MadeUpLegs sound = start, broken = start;
  sound.share(2);
  broken.moments.knee[3] = std::numeric_limits<float>::quiet_NaN();
  broken.path[4][9] = std::numeric_limits<float>::quiet_NaN();
  broken.share(2);
  for (std::size_t i = 0; i < leg_member_count; ++i) {
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      if (lane == 3 || lane == 9) continue;
      EXPECT_EQ(broken.of_most[i][lane], sound.of_most[i][lane]);
    }
  }
  broken.moments = start.moments;
  broken.path = start.path;
  broken.share(8);  // they recover
  for (const std::size_t lane : {std::size_t{3}, std::size_t{9}}) EXPECT_TRUE(std::isfinite(broken.of_most[0][lane]));
}

/// Riener and Edrich's figure: about 20 N m flexing at 20° of extension, and extending in deep flexion.
TEST(MuscleSharing, PassiveHipIsThePublishedOne) {
  constexpr double degree = 0.0174532925;
  EXPECT_NEAR(passive_hip_nm(-20 * degree, 0), std::exp(1.4655 + 1.5) - std::exp(1.3403 - 0.61) + 8.072, 1e-4);
  EXPECT_NEAR(passive_hip_nm(-20 * degree, 0), 25.4, 0.1);
  EXPECT_LT(passive_hip_nm(100 * degree, 0), -50);
  EXPECT_NEAR(passive_hip_nm(0, 90 * degree), std::exp(1.4655 - 0.306) - std::exp(1.3403 - 2.034) + 8.072, 1e-4);
}

struct Curve {
  std::vector<double> asked, excited;
};
struct Stride {
  std::map<std::string_view, Curve> muscle;
  std::vector<MomentVector> moment_nm, left_nm;
};

/// Returns a stride of the right leg of two walkers who differ only in the source of excitation: measured, or their own
/// moments.
Stride walk(float speed_m_s) {
  Stride stride;
  Simulation simulation;
  const auto by_phase = test::pulling_walker(simulation, speed_m_s);
  const auto by_moments = test::pulling_walker(simulation, speed_m_s, ExcitationSource::moments);
  if (!by_phase || !by_moments) return stride;
  float last_phase = 1;
  for (int tick = 0, strikes = 0; tick < 600 && strikes < 3; ++tick) {
    simulation.tick();
    const float phase = (*simulation.get<Feet>(*by_phase)).phase[Side::right];
    strikes += phase < last_phase ? 1 : 0;
    last_phase = phase;
    if (strikes != 2) continue;
    const auto moments = *simulation.get<JointMoments>(*by_moments);
    const auto left = (*simulation.get<MomentReserve>(*by_moments)).left_nm[Side::right];
    stride.moment_nm.emplace_back(moments.hip_nm[Side::right], moments.hip_abduction_nm[Side::right],
                                  moments.hip_rotation_nm[Side::right], moments.knee_nm[Side::right],
                                  moments.ankle_nm[Side::right]);
    stride.left_nm.emplace_back(left.hip, left.hip_abduction, left.hip_rotation, left.knee, left.ankle);
    const auto of = [&](Entity person, Muscle muscle) {
      return *simulation.get<Activation>(simulation.muscle(person, muscle, Side::right));
    };
    for (const MuscleRef& own : simulation.muscles(*by_phase)) {
      Curve& curve = stride.muscle[muscle_name(own.muscle)];
      curve.asked.push_back(of(*by_moments, own.muscle).excitation);  // activation follows with a lag
      curve.excited.push_back(of(*by_phase, own.muscle).activation);
    }
  }
  return stride;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const Eigen::Map<const Eigen::ArrayXd> x(a.data(), static_cast<Eigen::Index>(a.size())),
      y(b.data(), static_cast<Eigen::Index>(b.size()));
  const Eigen::ArrayXd dx = x - x.mean(), dy = y - y.mean();
  return (dx * dy).sum() / std::sqrt(dx.square().sum() * dy.square().sum());
}

double rms(const std::vector<MomentVector>& moments, Eigen::Index which) {
  double sum = 0;
  for (const MomentVector& one : moments) sum += one[which] * one[which];
  return std::sqrt(sum / static_cast<double>(moments.size()));
}

/// Muscles make the moments of all joints. The rotators of the hip are at their most for some
/// time, and at 1.8 m/s its flexors too.
TEST(MuscleSharing, MusclesOfTheLegMakeItsMoments) {
  for (const float speed : {0.8F, 1.3F, 1.8F}) {
    const Stride stride = walk(speed);
    ASSERT_GT(stride.moment_nm.size(), 30U);
    for (Eigen::Index k = 0; k < Eigen::Index{leg_moment_count}; ++k) {
      const double share = rms(stride.left_nm, k) / rms(stride.moment_nm, k);
      EXPECT_LT(share, speed < 1.5F ? (k == 2 ? 0.1 : 0.03)
                       : k == 2     ? 0.75
                                    : 0.17)
          << "moment " << k << " at " << speed;
    }
  }
}

/// Compares two independent sources: people's measured excitation, and the activations that the walk's moments require.
TEST(MuscleSharing, WalkMomentsGiveMeasuredActivations) {
  for (const float speed : {0.9F, 1.39F, 1.8F}) {
    const Stride stride = walk(speed);
    ASSERT_GT(stride.moment_nm.size(), 30U);
    const std::map<std::string_view, double> least = {
        {"soleus", 0.4}, {"gastrocnemius_medial", 0.6}, {"gastrocnemius_lateral", 0.6}, {"vastus_lateralis", 0.3}};
    for (const auto& [name, r] : least) {
      const Curve& curve = stride.muscle.at(name);
      EXPECT_GT(correlation(curve.asked, curve.excited), r) << name << " at " << speed;
      const double asked = *std::ranges::max_element(curve.asked), excited = *std::ranges::max_element(curve.excited);
      EXPECT_LT(asked, 2 * excited) << name << " at " << speed;
      EXPECT_GT(asked, 0.5 * excited) << name << " at " << speed;
    }
  }
}

}  // namespace
}  // namespace mobil::muscle_sharing_test
