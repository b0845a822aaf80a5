#pragma once
// Writes a person and a recorded walk for MuJoCo: the model as MJCF, and its motion as a table.

#include <filesystem>

#include <mobil/assets/export/walk_recording.h>
#include <mobil/components/body.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Writes `path`, completely or not at all: a model in MJCF, in m, kg, s and rad, with mobil's axes (+Y up, gravity
/// along −Y). Bodies are the 48 segments, with masses, centres of mass and inertias of `body` (segment_inertia_kg_m2).
/// Joints have the names of their segments: a free joint for the pelvis, hinges for knees, kneecaps and toes, balls for
/// all others. A kneecap turns about the knee by `kneecap_part` of its flexion, which is an equality. Ranges are those
/// of assets/body/joint_limits.h; a ball has the angle to the farthest corner of its joint's. Each leg has the 39 lines
/// of the table, as spatial tendons over sites with an actuator of type muscle. It has the simulation's force, fibre
/// and slack tendon, and the path's lengths over the range of the joints. Geoms are capsules of the segment's mass,
/// which touch the floor and not each other. Two touch sensors a foot are under sole and toes. The keyframe `walk` is
/// the recording's first frame, with velocities.
///
/// Fails as check_recording, or without as many `around` as frames. Also fails if a joint turns by more than 0.1° out
/// of its hinge or is more than 0.1 mm from its place in `body`, or on a file that cannot be written. Format: MuJoCo's
/// XML reference.
Result<void> write_mujoco_model(const std::filesystem::path& path, const Body& body, const WalkRecording& recording);

/// Writes `path`, completely or not at all: a CSV table with a row per frame. Columns are time_s; qpos_0 …, qvel_0 …,
/// qacc_0 … in the model's order; then, if forces were simulated, of the right and the left foot ground_force_x, _y, _z
/// (N), centre_of_pressure_x, _y, _z (m) and free_moment (N m, about +Y), in the world. A foot in the air has zeros.
/// Velocities and accelerations are differences over `motion_difference_s`, as the simulation's forces have them. Fails
/// as write_mujoco_model.
Result<void> write_mujoco_motion(const std::filesystem::path& path, const Body& body, const WalkRecording& recording);

}  // namespace mobil::inline v0_3
