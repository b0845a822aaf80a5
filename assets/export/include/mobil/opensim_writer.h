#pragma once
// A recorded walk as OpenSim's tables: coordinates of its gait2392 model, and forces of the ground.

#include <filesystem>

#include <mobil/assets/export/walk_recording.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Writes `path`, whole or not at all, as a motion (.mot, inDegrees=yes) with a row a frame: time, then pelvis_tilt,
/// pelvis_list, pelvis_rotation, pelvis_tx, _ty, _tz, of the right and the left leg hip_flexion, hip_adduction,
/// hip_rotation, knee_angle, ankle_angle, subtalar_angle, mtp_angle, then lumbar_extension, lumbar_bending and
/// lumbar_rotation. Signs are gait2392's: hip flexion, adduction and inward turn, ankle dorsiflexion, inversion and
/// toes up positive, the knee negative in flexion, the pelvis' tilt positive backward, its list positive where the
/// right side is low, its rotation where that is ahead. Its axes: x ahead (our +z), y up, z to the right (our −x);
/// degrees and m. Angles are those of segments' rotations in the model's order (z, x, y), so that the tilted axes of
/// its foot are not accounted for; the trunk is T1's. pelvis_t* is the model's origin of the pelvis, in front of and
/// above the hips by its own proportions, as large as these hips are apart. Errors: those of check_recording, a file
/// that cannot be written. Source: the gait2392 model of OpenSim (Delp et al. 1990); OpenSim's Motion (.mot) file
/// format.
Result<void> write_opensim_motion(const std::filesystem::path& path, const WalkRecording& recording);

/// Writes `path` as a storage (.sto) with a row a frame, as external loads are read: of the right foot
/// ground_force_vx, _vy, _vz (N), ground_force_px, _py, _pz (m, the centre of pressure), the same of the left one as
/// 1_ground_force_…, then ground_torque_x, _y, _z and 1_ground_torque_… (N m, 0: feet do not twist on the ground), in
/// the axes above. Errors: also a recording without forces.
Result<void> write_opensim_forces(const std::filesystem::path& path, const WalkRecording& recording);

}  // namespace mobil::inline v0_3
