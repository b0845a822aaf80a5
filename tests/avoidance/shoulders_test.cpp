// Shoulder rotation of people who pass in a narrow place.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <mobil/components/avoidance.h>
#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/components/pose.h>
#include <mobil/engine/geometry.h>
#include <mobil/rows.h>
#include <mobil/simulation.h>
#include <mobil/systems/poses/roots.h>
#include "assets/body/joint_limits.h"
#include "systems/gait/shoulders.h"
#include "tests/avoidance/room.h"
#include "tests/avoidance/walkers.h"
#include "tests/interfaces.h"

namespace mobil {
namespace {

using geometry::product;
using geometry::rotated;

Quat<float> inverse(const Quat<float>& q) {
  return {-q.x, -q.y, -q.z, q.w};
}

/// Returns the rotation about the vertical, rad, of a rotation whose axis is nearly vertical.
float yaw(const Quat<float>& q) {
  return 2 * std::atan2(q.y, q.w);
}

Pose<float> turned(const Pose<float>& pose, float by_rad) {
  auto block = broadcast(pose);
  turn_shoulders(in_every_lane<Lanes<float>>(by_rad), block);
  return first_lane(block);
}

TEST(Shoulders, TurnAgainstThePelvisWhileTheHeadFacesAhead) {
  Simulation simulation;
  const Entity one = walker(simulation, 1.2F, 3, -2, 0.7F);
  simulation.tick(40);
  const Pose<float> before = *simulation.get<Pose>(one);
  for (const float by : {-max_shoulder_turn, -0.1F, 0.02F, 0.3F, max_shoulder_turn}) {
    const Pose<float> after = turned(before, by);
    const auto made = [&](Segment s) {
      return yaw(product(after.rotation[index(s)], inverse(before.rotation[index(s)])));
    };
    EXPECT_NEAR(made(Segment::T1), by, 1e-5F);
    EXPECT_NEAR(made(Segment::hand_left), by, 1e-5F);
    EXPECT_NEAR(made(Segment::head), 0, 1e-5F);
    for (std::size_t s = 0; s < segment_count; ++s) {
      const std::size_t parent = index(segment_parent[s]);
      if (s == parent) continue;
      // Each segment keeps its position on its parent.
      const auto place_on = [&](const Pose<float>& pose) {
        const Vec3<float>&a = pose.position_m[s], b = pose.position_m[parent];
        return rotated(inverse(pose.rotation[parent]), {a.x - b.x, a.y - b.y, a.z - b.z});
      };
      const Vec3<float> was = place_on(before), is = place_on(after);
      EXPECT_NEAR(std::hypot(is.x - was.x, is.y - was.y, is.z - was.z), 0, 2e-6F) << s;
    }
    for (const Segment legs : {Segment::pelvis, Segment::thigh_left, Segment::foot_right, Segment::toes_left}) {
      EXPECT_EQ(after.position_m[index(legs)].x, before.position_m[index(legs)].x);
      EXPECT_EQ(after.rotation[index(legs)].y, before.rotation[index(legs)].y);
    }
  }
}

TEST(Shoulders, SpinalJointsKeepTheirLimits) {
  Simulation simulation;
  const Entity one = walker(simulation, 0);
  simulation.tick();
  const Pose<float> pose = turned(*simulation.get<Pose>(one), max_shoulder_turn);
  for (std::size_t i = 0; i < vertebra_limits.size(); ++i) {
    const std::size_t s = index(Segment::L5) + i, parent = index(segment_parent[s]);
    const float turn = yaw(product(inverse(pose.rotation[parent]), pose.rotation[s]));
    EXPECT_LT(std::fabs(turn) * 180 / std::numbers::pi, vertebra_limits[i].rotation) << s;
  }
}

TEST(Shoulders, EaseIndependentOfTickLength) {
  const auto after = [](float every_s, float seconds) {
    AvoidanceState<Lanes<float>> course{};
    course.turn_to_rad = in_every_lane<Lanes<float>>(0.6F);
    for (int k = 0; k < static_cast<int>(std::lround(seconds / every_s)); ++k) ease_shoulders(course, every_s);
    return course.turn_rad[5];
  };
  for (const float seconds : {0.1F, 0.3F, 0.8F}) {
    EXPECT_NEAR(after(1.0F / 60, seconds), after(1.0F / 240, seconds), 1e-4F);
    EXPECT_NEAR(after(1.0F / 60, seconds), 0.6 - 0.6 * (1 + 8 * seconds) * std::exp(-8 * seconds), 1e-4);
  }
  EXPECT_EQ(after(1.0F / 60, 3), 0.6F) << "there, and still";
}

/// A cross-section of a body: its centre, heading, half-width and half-depth.
struct Section {
  double x_m, z_m, faces_rad, broad_m, deep_m;

