#pragma once
// Writes recorded walks as a USD text file (.usda): skeletons with skinned bones, and muscles as point caches.

#include <filesystem>

#include <mobil/assets/export/walk_recording.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Writes `path`, completely or not at all. upAxis is Y, metersPerUnit 1, with a time code per frame from 0 on. The
/// default prim "walk" contains a prim for each person, of their name (made an identifier), with these.
///
///     SkelRoot Body    Skeleton (48 segments, bound and at rest in WalkRecording::standing_m);
///                      SkelAnimation (translations and rotations of all joints per frame);
///                      Mesh bones (one joint a vertex);
///     Xform Muscles    a Mesh per muscle, with points and normals per frame.
///
/// With roots the person's prim moves by them, and joints and muscles are relative to it. A skin with drawn places
/// (SkinnedSurface::drawn_m) has blend shapes, as the morph targets of a GLB.
/// Meshes have primvars:st (along and around, folded, texture_places.h; of skins in their atlas) and displayColor.
/// Muscles with tissue have primvars:tissue (along, around, tendon, aponeurosis, 0 to 1) and a displayColor by vertex.
/// Joints are placed within 10 µm, muscles' vertices within 5 µm. Muscles are text of about 45 bytes a vertex and
/// frame. Fails as check_recording, or on a file that cannot be written. Format: OpenUSD (usda text; UsdGeom, UsdSkel
/// schemas).
Result<void> write_usda(const std::filesystem::path& path, const WalkRecording& recording);

/// Writes several people. Surfaces of a shared figure are written once and referred to; each person's bind pose scales
/// them. A mesh of people with individual colours is called "figure", one per cloth.
Result<void> write_usda(const std::filesystem::path& path, const CrowdRecording& recording);

}  // namespace mobil::inline v0_3
