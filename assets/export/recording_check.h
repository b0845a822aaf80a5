#pragma once
// Whether a recording can be written at all.

#include "assets/export/walk_recording.h"
#include "engine/error.h"

namespace mobil {

/// Errors name the frame, segment or surface: no frames, frame_s outside 0.001–10 s, numbers that are not finite,
/// rotations of no length, indices outside their surface, muscles whose frames or vertices do not match.
Result<void> check_recording(const WalkRecording& recording);

}  // namespace mobil
