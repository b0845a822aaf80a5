#pragma once
// Writes a recorded walk as a BVH file: the skeleton and its joint angles, for programs that animate characters.

#include <filesystem>

#include <mobil/assets/export/walk_recording.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Writes `path`, completely or not at all. HIERARCHY has the 48 segments by name, with the pelvis as ROOT. Offsets are
/// in m, of the rest pose (WalkRecording::standing_m), except that of a joint which stays elsewhere in the recording;
/// +Y up, the walker faces +Z (−Z after put_z_back). Channels of a joint are Xrotation Zrotation Yrotation in degrees, R = Rx ·
/// Rz · Ry (joint_angles.h). The root and the joints that slide, such as kneecaps, have Xposition Yposition Zposition
/// before them, in m from the parent's origin. Their offset is 0, because some programs add it to the position and
/// others replace it. MOTION has a line per frame. An End Site is a segment's tip, if recorded. Joints are read back
/// within 10 µm. Fails as check_recording, or on a file that cannot be written. Format: M. Meredith, S. Maddock, Motion
/// Capture File Formats Explained, University of Sheffield 2001.
Result<void> write_bvh(const std::filesystem::path& path, const WalkRecording& recording);

}  // namespace mobil::inline v0_3