  double reach(double x, double z) const {
    const double ahead = x * std::sin(faces_rad) + z * std::cos(faces_rad);
    const double aside = x * std::cos(faces_rad) - z * std::sin(faces_rad);
    return std::hypot(broad_m * aside, deep_m * ahead);
  }
};

TEST(Shoulders, TurnWhenPassingInANarrowPassage) {
  Avoiders all;
  const Simulation& simulation = all.simulation;
  const Wall walls[] = {{{-0.45F, -30}, {-0.45F, 30}}, {{0.45F, -30}, {0.45F, 30}}};
  ASSERT_TRUE(all.avoidance.set_walls(walls));
  const Entity who[] = {all.come(1.2F, 0.1F, -5.0F), all.come(1.2F, -0.1F, 5.0F, pi)};
  float most = 0;
  double overlap = 0;
  for (int k = 0; k < 60 * 30; ++k) {
    all.run();
    Root at[2];
    ASSERT_TRUE(simulation.roots(who, at));
    const double x = at[1].x_m - at[0].x_m, z = at[1].z_m - at[0].z_m, apart = std::hypot(x, z);
    double together = 0;
    for (int i = 0; i < 2; ++i) {
      const AvoidanceState<float> course = *simulation.get<AvoidanceState>(who[i]);
      most = std::max(most, std::fabs(course.turn_rad));
      const Section shoulders = {at[i].x_m, at[i].z_m, double{at[i].heading_rad} + double{course.turn_rad},
                                 double{course.shoulders_m}, 0.58 * double{course.shoulders_m}};
      together += shoulders.reach(x / apart, z / apart);
    }
    overlap = std::max(overlap, together - apart);
  }
  EXPECT_GT(root_of(simulation, who[0]).z_m, 4) << "they passed";
  EXPECT_LT(root_of(simulation, who[1]).z_m, -4);
  EXPECT_GT(most, 0.4F);
  EXPECT_LT(overlap, 0.05);
  for (const Entity one : who) EXPECT_EQ(simulation.get<AvoidanceState>(one)->turn_rad, 0) << "and turned back";
}

/// Widths and depths of chests and hips relative to height: means of the 1986 women of ANSUR II (Gordon et al. 2014).
TEST(Shoulders, TrunksOverlapByLessThanSixCentimetres) {
  Room room(1, 60, 6);
  const auto section = [&](Entity one, Segment at, double breadth, double depth) {
    const Pose<float> pose = *room.simulation.get<Pose>(one);
    const double height = double{room.simulation.get<BodySize>(one)->height_m};
    return Section{double{pose.position_m[index(at)].x}, double{pose.position_m[index(at)].z},
                   double{yaw(pose.rotation[index(at)])}, breadth * height / 2, depth * height / 2};
  };
  double overlap = -1;
  for (int k = 0; k < 60 * 60; ++k) {
    room.tick();
    if (k % 6 != 0) continue;
    std::vector<Section> chests, hips;
    for (const Entity one : room.who) {
      chests.push_back(section(one, Segment::T8, 0.166, 0.155));
      hips.push_back(section(one, Segment::pelvis, 0.218, 0.144));
    }
    for (const auto* sections : {&chests, &hips}) {
      for (std::size_t i = 0; i < sections->size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
          const Section &a = (*sections)[i], &b = (*sections)[j];
          const double x = b.x_m - a.x_m, z = b.z_m - a.z_m, apart = std::hypot(x, z);
          if (apart > 1) continue;
          overlap = std::max(overlap, a.reach(x / apart, z / apart) + b.reach(x / apart, z / apart) - apart);
        }
      }
    }
  }
  EXPECT_LT(overlap, 0.06);
  EXPECT_GT(overlap, -0.1) << "they do come near";
}

TEST(Shoulders, NoTurnWhereRadiusIsShoulderHalfWidth) {
  Simulation simulation;
  Avoidance avoidance = avoidance_of(simulation, {.radius_h = 0.128F});
  const Entity who[] = {walker(simulation, 1.2F, 0.1F, -5, 0), walker(simulation, 1.2F, -0.1F, 5, pi),
                        walker(simulation, 0, 20), walker(simulation, 0, 20.3F)};  // two who stand too near
  for (const Entity one : who) ASSERT_TRUE(avoidance.manage(one));
  for (int k = 0; k < 600; ++k) {
    simulation.tick();
    for (const Entity one : who) ASSERT_EQ(simulation.get<AvoidanceState>(one)->turn_rad, 0);
  }
}

/// Two people who stand so near that they have turned their shoulders.
struct NearPair : Avoiders {
  NearPair() {
    run(90);
    EXPECT_GT(std::fabs(turned_rad()), 0.4F);
  }
  float turned_rad() const { return simulation.get<AvoidanceState>(who[0])->turn_rad; }
  float chest_rad() const { return yaw(simulation.get<Pose>(who[0])->rotation[index(Segment::T1)]); }

