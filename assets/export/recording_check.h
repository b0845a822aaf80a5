#pragma once
// Check of a recording before it is written.

#include <mobil/engine/error.h>
#include "assets/export/recorded_people.h"

namespace mobil::inline v0_3 {

/// Errors name the person, frame, segment or surface. Reasons are a recording without people or frames, unequal numbers
/// of frames, frame_s outside 0.001–10 s, a repeated name, a missing figure; scales and colours out of range, numbers
/// that are not finite, rotations of no length, indices outside their surface, muscles whose frames or vertices do not
/// match.
Result<void> check_recording(const RecordedPeople& recorded);

}  // namespace mobil::inline v0_3
