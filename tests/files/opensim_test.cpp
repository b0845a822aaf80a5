// OpenSim tables of a recorded walk: names, axes and signs.
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include <mobil/opensim_writer.h>
#include "tests/files/formats_fixture.h"
#include "tests/files/opensim_table.h"
#include "tests/refused.h"

namespace mobil::formats_test {

/// Returns a standing body with one segment and its descendants turned about its joint, in OpenSim's axes.
WalkRecording bent(Segment segment, const Vector3d& axis, double angle) {
  const Vector3d ours(-axis.z(), axis.y(), axis.x());
  const Quaterniond turn(Eigen::AngleAxisd(angle, ours));
  WalkRecording walk;
  walk.frames = swinging(1);
  std::vector<Vector3d> p(segment_count);
  std::vector<Quaterniond> q(segment_count, Quaterniond::Identity());
  for (std::size_t s = 0; s < segment_count; ++s) {
    const std::size_t parent = index(segment_parent[s]);
    const Vector3d offset(s == index(Segment::thigh_right)  ? -0.0835
                          : s == index(Segment::thigh_left) ? 0.0835
                                                            : 0,
                          0, parent == s ? 0 : 0.01);
    if (parent != s) q[s] = q[parent];
    if (s == index(segment)) q[s] = q[s] * turn;
    p[s] = parent == s ? Vector3d(0.3, 1, 2) : Vector3d(p[parent] + q[parent] * offset);
    set_world(walk.frames[0], s, p[s], q[s]);
  }
  return walk;
}

TEST(Opensim, AnglesHaveTheSignsOfGait2392) {
  const TemporaryFolder place;
  const auto file = place.path / "walk.mot";
  const Vector3d x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  using enum Segment;
  // A positive coordinate turns the segment about this axis of the model (its joints' SpatialTransforms, with the
  // nearest axis for the foot's oblique ones). Left hip and foot are mirrored.
  const struct {
    const char* coordinate;
    Segment segment;
    Vector3d axis;
  } joints[] = {
      {"pelvis_tilt", pelvis, z},        {"pelvis_list", pelvis, x},          {"pelvis_rotation", pelvis, y},
      {"hip_flexion_r", thigh_right, z}, {"hip_adduction_r", thigh_right, x}, {"hip_rotation_r", thigh_right, y},
      {"hip_flexion_l", thigh_left, z},  {"hip_adduction_l", thigh_left, -x}, {"hip_rotation_l", thigh_left, -y},
      {"knee_angle_r", shank_right, z},  {"knee_angle_l", shank_left, z},     {"ankle_angle_r", foot_right, z},
      {"ankle_angle_l", foot_left, z},   {"subtalar_angle_r", foot_right, x}, {"subtalar_angle_l", foot_left, -x},
      {"mtp_angle_r", toes_right, z},    {"mtp_angle_l", toes_left, z},       {"lumbar_extension", L5, z},
      {"lumbar_bending", L5, x},         {"lumbar_rotation", L5, y}};
  for (const auto& joint : joints) {
    ASSERT_TRUE(write_opensim_motion(file, bent(joint.segment, joint.axis, 0.3)));
    const OpensimTable table(file);
    EXPECT_EQ(table.header.at("inDegrees"), "yes");
    EXPECT_EQ(table.names.size(), 1U + 6 + 14 + 3);
    for (const auto& name : table.names) {
      if (name == "time" || name.starts_with("pelvis_t")) continue;
      const bool own = name == joint.coordinate;
      EXPECT_NEAR(table.at(name, 0), own ? 0.3 * 180 / pi : 0, 1e-4) << name << " for " << joint.coordinate;
    }
  }
  ASSERT_TRUE(write_opensim_motion(file, bent(head, x, 0)));
  const OpensimTable table(file);  // hips as far apart as in the model: its own offsets
  EXPECT_NEAR(table.at("pelvis_tx", 0), 2 + 0.01 + 0.0707, 1e-5);
  EXPECT_NEAR(table.at("pelvis_ty", 0), 1 + 0.0661, 1e-5);
  EXPECT_NEAR(table.at("pelvis_tz", 0), -0.3, 1e-5);
}

TEST(Opensim, ForcesAreInItsAxesAndRefusedWhenMissing) {
  const TemporaryFolder place;
  WalkRecording walk;
  walk.frames = swinging(3);
  walk.frame_s = 0.5F;
  walk.start_s = 0.25;
  EXPECT_TRUE(is_refused(write_opensim_forces(place.path / "walk.sto", walk), "forces of 0 frames"));
  GroundReaction<float> ground{};
  ground.force_n[Side::right] = {10, 700, -50};
  ground.centre_m[Side::right] = {-0.1F, 0, 1.5F};
  ground.force_n[Side::left] = {-20, 300, 40};
  ground.centre_m[Side::left] = {0.1F, 0, 2.0F};
  walk.ground.assign(3, ground);
  ASSERT_TRUE(write_opensim_forces(place.path / "walk.sto", walk));
  const OpensimTable table(place.path / "walk.sto");
  ASSERT_EQ(table.names.size(), 1U + 18);
  EXPECT_NEAR(table.at("time", 2), 1.25, 1e-6);
  const std::map<std::string, double> expected = {
      {"ground_force_vx", -50},  {"ground_force_vy", 700}, {"ground_force_vz", -10},    {"ground_force_px", 1.5},
      {"ground_force_py", 0},    {"ground_force_pz", 0.1}, {"1_ground_force_vx", 40},   {"1_ground_force_vy", 300},
      {"1_ground_force_vz", 20}, {"1_ground_force_px", 2}, {"1_ground_force_pz", -0.1}, {"ground_torque_y", 0},
      {"1_ground_torque_y", 0}};
  for (const auto& [name, value] : expected) EXPECT_NEAR(table.at(name, 1), value, 1e-6) << name;
}

}  // namespace mobil::formats_test
