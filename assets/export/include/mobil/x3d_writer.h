#pragma once
// A recorded walk as VRML97 (.wrl), as the paper has it, or as its successor X3D (.x3d): geometry and movement.

#include <filesystem>

#include <mobil/assets/export/scene_text.h>
#include <mobil/assets/export/walk_recording.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Writes `path`, whole or not at all; the notation is asked for, whatever the file's name. A Transform of the person's
/// name (made an identifier, as all names are) holds the 48 segments as nested Transforms, each with its bones as
/// IndexedFaceSets; muscles hang beside the pelvis, in the world's places. m, +Y up. A TimeSensor "clock" runs once
/// through the walk and begins again; an OrientationInterpolator for each joint that turns, a PositionInterpolator for
/// each that moves from its parent, a CoordinateInterpolator for each muscle have a key a frame. Joints are placed
/// within 10 µm, muscles' vertices within 5 µm. Coordinates are text: some 24 bytes a vertex and frame. Errors: those
/// of check_recording, a file that cannot be written. Formats: ISO/IEC 14772-1:1997 (VRML97), ISO/IEC 19776-1 (X3D's
/// XML encoding), profile Immersive.
Result<void> write_x3d(const std::filesystem::path& path, const WalkRecording& recording, SceneNotation notation);

}  // namespace mobil::inline v0_3
