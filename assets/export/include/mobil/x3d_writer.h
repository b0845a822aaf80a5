#pragma once
// Writes a recorded walk as VRML97 (.wrl), the paper's format, or as its successor X3D (.x3d): geometry and movement.

#include <filesystem>

#include <mobil/assets/export/scene_text.h>
#include <mobil/assets/export/walk_recording.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Writes `path`, completely or not at all, in `notation`, whatever the file's name. A Transform of the person's name
/// (made an identifier, as all names are) contains the 48 segments as nested Transforms, each with its bones as
/// IndexedFaceSets. Muscles are siblings of the pelvis, in world coordinates; m, +Y up. A TimeSensor "clock" repeats
/// the walk. Each joint that turns has an OrientationInterpolator, each that moves from its parent a
/// PositionInterpolator, and each muscle a CoordinateInterpolator, with a key per frame. Joints are placed within 10
/// µm, muscles' vertices within 5 µm. Coordinates are text of about 24 bytes a vertex and frame. Fails as
/// check_recording, or on a file that cannot be written. Formats are ISO/IEC 14772-1:1997 (VRML97) and ISO/IEC 19776-1
/// (X3D's XML encoding), profile Immersive.
Result<void> write_x3d(const std::filesystem::path& path, const WalkRecording& recording, SceneNotation notation);

}  // namespace mobil::inline v0_3
