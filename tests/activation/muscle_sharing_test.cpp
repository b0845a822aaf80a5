// Muscle activations from a walk's own moments by static optimisation, compared with measured EMG.
#include "tests/activation/muscle_sharing.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <string_view>

#include <mobil/components/pose.h>
#include <mobil/engine/world.h>
#include <mobil/forces.h>
#include <mobil/simulation.h>
#include "systems/activation/moment_sharing.h"
#include "tests/activation/hill_reference.h"
#include "tests/activation/pulling_walker.h"

namespace mobil::muscle_sharing_test {
namespace {

using Eigen::Vector3d;
using test::share_moments, test::SharingMember, test::SharingReserves;

/// Iliopsoas and glutei: 2000 N at 4 cm, fibres of 0.1 m. Knee and ankle have all their muscles and nearly no reserve.
const SharingReserves missing_at_the_hip = {{{80, 6.7e-4}, {1, 1e-3}, {1, 1e-3}}};

std::vector<SharingMember> random_leg(std::mt19937& dice) {
  std::uniform_real_distribution<double> arm(-0.07, 0.07), force(200, 3000), volume(5e-5, 1e-3);
  std::vector<SharingMember> leg(13);
  for (SharingMember& one : leg) one = {volume(dice), force(dice), force(dice) / 50, {arm(dice), arm(dice), arm(dice)}};
  return leg;
}

double cost(const std::vector<SharingMember>& leg, const SharingReserves& reserves, const std::vector<double>& a,
            const Vector3d& reserve_nm) {
  double sum = 0;
  for (std::size_t i = 0; i < leg.size(); ++i) sum += leg[i].volume_m3 * a[i] * a[i];
  for (std::size_t j = 0; j < 3; ++j)
    sum += reserves[j].volume_m3 * std::pow(reserve_nm[static_cast<Eigen::Index>(j)] / reserves[j].size_nm, 2);
  return sum;
}

/// Any other activations need more reserve and cost more.
TEST(MuscleSharing, IsTheCheapestThatMakesTheMoments) {
  std::mt19937 dice(7);
  std::uniform_real_distribution<double> moment(-120, 120), other(0.01, 1);
  for (int leg_number = 0; leg_number < 200; ++leg_number) {
    const auto leg = random_leg(dice);
    const Vector3d asked(moment(dice), moment(dice), moment(dice));
    const auto shared = share_moments(leg, asked, missing_at_the_hip);
    const auto lacks = [&](const std::vector<double>& a) {
      Vector3d left = asked;
      for (std::size_t i = 0; i < leg.size(); ++i) left -= (a[i] * leg[i].active_n + leg[i].passive_n) * leg[i].arm_m;
      return left;
    };
    ASSERT_LT((lacks(shared.activation) - shared.reserve_nm).norm(), 1e-6);
    const double least = cost(leg, missing_at_the_hip, shared.activation, shared.reserve_nm);
    for (int step = 1; step <= 40; ++step) {
      auto a = shared.activation;
      for (double& x : a) x += std::pow(0.7, step) * (other(dice) - x);
      ASSERT_GE(cost(leg, missing_at_the_hip, a, lacks(a)), least * (1 - 1e-9));
    }
  }
}

/// A leg of random muscles in each lane, with moments that some legs cannot make.
struct MadeUpLegs {
  LegDesign<Lanes<float>> design{};
  std::array<Lanes<float>, leg_member_count> path;
  std::array<LegMoments<Lanes<float>>, leg_member_count> arm;
  LegMoments<Lanes<float>> moments;

  explicit MadeUpLegs(std::mt19937& dice) {
    std::uniform_real_distribution<float> arm_m(-0.06F, 0.06F), moment(-60, 60), force(200, 1500), fibre(0.05F, 0.3F),
        stretch(0.9F, 1.15F);
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      for (std::size_t i = 0; i < leg_member_count; ++i) {
        auto& of = design.member[i];
        of.fibre_m[lane] = fibre(dice), of.force_n[lane] = force(dice);
        of.tendon_m[lane] = 0.01F * of.fibre_m[lane];  // so short that forces do not depend on tendon length
        of.height_m[lane] = 0.2F * of.fibre_m[lane];
        path[i][lane] = of.tendon_m[lane] + stretch(dice) * of.fibre_m[lane];
        for (auto* one : {&arm[i].hip, &arm[i].knee, &arm[i].ankle}) (*one)[lane] = arm_m(dice);
      }
      for (auto* one : {&moments.hip, &moments.knee, &moments.ankle}) (*one)[lane] = moment(dice);
    }
  }

