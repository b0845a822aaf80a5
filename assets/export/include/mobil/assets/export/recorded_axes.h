#pragma once
// Axes of recordings for programs whose walkers face −Z.

#include <mobil/assets/export/walk_recording.h>

namespace mobil::inline v0_3 {

/// Turns a recording by half a turn about +Y: heading 0 is then toward −Z with +X to the right, as in Godot
/// (PoseAxes::y_up_z_back, mobil/pose_writer.h). Segments' frames turn as well, so that poses in those axes drive the
/// written surfaces. Headings keep their numbers, and surfaces their texture places. Values change signs only, so a
/// second call restores every bit. MJCF and OpenSim's files have axes of their own and need unturned recordings.
void put_z_back(WalkRecording& recording);
void put_z_back(CrowdRecording& recording);

}  // namespace mobil::inline v0_3
