// Posed people with custom limb lengths: bones, muscles, masses and surfaces follow.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/assets/muscles/muscle_plan.h>
#include <mobil/components/leg_frames.h>
#include <mobil/engine/geometry.h>
#include <mobil/engine/world.h>
#include <mobil/retarget.h>
#include <mobil/surfaces.h>
#include <mobil/systems/muscles/person.h>
#include <mobil/systems/snapshot/restore_limits.h>
#include "tests/refused.h"
#include "tests/simulation/leg_muscles.h"

namespace mobil::limbs_test {
using namespace geometry;
using enum Segment;

constexpr float degree = 0.0174532925F;

/// Returns a body with limbs `factor` times as long as usual for its stature.
BodyRequest long_limbed(float thigh, float shank, float upper_arm = 1, float forearm = 1) {
  BodyRequest request{.height_m = 1.75F, .mass_kg = 72};
  const LimbLengths<float> usual = limb_lengths(*make_body(request));
  request.limbs = {thigh * usual.thigh_m, shank * usual.shank_m, upper_arm * usual.upper_arm_m,
                   forearm * usual.forearm_m};
  return request;
}

TEST(Limbs, HaveTheRequestedLengthsAndMoveDistalSegments) {
  const BodyRequest asked = long_limbed(1.15F, 0.9F, 1.2F, 1.1F);
  BodyRequest plain = asked;
  plain.limbs = {};
  const auto body = make_body(asked), usual = make_body(plain);
  ASSERT_TRUE(body) << body.error().message;
  const LimbLengths<float> limbs = limb_lengths(*body);
  EXPECT_EQ(limbs.thigh_m, asked.limbs.thigh_m);
  EXPECT_EQ(limbs.forearm_m, asked.limbs.forearm_m);
  EXPECT_EQ(body->thigh_length_m, asked.limbs.thigh_m);
  const Pose<float> stands = standing_pose(*body), stood = standing_pose(*usual);
  for (const std::size_t side : {std::size_t{Side::right}, std::size_t{Side::left}}) {
    const auto at = [&](const Pose<float>& pose, Segment s) { return pose.position_m[index(on_side(s, side))]; };
    EXPECT_NEAR(at(stands, thigh_right).y - at(stands, shank_right).y, asked.limbs.thigh_m, 1e-6F);
    EXPECT_NEAR(at(stands, shank_right).y - at(stands, foot_right).y, asked.limbs.shank_m, 1e-6F);
    EXPECT_NEAR(at(stands, upper_arm_right).y - at(stands, forearm_right).y, asked.limbs.upper_arm_m, 1e-6F);
    EXPECT_NEAR(at(stands, forearm_right).y - at(stands, hand_right).y, asked.limbs.forearm_m, 1e-6F);
    // The sole stays on the ground and the kneecap at its knee.
    EXPECT_NEAR(at(stands, foot_right).y, at(stood, foot_right).y, 1e-6F);
    EXPECT_NEAR(at(stands, patella_right).y - at(stands, shank_right).y,
                at(stood, patella_right).y - at(stood, shank_right).y, 1e-6F);
  }
  double mass = 0;
  for (const float kg : body->mass_kg) mass += static_cast<double>(kg);
  EXPECT_EQ(mass, static_cast<double>(asked.mass_kg));
}

TEST(Limbs, OutOfRangeOrForWalkersAreRefused) {
  Simulation simulation(sharing());
  const auto says = [&](const BodyRequest& body, const char* what) {
    EXPECT_TRUE(is_refused(simulation.spawn_posed(body), what)) << what;
  };
  says(long_limbed(1.7F, 1), "thigh");
  says(long_limbed(1, 0.5F), "shank");
  says(long_limbed(1, 1, 3), "upper arm");
  BodyRequest no_number = long_limbed(1, 1);
  no_number.limbs.forearm_m = std::numeric_limits<float>::quiet_NaN();
  says(no_number, "forearm");
  EXPECT_TRUE(is_refused(simulation.spawn(long_limbed(1.1F, 1)), "spawn_posed"));
  EXPECT_TRUE(simulation.people().empty());
}

/// Returns a pose with bent hips and knees and raised arms.
Pose<float> crouching(const Body& body, float hip_deg, float knee_deg) {
  Pose<float> pose;
  const auto about_x = [](float deg) {
    return Quat<float>{std::sin(0.5F * degree * deg), 0, 0, std::cos(0.5F * degree * deg)};
  };
  for (std::size_t s = 0; s < segment_count; ++s) {
    const std::size_t parent = index(segment_parent[s]);
    const auto is = [s](Segment r) { return s == index(r) || s == index(on_side(r, Side::left)); };
    const float turn = is(thigh_right) ? -hip_deg : is(shank_right) ? knee_deg : is(upper_arm_right) ? -40.0F : 0.0F;
    if (s == parent) {
      pose.rotation[s] = {0, 0, 0, 1};
      pose.position_m[s] = body.joint_offset_m[s];
      continue;
    }
    pose.rotation[s] = product(pose.rotation[parent], about_x(turn));
    pose.position_m[s] = pose.position_m[parent] + rotated(pose.rotation[parent], body.joint_offset_m[s]);
  }
  return pose;
}

/// Without the lengths, muscles would be stretched by the additional bone length.
TEST(Limbs, MusclesAreAtRestOnTheirBones) {
  for (const float factor : {0.85F, 1.15F, 1.4F}) {
    Simulation simulation(sharing());
    const BodyRequest own = long_limbed(factor, factor);
    const Entity knows = *simulation.spawn_posed(own);
    BodyRequest plain = own;
    plain.limbs = {};
    const Entity does_not = *simulation.spawn_posed(plain);
    const Pose<float> pose = crouching(simulation.person(knows)->body, 0, 0);
    double max_mm = 0;
    for (const Entity person : {knows, does_not}) {
      ASSERT_EQ(simulation.set_pose(person, pose), Status::ok);
      ASSERT_TRUE(simulation.set_muscles(person, {.muscles = muscle_members()}));
      simulation.tick();
      for (const Entity muscle : muscles_of(simulation, person)) {
        const auto line = *simulation.get<LineOfAction>(muscle);
        const double off_mm = 1000 * std::abs(static_cast<double>(line.length_m - line.rest_length_m));
        if (person == does_not) {
          max_mm = std::max(max_mm, off_mm);
        } else {
          EXPECT_LT(off_mm, 0.01);
        }
      }
    }
    EXPECT_GT(max_mm, 50) << factor;
  }
}

/// Longer bones are not thicker, and pelvis and feet are not larger. The attachments of muscles follow.
TEST(Limbs, TransverseSizesFollowTheHeight) {
  Simulation simulation(sharing());
  const BodyRequest own = long_limbed(1.3F, 1.2F);
  BodyRequest plain = own;
  plain.limbs = {};
  std::vector<LegScale<float>> scale;
  std::vector<Person> people;
  for (const BodyRequest& body : {own, plain}) {
    const Entity person = *simulation.spawn_posed(body);
    ASSERT_TRUE(simulation.set_muscles(person));
    scale.push_back(*simulation.get<LegScale>(simulation.muscle(person, Muscle::hamstrings, Side::right)));
    people.push_back(*simulation.person(person));
  }
  EXPECT_NEAR(scale[0].across, scale[1].across, 1e-6F);
  EXPECT_NEAR(scale[0].thigh, 1.3F * scale[1].thigh, 1e-5F);
  EXPECT_NEAR(scale[0].shank, 1.2F * scale[1].shank, 1e-5F);
  // The hamstrings start on the pelvis, at the same distance from the hip in both bodies.
  const auto from_hip = [](const Person& person) {
    const Pose<float> pose = standing_pose(person.body);
    const auto made = *make_muscle_plan(person.body, Muscle::hamstrings);
    return length(made.start_m - to_double(pose.position_m[index(thigh_right)]));
  };
  EXPECT_NEAR(from_hip(people[0]), from_hip(people[1]), 0.02);
}

TEST(Limbs, CentreOfMassIsTheBodys) {
  Simulation simulation(sharing());
  const Entity person = *simulation.spawn_posed(long_limbed(1.3F, 0.8F, 1.4F, 1.2F));
  const Body body = simulation.person(person)->body;
  const auto expect = [&](const Pose<float>& pose) {
    Vec3<double> sum{};
    for (std::size_t s = 0; s < segment_count; ++s) {
      const Vec3<double> at =
          to_double(pose.position_m[s]) + rotated(to_double(pose.rotation[s]), to_double(body.centre_of_mass_m[s]));
      sum = sum + (static_cast<double>(body.mass_kg[s]) / static_cast<double>(body.request.mass_kg)) * at;
    }
    const auto centre = to_double(simulation.get<CentreOfMass>(person)->position_m);
    EXPECT_LT(length(centre - sum), 1e-5);
  };
  expect(*simulation.get<Pose>(person));
  for (const float bent : {0.0F, 30.0F, 80.0F}) {
    const Pose<float> pose = crouching(body, bent, 1.5F * bent);
    ASSERT_EQ(simulation.set_pose(person, pose), Status::ok);
    simulation.tick();
    expect(pose);
  }
}

TEST(Limbs, AreKeptBySnapshotsAndReportedByPerson) {
  Simulation simulation(sharing()), other(sharing());
  const BodyRequest asked = long_limbed(1.2F, 1.1F);
  const Entity person = *simulation.spawn_posed(asked);
  ASSERT_TRUE(simulation.set_muscles(person));
  simulation.tick();
  EXPECT_EQ(simulation.person(person)->body.request.limbs.thigh_m, asked.limbs.thigh_m);
  std::vector<std::byte> bytes(simulation.snapshot_bytes());
  ASSERT_TRUE(simulation.save(bytes));
  const auto restored = other.restore(bytes, RestoreLimits::none());
  ASSERT_TRUE(restored) << restored.error().message;
  EXPECT_EQ(other.state_hash(), simulation.state_hash());
  EXPECT_EQ(other.person(person)->body.request.limbs.shank_m, asked.limbs.shank_m);
}

/// Bones of a game's skeleton with other proportions: the joints coincide with the game's.
TEST(Limbs, RetargetedSkeletonKeepsItsJoints) {
  const Body game = *make_body(long_limbed(1.2F, 1.08F, 1.1F, 0.95F));
  constexpr std::array bone = {pelvis,        T10,        head,           thigh_right,  shank_right, foot_right,
                               toes_right,    thigh_left, shank_left,     foot_left,    toes_left,   upper_arm_right,
                               forearm_right, hand_right, upper_arm_left, forearm_left, hand_left};
  SkeletonBones numbers;
  numbers.pelvis = 0;
  numbers.spine = {1};
  numbers.head = 2;
  numbers.limbs[Side::right] = {3, 4, 5, 6, -1, 11, 12, 13};
  numbers.limbs[Side::left] = {7, 8, 9, 10, -1, 14, 15, 16};
  const auto bones_of = [&](const Pose<float>& pose) {
    std::vector<BonePlace> bones;
    for (const Segment s : bone) bones.push_back({pose.position_m[index(s)], pose.rotation[index(s)]});
    return bones;
  };
  const std::vector<BonePlace> rest = bones_of(standing_pose(game));
  const auto limbs = limb_lengths(numbers, rest);
  ASSERT_TRUE(limbs) << limbs.error().message;
  EXPECT_NEAR(limbs->thigh_m, game.request.limbs.thigh_m, 1e-5F);
  EXPECT_NEAR(limbs->forearm_m, game.request.limbs.forearm_m, 1e-5F);
  BodyRequest request{.height_m = 1.75F, .mass_kg = 72, .limbs = *limbs};
  Simulation simulation(sharing());
  const Entity puppet = *simulation.spawn_posed(request);
  const auto map = Retarget::make(simulation.person(puppet)->body, numbers, rest);
  ASSERT_TRUE(map) << map.error().message;
  const Pose<float> now = crouching(game, 50, 70);
  const auto pose = map->pose(bones_of(now));
  ASSERT_TRUE(pose);
  for (const Segment s : {thigh_right, shank_right, foot_right, thigh_left, shank_left, foot_left, toes_left}) {
    EXPECT_LT(length(to_double(pose->position_m[index(s)]) - to_double(now.position_m[index(s)])), 2e-4)
        << segment_name[index(s)];
  }
  SkeletonBones without = numbers;
  without.limbs[Side::left].hand = SkeletonBones::no_bone;
  EXPECT_EQ(limb_lengths(without, rest)->forearm_m, 0);
}

/// Surfaces bound to a usual body, displayed on one with long limbs, compared with surfaces drawn for that body.
TEST(Limbs, SurfacesOfUsualBodiesFit) {
  const Body usual = *make_body({.height_m = 1.70F, .mass_kg = 68});
  Simulation simulation(sharing());
  const Entity puppet = *simulation.spawn_posed(long_limbed(1.15F, 0.92F, 1.1F, 1.2F));
  ASSERT_EQ(simulation.set_pose(puppet, crouching(simulation.person(puppet)->body, 20, 30)), Status::ok);
  ASSERT_TRUE(simulation.set_muscles(puppet));
  simulation.tick();
  const Person person = *simulation.person(puppet);
  std::vector<SurfaceMuscle> muscles;
  for (const PersonMuscle& own : person.muscles) muscles.push_back({own.plan.muscle, own.entity});
  SurfaceWriter writer;
  const auto show = [&](const BodySurfaces& surfaces, const SurfaceFit* fit, std::vector<Vec3<float>>& normal) {
    std::vector<Vec3<float>> position(surfaces.vertices);
    normal.resize(surfaces.vertices);
    const SurfaceRequest request{.person = puppet,
                                 .muscles = muscles,
                                 .surfaces = &surfaces,
                                 .positions = {std::as_writable_bytes(std::span(position))},
                                 .normals = {std::as_writable_bytes(std::span(normal))},
                                 .fit = fit};
    const auto done = writer.write(simulation.world(), {&request, 1});
    EXPECT_TRUE(done) << done.error().message;
    return position;
  };
  const BodySurfaces shared = *bind_surfaces(usual), own = *bind_surfaces(person.body);
  const SurfaceFit fit = fit_surfaces(shared, person.body);
  std::vector<Vec3<float>> normal, own_normal;
  const auto fitted = show(shared, &fit, normal), drawn = show(own, nullptr, own_normal);
  double sum[2] = {}, most[2] = {}, count[2] = {};
  for (const SurfacePart& part : own.part) {
    const std::size_t kind = part.driver ? 1 : 0;
    for (std::uint32_t v = part.first_vertex; v < part.first_vertex + part.vertices; ++v) {
      const auto off = static_cast<double>(length(fitted[v] - drawn[v]));
      sum[kind] += off, count[kind] += 1;
      most[kind] = std::max(most[kind], off);
      EXPECT_NEAR(length(normal[v]), 1, 1e-4) << part.name;
    }
  }
  std::printf("bones off by %.2f mm in the mean, %.1f at most; muscles %.2f and %.1f\n", 1000 * sum[0] / count[0],
              1000 * most[0], 1000 * sum[1] / count[1], 1000 * most[1]);
  EXPECT_LT(sum[0] / count[0], 0.001);
  EXPECT_LT(sum[1] / count[1], 0.005);
  EXPECT_LT(most[1], 0.035);
}

}  // namespace mobil::limbs_test
