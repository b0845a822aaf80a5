#pragma once
// A recorded walk as one GLB file (glTF 2.0, binary): nested segments, bones, and muscles as morph targets.

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "assets/export/walk_recording.h"
#include "engine/error.h"

namespace mobil {

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

struct ExportReport {
  std::size_t bytes = 0;
  std::vector<MuscleFidelity> muscles;  // in the recording's order
};

/// Writes `path`, whole or not at all. The 48 segments become nested nodes of the same names; joint rotations are
/// keyed at every frame, translations only where the offset from the parent changes. Every bone and muscle is a child
/// node of its segment with a mesh of its name. A muscle rests in its mean shape; the targets are the principal
/// components of its displacement in the segment's frame. The same recording gives the same bytes.
/// Errors: no frames, a value that is not finite, a surface that does not fit together, a file that cannot be written.
Result<ExportReport> write_glb(const std::filesystem::path& path, const WalkRecording& recording,
                               const ExportOptions& options = {});

}  // namespace mobil
