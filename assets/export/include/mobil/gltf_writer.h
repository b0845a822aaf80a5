#pragma once
// Writes recorded walks as one GLB (glTF 2.0, binary): a skin over nested joints, bones, and muscles as morph targets.

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <mobil/assets/export/walk_recording.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Options of written muscles.
struct ExportOptions {
  int morph_targets = 4;              // maximum per muscle, 0–8; viewers must support only 8 morphed attributes,
                                      // 4 targets with normals
  float morph_tolerance_m = 0.5e-3F;  // fewer targets if every vertex stays closer than this
  bool morph_normals = true;          // false: about a quarter smaller; muscles keep the shading of one shape
};

/// Distance of a muscle or a skin in the file from the recorded one, over all its vertices and frames.
struct MuscleFidelity {
  std::string name;
  int morph_targets = 0;
  double max_error_m = 0, rms_error_m = 0;
};

/// Size of the written file, and fidelity of each muscle.
struct ExportReport {
  std::size_t bytes = 0;
  std::vector<MuscleFidelity> muscles;  // in the recording's order
  MuscleFidelity skin;                  // of a skin with drawn places, before blending
  double bones_moved_m = 0;             // largest displacement of a bone's vertex that would come through such a skin
};

/// Writes `path`, completely or not at all. A person is a root node of that name, which programs can move, with the 48
/// segments as nested nodes under it. They are the joints of one skin. Nodes rest in the skin's bind pose
/// (WalkRecording::standing_m). A joint has rotation keys at every frame if it turns, and translation keys where its
/// offset from the parent changes. A joint that stays elsewhere than at rest has two equal keys. The root has keys if
/// the recording has roots. Bones are one mesh, "bones", of which each vertex follows its segment. Every muscle is a
/// mesh of its name, which follows its segment. Its targets are the principal components of its displacement in the
/// segment's frame, with weights from 0 to 1. A skin with drawn places (SkinnedSurface::drawn_m) also has targets, so
/// that bones and muscles stay inside it; vertices of bones that would come through are moved below it. Nodes of these
/// meshes are siblings of the root, as glTF requires. TEXCOORD_0 is along and around each bone or muscle (folded,
/// texture_places.h), for skins in their atlas, with TANGENT. Muscles with tissue have it as _TISSUE (VEC4 of normalised
/// bytes: along, around, tendon, aponeurosis) and as colours (COLOR_0), and a white material. Names are unique. Output is byte-identical for the same
/// recording. Fails without frames, on a value that is not finite, an inconsistent surface or a file that cannot be
/// written. Format: Khronos glTF 2.0 specification.
Result<ExportReport> write_glb(const std::filesystem::path& path, const WalkRecording& recording,
                               const ExportOptions& options = {});

/// Writes several people in one animation. Names of a person's parts begin with the person's: "anna_thigh_right". A
/// figure's vertices are written once for all people who share it; each person's skin scales them. A mesh of people
/// with individual colours is called "figure".
Result<ExportReport> write_glb(const std::filesystem::path& path, const CrowdRecording& recording,
                               const ExportOptions& options = {});

}  // namespace mobil::inline v0_3
