#pragma once
// Recorded walks as a USD text file (.usda): skeletons with skinned bones, and muscles as point caches.

#include <filesystem>

#include <mobil/assets/export/walk_recording.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Writes `path`, whole or not at all. upAxis Y, metersPerUnit 1, a time code a frame from 0 on. The default prim
/// "walk" holds a prim for each person, of their name (made an identifier), and in that:
///
///     SkelRoot Body    Skeleton (the 48 segments; bind pose: the standing body, see standing_places in
///     skeleton_keys.h),
///                      SkelAnimation (translations and rotations of all joints a frame), Mesh bones (one joint a
///                      vertex)
///     Xform Muscles    a Mesh a muscle, whose points and normals are given a frame, in the world's places
///
/// Meshes have primvars:st (along and around, folded, texture_places.h; of skins in their atlas) and displayColor.
/// Joints are placed within 10 µm, muscles' vertices within 5 µm. Muscles are text: some 45 bytes a vertex and frame.
/// Errors: those of check_recording, a file that cannot be written. Format: OpenUSD (usda text; UsdGeom, UsdSkel
/// schemas).
Result<void> write_usda(const std::filesystem::path& path, const WalkRecording& recording);

/// The same of several people; surfaces of those who share a figure are written once and referred to; each person's
/// bind pose scales them. A mesh of people with colours of their own is called "figure", one a cloth.
Result<void> write_usda(const std::filesystem::path& path, const CrowdRecording& recording);

}  // namespace mobil::inline v0_3