  const Entity who[2] = {come(0), come(0, 0.36F)};
};

TEST(Shoulders, PlacedPeopleFaceTheirHeading) {
  NearPair pair;
  ASSERT_TRUE(pair.simulation.place(pair.who[0], 20, 0, 0));
  EXPECT_EQ(pair.turned_rad(), 0);
  EXPECT_NEAR(pair.chest_rad(), 0, 0.02F);
}

TEST(Shoulders, StayTurnedWhenCompactAndWhenManagedAgain) {
  NearPair pair;
  const float before = pair.chest_rad();
  ASSERT_TRUE(pair.simulation.set_state({&pair.who[0], 1}, PersonState::compact));
  EXPECT_NEAR(pair.chest_rad(), before, 1e-5F);
  ASSERT_TRUE(pair.simulation.set_state({&pair.who[0], 1}, PersonState::full));
  EXPECT_NEAR(pair.chest_rad(), before, 1e-5F);
  const float turned = pair.turned_rad();
  ASSERT_TRUE(pair.avoidance.manage(pair.who[0]));
  EXPECT_EQ(pair.turned_rad(), turned);
}

TEST(Shoulders, SleepersWakeFacingTheirHeading) {
  NearPair pair;
  ASSERT_EQ(pair.simulation.set_state({&pair.who[0], 1}, PersonState::asleep).value(), 1U);
  pair.simulation.tick(10);
  ASSERT_TRUE(pair.simulation.set_state({&pair.who[0], 1}, PersonState::full));
  EXPECT_NEAR(pair.chest_rad(), 0, 0.02F);
  pair.simulation.tick();
  EXPECT_NEAR(pair.chest_rad(), 0, 0.02F);
}

TEST(Shoulders, UnmanagedPeopleGetTheFullWidth) {
  Avoiders all;
  const Entity stands = walker(all.simulation, 0, 0.05F), comes = all.come(1.2F, 0.0F, -5.0F);
  double nearest = 9;
  for (int k = 0; k < 900; ++k) {
    all.run();
    nearest = std::min(nearest, all.apart_m(stands, comes));
  }
  EXPECT_GT(all.root(comes).z_m, 3);
  EXPECT_GT(nearest, 2 * 0.128 * 1.72 - 0.035);
}

}  // namespace
}  // namespace mobil
