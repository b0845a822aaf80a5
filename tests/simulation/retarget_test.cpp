// Game skeletons that drive people: made from walkers, whose pose must be recovered.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

#include <mobil/engine/geometry.h>
#include <mobil/retarget.h>
#include <mobil/simulation.h>
#include <mobil/systems/muscles/person.h>
#include "systems/poses/pose_axes.h"
#include "tests/refused.h"
#include "tests/simulation/leg_muscles.h"

namespace mobil::retarget_test {
using namespace geometry;
using enum Segment;

/// Segments of the bones of a game's skeleton of 22, whose spine has three bones and a neck, by number:
///
///                                 5 head
///                                 4
///     hand 9 --- 8 --- 7 --- 6 -- 3 -- 14 --- 15 --- 16 --- 17 hand
///     right                       2                         left
///                                 1
///             thigh 10 ---------- 0 ---------- 18 thigh; 11 to 13 and 19 to 21: shank, foot, toes
constexpr std::array carried = {
    pelvis,        L3,         T10,         T4,          C5,         head,       clavicle_right, upper_arm_right,
    forearm_right, hand_right, thigh_right, shank_right, foot_right, toes_right, clavicle_left,  upper_arm_left,
    forearm_left,  hand_left,  thigh_left,  shank_left,  foot_left,  toes_left};

SkeletonBones numbers() {
  SkeletonBones bones;
  bones.pelvis = 0;
  bones.spine = {1, 2, 3, 4};
  bones.head = 5;
  for (const Side side : {Side::right, Side::left}) {
    const std::int32_t first = 6 + 8 * static_cast<std::int32_t>(side);
    bones.limbs[side] = {first + 4, first + 5, first + 6, first + 7, first, first + 1, first + 2, first + 3};
  }
  return bones;
}

/// Returns random axes for each bone.
std::vector<Quat<float>> odd_axes() {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::vector<Quat<float>> all;
  for (std::size_t i = 0; i < carried.size(); ++i) {
    Quat<double> q{normal(random), normal(random), normal(random), normal(random)};
    const double part = 1 / std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    all.push_back(to_float(Quat<double>{part * q.x, part * q.y, part * q.z, part * q.w}));
  }
  return all;
}

BonePlace in_axes(const BoneUnits& units, const Vec3<float>& at, const Quat<float>& turn) {
  const AxisMap& map = axes_of[static_cast<std::size_t>(units.axes)];
  const float place[3] = {at.x, at.y, at.z}, axis[3] = {turn.x, turn.y, turn.z};
  float p[3], q[3];
  for (std::size_t i = 0; i < 3; ++i) {
    p[i] = map.sign[i] * units.units_per_m * place[map.ours[i]];
    q[i] = map.sign[i] * map.mirrored() * axis[map.ours[i]];
  }
  return {{p[0], p[1], p[2]}, {q[0], q[1], q[2], turn.w}};
}

std::vector<BonePlace> bones_of(const Pose<float>& pose, const BoneUnits& units) {
  const std::vector<Quat<float>> own = odd_axes();
  std::vector<BonePlace> bones;
  for (std::size_t b = 0; b < carried.size(); ++b) {
    const std::size_t s = index(carried[b]);
    bones.push_back(in_axes(units, pose.position_m[s], product(pose.rotation[s], own[b])));
  }
  return bones;
}

/// Returns a pose with the arms sideways, turned and moved as a whole.
Pose<float> t_pose(const Body& body) {
  const float half = std::sqrt(0.5F);
  const Quat<float> facing{0, std::sin(0.6F), 0, std::cos(0.6F)};
  Pose<float> pose;
  for (std::size_t s = 0; s < segment_count; ++s) {
    const bool right_arm = s > index(clavicle_right) && s<index(clavicle_left), left_arm = s> index(clavicle_left);
    const Quat<float> own = right_arm  ? Quat<float>{0, 0, -half, half}
                            : left_arm ? Quat<float>{0, 0, half, half}
                                       : Quat<float>{0, 0, 0, 1};
    pose.rotation[s] = product(facing, own);
    const std::size_t parent = index(segment_parent[s]);
    const Vec3<float> offset = body.joint_offset_m[s];
    pose.position_m[s] =
        s == 0 ? Vec3<float>{3, offset.y, -2} : pose.position_m[parent] + rotated(pose.rotation[parent], offset);
  }
  return pose;
}

/// Returns the angle between two rotations, degrees.
double apart_deg(const Quat<float>& a, const Quat<float>& b) {
  const Quat<double> between = product(conjugate(to_double(a)), to_double(b));
  return 2 * std::atan2(length(Vec{between.x, between.y, between.z}), std::abs(between.w)) * 180 / M_PI;
}

TEST(Retarget, WalkersBonesGiveTheWalkersPose) {
  for (const PoseAxes axes : {PoseAxes::y_up, PoseAxes::y_up_left_handed, PoseAxes::z_up, PoseAxes::z_up_left_handed,
                              PoseAxes::y_up_z_back}) {
    const BoneUnits units{axes, axes == PoseAxes::y_up ? 1.0F : 100.0F};
    Simulation walking(sharing()), posed(sharing());
    const Entity walker = *walking.spawn(sample_person(1).body, {.speed_m_s = 1.3F});
    const Entity puppet = *posed.spawn_posed(sample_person(1).body);
    const auto map = Retarget::make(posed.person(puppet)->body, numbers(),
                                    bones_of(t_pose(posed.person(puppet)->body), units), units);
    ASSERT_TRUE(map) << map.error().message;
    ASSERT_TRUE(walking.set_muscles(walker));
    ASSERT_TRUE(posed.set_muscles(puppet));
    ASSERT_TRUE(walking.turn_to(walker, 0.8F));
    for (int tick = 0; tick < 90; ++tick) {
      walking.tick();
      const auto was = *walking.get<Pose>(walker);
      const auto pose = map->pose(bones_of(was, units));
      ASSERT_TRUE(pose) << pose.error().message;
      ASSERT_EQ(posed.set_pose(puppet, *pose), Status::ok);
      posed.tick();
      for (std::size_t s = 0; s < segment_count; ++s) {
        const bool leg = s >= index(thigh_right) && s <= index(toes_left);
        const bool arm = s >= index(clavicle_right) && s != index(fingers_right) && s != index(thumb_right) &&
                         s != index(fingers_left) && s != index(thumb_left);
        const bool followed = leg || arm || s == 0 || s == index(head);
        // A walker's lowest vertebrae are upright on a tilting pelvis. Fingers have no bones here.
        const double allowed_deg = followed ? 0.1 : s < index(thigh_right) ? 12 : 90;
        EXPECT_LT(apart_deg(pose->rotation[s], was.rotation[s]), allowed_deg) << segment_name[s];
        const double off_m = length(to_double(pose->position_m[s]) - to_double(was.position_m[s]));
        EXPECT_LT(off_m, leg || s == 0 ? 2e-4 : 0.04) << segment_name[s] << " at tick " << tick;
      }
      for (std::size_t m = 0; m < usual_muscle_count; ++m) {
        for (const Side side : {Side::right, Side::left}) {
          const auto of = [&](const Simulation& simulation, Entity person) {
            return simulation.get<LineOfAction>(simulation.muscle(person, static_cast<Muscle>(m), side))->length_m;
          };
          EXPECT_NEAR(of(posed, puppet), of(walking, walker), 3e-4F) << muscle_name(static_cast<Muscle>(m));
        }
      }
      if (HasFailure()) return;
    }
  }
}

/// Joint angles, soles and centre of mass computed from a pose match those of walkers.
TEST(Retarget, PosedPeopleHaveAnglesSolesAndACentreOfMass) {
  Simulation walking(sharing()), posed(sharing());
  // Shorter steps than the usual ones, in which no leg is stretched to its length.
  const Entity walker = *walking.spawn(sample_person(2).body, {.speed_m_s = 1.3F, .step_length_m = 0.6F});
  const Entity puppet = *posed.spawn_posed(sample_person(2).body);
  constexpr float degree = 0.01745F;
  for (int tick = 0; tick < 90; ++tick) {
    walking.tick();
    ASSERT_EQ(posed.set_pose(puppet, *walking.get<Pose>(walker)), Status::ok);
    posed.tick();
    const auto theirs = *walking.get<JointAngles>(walker), own = *posed.get<JointAngles>(puppet);
    EXPECT_NEAR(own.pelvis_list, theirs.pelvis_list, 0.01F * degree);
    EXPECT_NEAR(own.pelvis_tilt, theirs.pelvis_tilt, 0.01F * degree);
    const auto soles = *walking.get<Feet>(walker), own_soles = *posed.get<Feet>(puppet);
    for (const Side side : {Side::right, Side::left}) {
      EXPECT_NEAR(own.hip_flexion[side], theirs.hip_flexion[side], 1 * degree);
      EXPECT_NEAR(own.knee_flexion[side], theirs.knee_flexion[side], 0.1F * degree);
      EXPECT_NEAR(own.ankle_dorsiflexion[side], theirs.ankle_dorsiflexion[side], 2 * degree);
      EXPECT_NEAR(own.elbow_flexion[side], theirs.elbow_flexion[side], 2 * degree);
      const Vec3<float> all[][2] = {{own_soles.heel_m[side], soles.heel_m[side]},
                                    {own_soles.toe_m[side], soles.toe_m[side]},
                                    {own_soles.tip_m[side], soles.tip_m[side]}};
      for (const auto& [a, b] : all) EXPECT_LT(length(to_double(a) - to_double(b)), 1e-5);
    }
    const auto centre = *posed.get<CentreOfMass>(puppet), other = *walking.get<CentreOfMass>(walker);
    EXPECT_LT(length(to_double(centre.position_m) - to_double(other.position_m)), 1e-6);
  }
}

TEST(Retarget, InvalidSkeletonsAreRefused) {
  Simulation simulation(sharing());
  const Body body = simulation.person(*simulation.spawn_posed({}))->body;
  const std::vector<BonePlace> rest = bones_of(t_pose(body), {});
  const auto says = [&](const SkeletonBones& bones, const std::vector<BonePlace>& at, const char* what,
                        const BoneUnits& units = {}) {
    EXPECT_TRUE(is_refused(Retarget::make(body, bones, at, units), what)) << what;
  };
  const auto with = [](auto change) {
    SkeletonBones bones = numbers();
    change(bones);
    return bones;
  };
  says(with([](SkeletonBones& b) { b.pelvis = SkeletonBones::no_bone; }), rest, "pelvis");
  says(with([](SkeletonBones& b) { b.spine.clear(); }), rest, "spine");
  says(with([](SkeletonBones& b) { b.limbs[Side::left].foot = SkeletonBones::no_bone; }), rest, "foot");
  says(with([](SkeletonBones& b) { b.limbs[Side::left].foot = 99; }), rest, "none of the 22");
  says(with([](SkeletonBones& b) { b.limbs[Side::left].foot = b.pelvis; }), rest, "twice");
  says(with([](SkeletonBones& b) { b.limbs[Side::right].forearm = SkeletonBones::no_bone; }), rest, "name both");
  std::vector<BonePlace> wrong = rest;
  wrong[12].position.x = std::numeric_limits<float>::quiet_NaN();
  says(numbers(), wrong, "bone 12");
  wrong = rest;
  wrong[3].rotation.w += 1;
  says(numbers(), wrong, "bone 3");
  wrong = rest;
  wrong[11].position = wrong[10].position;
  says(numbers(), wrong, "leg has no length");
  wrong = rest;
  wrong[18].position = wrong[10].position;
  says(numbers(), wrong, "upon each other");
  says(numbers(), rest, "units_per_m", {PoseAxes::y_up, 0});

  const auto map = Retarget::make(body, numbers(), rest);
  ASSERT_TRUE(map);
  EXPECT_FALSE(map->pose(std::vector<BonePlace>(rest.begin(), rest.end() - 1)));
  std::vector<BonePlace> now = rest;
  now[7].rotation = {0, 0, 0, std::numeric_limits<float>::infinity()};
  EXPECT_TRUE(is_refused(map->pose(now), "bone 7"));
}

/// A game without arms, toes or head bones, and with a single bone of the spine.
TEST(Retarget, FewBonesSuffice) {
  Simulation simulation(sharing());
  const Entity puppet = *simulation.spawn_posed({});
  const Body body = simulation.person(puppet)->body;
  const std::vector<BonePlace> rest = bones_of(t_pose(body), {});
  SkeletonBones few;
  few.pelvis = 0;
  few.spine = {2};
  for (const Side side : {Side::right, Side::left}) {
    const SkeletonBones::Limbs all = numbers().limbs[side];
    few.limbs[side] = {all.thigh, all.shank, all.foot};
  }
  const auto map = Retarget::make(body, few, rest);
  ASSERT_TRUE(map) << map.error().message;
  const auto pose = map->pose(rest);
  ASSERT_TRUE(pose);
  EXPECT_EQ(simulation.set_pose(puppet, *pose), Status::ok);
  for (std::size_t s = 0; s < segment_count; ++s)
    EXPECT_LT(apart_deg(pose->rotation[s], pose->rotation[0]), 0.01) << segment_name[s];
}

}  // namespace mobil::retarget_test
