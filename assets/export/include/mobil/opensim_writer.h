#pragma once
// Writes a recorded walk as OpenSim's tables: coordinates of its gait2392 model, and forces of the ground; and the
// body as a model.

#include <filesystem>

#include <mobil/assets/export/walk_recording.h>
#include <mobil/components/body.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Writes `path`, completely or not at all, as a motion (.mot, inDegrees=yes) with a row per frame. Columns are time;
/// pelvis_tilt, pelvis_list, pelvis_rotation, pelvis_tx, _ty, _tz; of the right and the left leg hip_flexion,
/// hip_adduction, hip_rotation, knee_angle, ankle_angle, subtalar_angle, mtp_angle; lumbar_extension, lumbar_bending
/// and lumbar_rotation. Signs are gait2392's. Hip flexion, adduction and inward turn, ankle dorsiflexion, inversion and
/// toes up are positive, knee flexion is negative. The pelvis' tilt is positive backward, its list where the right side
/// is low, its rotation where that is ahead. Axes are the model's: x ahead (mobil's +z), y up, z to the right (mobil's
/// −x); degrees and m. Angles are those of segments' rotations in the model's order (z, x, y), which ignores the tilted
/// axes of its foot; the trunk is T1's. pelvis_t* is the model's origin of the pelvis, in front of and above the hips
/// in its proportions, scaled by the distance of these hips. Fails as check_recording, or on a file that cannot be
/// written. Source: the gait2392 model of OpenSim (Delp et al. 1990); OpenSim's Motion (.mot) file format.
Result<void> write_opensim_motion(const std::filesystem::path& path, const WalkRecording& recording);

/// Writes `path` as a storage (.sto) with a row per frame, as external loads are read. Columns of the right foot are
/// ground_force_vx, _vy, _vz (N) and ground_force_px, _py, _pz (m, the centre of pressure); those of the left one begin
/// with 1_ground_force_…. They are followed by ground_torque_x, _y, _z and 1_ground_torque_… (N m, the free
/// moment about y, otherwise 0), in the axes above. Also fails on a recording without forces.
Result<void> write_opensim_forces(const std::filesystem::path& path, const WalkRecording& recording);

/// Writes `path`, completely or not at all, as a model (.osim, version 4) of that body, which these motions move.
/// Bodies are pelvis, torso with head and arms in the anatomical position, and femur with kneecap, tibia, calcn and
/// toes of each side. They have the masses, centres and inertias of their segments. Joints are CustomJoints with the
/// motions' coordinates: three at hips and back, knee_angle, ankle_angle and subtalar_angle, mtp_angle; axes are z, x,
/// y. Ranges of the legs are those of assets/body/joint_limits.h. Muscles are the 39 lines of the table in each leg, as
/// Thelen2003Muscles of the simulation's fibres, tendons, pennation and isometric force; the knee does not roll. Fails
/// on a file that cannot be written. Source: the gait2392 model; the XML of OpenSim 4.
Result<void> write_opensim_model(const std::filesystem::path& path, const Body& body);

}  // namespace mobil::inline v0_3
