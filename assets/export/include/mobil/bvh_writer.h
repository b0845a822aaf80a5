#pragma once
// A recorded walk as a BVH file: the skeleton and its joint angles, for programs that animate characters.

#include <filesystem>

#include <mobil/assets/export/walk_recording.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Writes `path`, whole or not at all. HIERARCHY: the 48 segments by name, the pelvis as ROOT; offsets in m as the body
/// stands with all angles 0 (standing_places in skeleton_keys.h); +Y up, the walker faces +Z. Channels of a joint are
/// Xrotation Zrotation Yrotation in degrees, R = Rx · Rz · Ry (joint_angles.h); the root and the joints that slide, as
/// kneecaps do, have Xposition Yposition Zposition before them, in m from the parent's origin: they stand instead of
/// the offset. MOTION: a line a frame. An End Site is a segment's tip, as far as the recording knows it. Joints are
/// read back within 10 µm. Errors: those of check_recording, a file that cannot be written. Format: M. Meredith, S.
/// Maddock, Motion Capture File Formats Explained, University of Sheffield 2001.
Result<void> write_bvh(const std::filesystem::path& path, const WalkRecording& recording);

}  // namespace mobil::inline v0_3