  Vector3d asked(std::size_t lane) const { return {moments.hip[lane], moments.knee[lane], moments.ankle[lane]}; }
  std::vector<SharingMember> leg(std::size_t lane) const {
    std::vector<SharingMember> members;
    for (std::size_t i = 0; i < leg_member_count; ++i) {
      const auto& of = design.member[i];
      const double most = of.force_n[lane], along = (path[i][lane] - of.tendon_m[lane]) / of.fibre_m[lane];
      const double m = std::hypot(along, 0.2), cos = along / m;
      members.push_back({most * of.fibre_m[lane] / 30e4,
                         most * test::hill_active(m) * cos,
                         most * test::hill_passive(m) * cos,
                         {arm[i].hip[lane], arm[i].knee[lane], arm[i].ankle[lane]}});
    }
    return members;
  }
};

/// The fixed number of steps suffices for 98 % of legs. The residual of the others is reported.
TEST(MuscleSharing, LanesMatchTheReference) {
  std::mt19937 dice(11);
  int legs = 0, near = 0;
  for (int block = 0; block < 40; ++block) {
    const MadeUpLegs made_up(dice);
    std::array<Lanes<float>, leg_member_count> of_most;
    LegMoments<Lanes<float>> reserve;
    Lanes<std::uint32_t> at_most;
    share_moments(made_up.design, made_up.path.data(), made_up.arm.data(), made_up.moments, of_most.data(), reserve,
                  at_most);
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      const auto leg = made_up.leg(lane);
      const auto exact = share_moments(leg, made_up.asked(lane), missing_at_the_hip);
      Vector3d left = made_up.asked(lane);
      double off = 0;
      std::uint32_t full = 0;
      for (std::size_t i = 0; i < leg_member_count; ++i) {
        const double force = double{of_most[i][lane]} * made_up.design.member[i].force_n[lane];
        left -= force * leg[i].arm_m;
        off = std::max(off, std::abs((force - leg[i].passive_n) / leg[i].active_n - exact.activation[i]));
        full += exact.activation[i] >= 1 ? 1 : 0;
      }
      ASSERT_LT((left - Vector3d(reserve.hip[lane], reserve.knee[lane], reserve.ankle[lane])).norm(), 1e-3);
      ++legs;
      if (off > 0.02) continue;
      ++near;
      EXPECT_LT((left - exact.reserve_nm).norm(), 2);
      EXPECT_NEAR(at_most[lane], full, 1);
    }
  }
  EXPECT_GE(near, 0.98 * legs);
}

TEST(MuscleSharing, NanStaysInItsLane) {
  std::mt19937 dice(5);
  MadeUpLegs made_up(dice);
  std::array<Lanes<float>, leg_member_count> sound, of_most;
  LegMoments<Lanes<float>> reserve;
  Lanes<std::uint32_t> at_most;
  const auto shared = [&](std::array<Lanes<float>, leg_member_count>& to) {
    share_moments(made_up.design, made_up.path.data(), made_up.arm.data(), made_up.moments, to.data(), reserve,
                  at_most);
  };
  shared(sound);
  made_up.moments.knee[3] = std::numeric_limits<float>::quiet_NaN();
  made_up.path[4][9] = std::numeric_limits<float>::quiet_NaN();
  shared(of_most);
  for (std::size_t i = 0; i < leg_member_count; ++i) {
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      if (lane == 3 || lane == 9) continue;
      EXPECT_EQ(of_most[i][lane], sound[i][lane]);
    }
  }
}

