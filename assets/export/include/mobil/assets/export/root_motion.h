#pragma once
// The way of recorded people: kept on their roots, or removed.

#include <mobil/assets/export/walk_recording.h>

namespace mobil::inline v0_3 {

/// Removes the way of a recorded walk: poses, muscles and drawn skins are then relative to the root of each frame, and
/// `root` is empty. Requires a root for each frame.
void put_in_place(WalkRecording& recording);
/// Keeps each person at their first root. Requires roots for each frame of all people.
void put_in_place(CrowdRecording& recording);

/// Moves a walk so that its first root is at x = z = 0, and makes its last frame the first one after the way between
/// their roots. Returns the largest displacement that this needs, m, of all joints and of all vertices of muscles.
/// Requires a root for each frame and at least two frames.
struct CycleGap {
  double joints_m = 0, muscles_m = 0;
};
CycleGap close_cycle(WalkRecording& recording);

}  // namespace mobil::inline v0_3
