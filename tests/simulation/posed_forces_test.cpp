// Ground forces on people animated by their host, computed from poses only.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include <mobil/engine/geometry.h>
#include <mobil/forces.h>
#include <mobil/systems/snapshot/restore_limits.h>
#include "tests/simulation/leg_muscles.h"

namespace mobil::posed_forces_test {
using geometry::operator-;

constexpr float gravity = 9.81F;

/// Root mean square of a difference, absolute and relative to the reference.
struct Apart {
  double square = 0, whole = 0, count = 0;
  void add(float is, float should) {
    const auto off = static_cast<double>(is - should), all = static_cast<double>(should);
    square += off * off, whole += all * all, count += 1;
  }
  double rms() const { return std::sqrt(square / count); }
  double of_whole() const { return std::sqrt(square / whole); }
};

Pose<float> moved(Pose<float> pose, const Vec3<float>& by) {
  for (Vec3<float>& at : pose.position_m) at = {at.x + by.x, at.y + by.y, at.z + by.z};
  return pose;
}

/// A walker's forces follow from the step; the puppet's from its observed motion, a tick later.
TEST(PosedForces, WalkersPosesGiveTheWalkersForces) {
  for (const float speed : {0.9F, 1.3F, 1.8F}) {
    Simulation walking, posed;
    const SamplePerson who = sample_person(1);
    const Entity walker = *walking.spawn(who.body, {.speed_m_s = speed});
    const Entity puppet = *posed.spawn_posed(who.body);
    ASSERT_EQ(walking.enable(walker, Feature::forces), Status::ok);
    ASSERT_EQ(posed.enable(puppet, Feature::forces), Status::ok);
    const float weight = who.body.mass_kg * gravity;
    Apart up, ahead, hip, knee, ankle, centre, total;
    for (int tick = 0; tick < 240; ++tick) {
      const auto ground = *walking.get<GroundReaction>(walker);
      const auto moments = *walking.get<JointMoments>(walker);
      walking.tick();
      ASSERT_EQ(posed.set_pose(puppet, *walking.get<Pose>(walker)), Status::ok);
      posed.tick();
      if (tick < 60) continue;
      const auto seen = *posed.get<GroundReaction>(puppet);
      const auto felt = *posed.get<JointMoments>(puppet);
      total.add((seen.force_n[Side::right].y + seen.force_n[Side::left].y) / weight,
                (ground.force_n[Side::right].y + ground.force_n[Side::left].y) / weight);
      for (const Side side : {Side::right, Side::left}) {
        up.add(seen.force_n[side].y / weight, ground.force_n[side].y / weight);
        ahead.add(seen.force_n[side].z / weight, ground.force_n[side].z / weight);
        hip.add(felt.hip_nm[side] / who.body.mass_kg, moments.hip_nm[side] / who.body.mass_kg);
        knee.add(felt.knee_nm[side] / who.body.mass_kg, moments.knee_nm[side] / who.body.mass_kg);
        ankle.add(felt.ankle_nm[side] / who.body.mass_kg, moments.ankle_nm[side] / who.body.mass_kg);
        if (ground.force_n[side].y > 0.3F * weight && seen.force_n[side].y > 0.3F * weight)
          centre.add(seen.centre_m[side].z, ground.centre_m[side].z);
      }
    }
    std::printf(
        "%.1f m/s: total %.3f, up %.3f, ahead %.3f of the weight; hip %.3f, knee %.3f, ankle %.3f N m/kg (%.2f %.2f "
        "%.2f of it); centre %.4f m\n",
        static_cast<double>(speed), total.rms(), up.rms(), ahead.rms(), hip.rms(), knee.rms(), ankle.rms(),
        hip.of_whole(), knee.of_whole(), ankle.of_whole(), centre.rms());
    EXPECT_LT(total.rms(), 0.03);
    EXPECT_LT(up.rms(), 0.06);
    EXPECT_LT(ahead.rms(), 0.03);
    EXPECT_LT(ankle.rms(), 0.2);
    EXPECT_LT(knee.rms(), 0.12);
    EXPECT_LT(hip.rms(), 0.08);
    EXPECT_LT(centre.rms(), 0.03);
  }
}

/// The weight acts at once and permanently between the feet, at any height of the floor.
TEST(PosedForces, StandingLoadIsOnBothFeet) {
  for (const float floor_m : {0.0F, 3.0F, -2.0F}) {
    Simulation simulation;
    const SamplePerson who = sample_person(2);
    const Entity puppet = *simulation.spawn_posed(who.body);
    const Pose<float> standing = moved(*simulation.get<Pose>(puppet), {5, floor_m, -7});
    ASSERT_EQ(simulation.set_pose(puppet, standing, Arrival::jumped), Status::ok);
    ASSERT_EQ(simulation.enable(puppet, Feature::forces), Status::ok);
    for (int tick = 0; tick < 5; ++tick) {
      if (tick > 0) simulation.tick();
      const auto ground = *simulation.get<GroundReaction>(puppet);
      const float weight = who.body.mass_kg * gravity;
      const float on_right = ground.force_n[Side::right].y, on_left = ground.force_n[Side::left].y;
      EXPECT_NEAR(on_right + on_left, weight, 1e-3F * weight) << tick;
      EXPECT_NEAR(on_right, on_left, 1e-2F * weight);
      for (const Side side : {Side::right, Side::left}) {
        const auto feet = *simulation.get<Feet>(puppet);
        EXPECT_NEAR(ground.centre_m[side].y, floor_m, 0.002F);
        EXPECT_GT(ground.centre_m[side].z, feet.heel_m[side].z);
        EXPECT_LT(ground.centre_m[side].z, feet.tip_m[side].z);
        EXPECT_NEAR(ground.centre_m[side].x, feet.heel_m[side].x, 0.05F);
      }
      // The centre of mass is above the centre of pressure.
      if (tick == 0) continue;
      const float share = on_right / weight;
      EXPECT_NEAR(share * ground.centre_m[Side::right].z + (1 - share) * ground.centre_m[Side::left].z,
                  simulation.get<CentreOfMass>(puppet)->position_m.z, 0.005F);
    }
    EXPECT_EQ(simulation.enable(puppet, Feature::forces, false), Status::ok);
    EXPECT_FALSE(simulation.get<GroundReaction>(puppet));
    simulation.tick();
  }
}

/// A person on one leg is supported by it, whatever the other leg does.
TEST(PosedForces, FootInTheAirHasNoLoad) {
  Simulation simulation;
  const SamplePerson who = sample_person(2);
  const Entity puppet = *simulation.spawn_posed(who.body);
  ASSERT_EQ(simulation.enable(puppet, Feature::forces), Status::ok);
  Pose<float> pose = *simulation.get<Pose>(puppet);
  using enum Segment;
  for (std::size_t s = index(shank_left); s <= index(toes_left); ++s) pose.position_m[s].y += 0.2F;
  for (int tick = 0; tick < 5; ++tick) {
    ASSERT_EQ(simulation.set_pose(puppet, pose, tick == 0 ? Arrival::jumped : Arrival::moved), Status::ok);
    simulation.tick();
    const auto ground = *simulation.get<GroundReaction>(puppet);
    EXPECT_NEAR(ground.force_n[Side::right].y, who.body.mass_kg * gravity, 0.5F);
    EXPECT_LT(std::abs(ground.force_n[Side::left].y), 0.5F);
  }
}

/// A teleport has no inertia; a jump into the air has.
TEST(PosedForces, JumpsAndFalls) {
  Simulation simulation;
  const SamplePerson who = sample_person(0);
  const float weight = who.body.mass_kg * gravity;
  const Entity puppet = *simulation.spawn_posed(who.body);
  const Pose<float> standing = *simulation.get<Pose>(puppet);
  ASSERT_EQ(simulation.enable(puppet, Feature::forces), Status::ok);
  const auto lift = [&] {
    const auto ground = *simulation.get<GroundReaction>(puppet);
    return ground.force_n[Side::right].y + ground.force_n[Side::left].y;
  };
  for (int tick = 0; tick < 5; ++tick) {
    ASSERT_EQ(simulation.set_pose(puppet, moved(standing, {static_cast<float>(10 * tick), 0, 0}), Arrival::jumped),
              Status::ok);
    simulation.tick();
    EXPECT_NEAR(lift(), weight, 1e-3F * weight) << tick;
  }
  const auto tick_s = static_cast<float>(simulation.tick_s());
  float high_m = 0;
  for (int tick = 0; tick < 20; ++tick) {
    const float t = tick_s * static_cast<float>(tick);
    high_m = 1.6F * t - 0.5F * gravity * t * t;
    ASSERT_EQ(
        simulation.set_pose(puppet, moved(standing, {50, high_m, 0}), tick == 0 ? Arrival::jumped : Arrival::moved),
        Status::ok);
    simulation.tick();
    if (tick < 2) continue;
    EXPECT_LT(lift(), 0.01F * weight) << tick;  // single precision, 2 m high
    EXPECT_GE(lift(), 0);
  }
}

/// A starting elevator increases the load in proportion to its acceleration.
TEST(PosedForces, AccelerationIncreasesTheLoad) {
  Simulation simulation;
  const SamplePerson who = sample_person(0);
  const Entity puppet = *simulation.spawn_posed(who.body);
  const Pose<float> standing = *simulation.get<Pose>(puppet);
  ASSERT_EQ(simulation.enable(puppet, Feature::forces), Status::ok);
  const auto tick_s = static_cast<float>(simulation.tick_s());
  for (int tick = 0; tick < 30; ++tick) {
    const float t = tick_s * static_cast<float>(tick);
    ASSERT_EQ(simulation.set_pose(puppet, moved(standing, {0, 0.5F * 2 * t * t, 0})), Status::ok);
    simulation.tick();
    if (tick < 3) continue;
    const auto ground = *simulation.get<GroundReaction>(puppet);
    EXPECT_NEAR(ground.force_n[Side::right].y + ground.force_n[Side::left].y, who.body.mass_kg * (gravity + 2),
                0.005F * who.body.mass_kg * gravity)
        << tick;
  }
}

/// The pose history is state: it is saved, restored and shifted with the world.
TEST(PosedForces, ContinueAfterASnapshotAndAnOriginShift) {
  Simulation walking, posed, other, shifted;
  const SamplePerson who = sample_person(4);
  const Entity walker = *walking.spawn(who.body, {.speed_m_s = 1.4F});
  std::vector<Entity> puppets;
  for (Simulation* simulation : {&posed, &shifted}) {
    puppets.push_back(*simulation->spawn_posed(who.body));
    ASSERT_EQ(simulation->enable(puppets.back(), Feature::forces), Status::ok);
  }
  for (int tick = 0; tick < 90; ++tick) {
    walking.tick();
    const auto pose = *walking.get<Pose>(walker);
    if (tick == 60) {
      std::vector<std::byte> bytes(posed.snapshot_bytes());
      ASSERT_TRUE(posed.save(bytes));
      const auto done = other.restore(bytes, RestoreLimits::none());
      ASSERT_TRUE(done) << done.error().message;
      ASSERT_TRUE(shifted.shift_origin(64, -128));
    }
    ASSERT_EQ(posed.set_pose(puppets[0], pose), Status::ok);
    ASSERT_EQ(shifted.set_pose(puppets[1], tick < 60 ? pose : moved(pose, {-64, 0, 128})), Status::ok);
    posed.tick();
    shifted.tick();
    if (tick < 60) continue;
    ASSERT_EQ(other.set_pose(puppets[0], pose), Status::ok);
    other.tick();
    ASSERT_EQ(other.state_hash(), posed.state_hash());
    const auto a = *posed.get<GroundReaction>(puppets[0]), b = *shifted.get<GroundReaction>(puppets[1]);
    const float weight = who.body.mass_kg * gravity;
    for (const Side side : {Side::right, Side::left}) {
      EXPECT_NEAR(a.force_n[side].y, b.force_n[side].y, 0.05F * weight);  // 8 µm of a float at 64 m, over 1/3600 s²
      if (a.force_n[side].y < 0.5F * weight) continue;
      EXPECT_NEAR(a.centre_m[side].z, b.centre_m[side].z - 128, 0.05F);
    }
  }
}

}  // namespace mobil::posed_forces_test
