#pragma once
// Whether a recording can be written at all.

#include <mobil/engine/error.h>
#include "assets/export/recorded_people.h"

namespace mobil::inline v0_3 {

/// Errors name the person, frame, segment or surface: nobody, no frames or another number of them than others have,
/// frame_s outside 0.001–10 s, a name that somebody else has, a figure that is not there, scales and colours out of
/// range, numbers that are not finite, rotations of no length, indices outside their surface, muscles whose frames or
/// vertices do not match.
Result<void> check_recording(const RecordedPeople& recorded);

}  // namespace mobil::inline v0_3
