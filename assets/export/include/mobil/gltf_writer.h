#pragma once
// Recorded walks as one GLB file (glTF 2.0, binary): a skin over nested joints, bones, and muscles as morph targets.

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <mobil/assets/export/walk_recording.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// How muscles are written.
struct ExportOptions {
  int morph_targets = 4;              // at most this many a muscle, 0–8; viewers need to support only 8 morphed
                                      // attributes, which is 4 with normals
  float morph_tolerance_m = 0.5e-3F;  // fewer targets where every vertex stays closer than this
  bool morph_normals = true;          // without: about a quarter smaller; muscles keep the shading of their mean shape
};

/// How far a muscle in the file is from the recorded one, over all its vertices and frames.
struct MuscleFidelity {
  std::string name;
  int morph_targets = 0;
  double max_error_m = 0, rms_error_m = 0;
};

/// What was written: the size of the file, and how near each muscle is to the recording.
struct ExportReport {
  std::size_t bytes = 0;
  std::vector<MuscleFidelity> muscles;  // in the recording's order
};

/// Writes `path`, whole or not at all. A person is a root node of their name, which may be moved, with the 48 segments
/// as nested nodes under it; these are the joints of one skin, whose bind pose is the standing body (standing_places in
/// skeleton_keys.h). Joint rotations are keyed at every frame, translations only where the offset from the parent
/// changes. Bones are one mesh, "bones", of which each vertex follows its segment; every muscle is a mesh of its name,
/// which follows its segment, rests in its mean shape and has as targets the principal components of its displacement
/// in the segment's frame. Nodes of these meshes stand beside the root, as glTF wants it of skinned ones. TEXCOORD_0 is
/// along and around each bone or muscle (folded, texture_places.h), of skins in their atlas, with TANGENT. No name is
/// there twice. The same recording gives the same bytes. Errors: no frames, a value that is not finite, a surface that
/// does not fit together, a file that cannot be written. Format: Khronos glTF 2.0 specification.
Result<ExportReport> write_glb(const std::filesystem::path& path, const WalkRecording& recording,
                               const ExportOptions& options = {});

/// The same of several people, all in one animation. Names of somebody's parts begin with theirs: "anna_thigh_right".
/// A figure's vertices are written once for all who look like that; each person's skin scales them. A mesh of
/// people with colours of their own is called "figure".
Result<ExportReport> write_glb(const std::filesystem::path& path, const CrowdRecording& recording,
                               const ExportOptions& options = {});

}  // namespace mobil::inline v0_3