struct Curve {
  std::vector<double> asked, excited;
};
struct Stride {
  std::map<std::string_view, Curve> muscle;
  std::vector<Vector3d> moment_nm, reserve_nm;
};

/// Returns a stride of the right leg. Fibre lengths and speeds are those of a walk with measured excitation.
Stride walk(float speed_m_s) {
  Stride stride;
  Simulation simulation;
  const auto walker = test::pulling_walker(simulation, speed_m_s);
  if (!walker) return stride;
  const Entity person = *walker;
  std::map<std::string_view, double> before;
  float last_phase = 1;
  int strikes = 0;
  for (int tick = 0; tick < 600 && strikes < 3; ++tick) {
    simulation.tick();
    const float phase = (*simulation.get<Feet>(person)).phase[Side::right];
    strikes += phase < last_phase ? 1 : 0;
    last_phase = phase;
    std::vector<SharingMember> leg;
    for (const MuscleRef& own : simulation.muscles(person)) {
      const Entity entity = own.entity[Side::right];
      const auto tendon = *simulation.get<Musculotendon>(entity);
      const auto arms = *simulation.get<LineMotion>(entity);
      std::array<float, 5> design{};
      EXPECT_EQ(simulation.world().get_field<MemberDesignField>(entity, design), Status::ok);
      const double m = tendon.fibre_m / design[0], cos = std::cos(tendon.pennation_rad);
      double& was = before.try_emplace(muscle_name(own.muscle), m).first->second;
      const double v = (m - was) / (10 * simulation.tick_s());
      was = m;
      leg.push_back({design[4] * design[0] / 30e4,
                     design[4] * test::hill_active(m) * test::hill_at_speed(v) * cos,
                     design[4] * (test::hill_passive(m) + 0.1 * v) * cos,
                     {-arms.hip_flexion_arm_m, -arms.knee_flexion_arm_m, -arms.ankle_dorsiflexion_arm_m}});
    }
    if (strikes != 2) continue;
    const auto moments = *simulation.get<JointMoments>(person);
    const Vector3d asked(moments.hip_nm[Side::right], moments.knee_nm[Side::right], moments.ankle_nm[Side::right]);
    const auto shared = share_moments(leg, asked, missing_at_the_hip);
    stride.moment_nm.push_back(asked);
    stride.reserve_nm.push_back(shared.reserve_nm);
    std::size_t i = 0;
    for (const MuscleRef& own : simulation.muscles(person)) {
      Curve& curve = stride.muscle[muscle_name(own.muscle)];
      curve.asked.push_back(shared.activation[i++]);
      curve.excited.push_back((*simulation.get<Activation>(own.entity[Side::right])).activation);
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

/// Compares two independent methods that share only the fibres' state: people's measured excitation, and the
/// activations that the walk's moments require. Knee and ankle have all their muscles, so no moment remains there.
TEST(MuscleSharing, WalkMomentsGiveMeasuredActivations) {
  for (const float speed : {0.9F, 1.39F, 1.8F}) {
    const Stride stride = walk(speed);
    ASSERT_GT(stride.moment_nm.size(), 30U);
    for (std::size_t t = 0; t < stride.reserve_nm.size(); ++t) {
      EXPECT_LT(std::abs(stride.reserve_nm[t][1]), 2);
      EXPECT_LT(std::abs(stride.reserve_nm[t][2]), 4) << "of 130 N m";
    }
    const std::map<std::string_view, double> least = {
        {"soleus", 0.55}, {"gastrocnemius_medial", 0.6}, {"gastrocnemius_lateral", 0.6}, {"vastus_lateralis", 0.3}};
    for (const auto& [name, r] : least) {
      const Curve& curve = stride.muscle.at(name);
      EXPECT_GT(correlation(curve.asked, curve.excited), r) << name << " at " << speed;
      const double asked = *std::ranges::max_element(curve.asked), excited = *std::ranges::max_element(curve.excited);
      EXPECT_LT(asked, 1.5 * excited) << name;
      EXPECT_GT(asked, 0.65 * excited) << name;
    }
  }
}

}  // namespace
}  // namespace mobil::muscle_sharing_test
