#pragma once
// A recorded walk as what a renderer draws.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include <mobil/assets/export/walk_recording.h>
#include <mobil/systems/capture/scene.h>
#include "demo/walk/drawn_skin.h"

namespace mobil {

/// Meshes that look into recordings, and the placements that they look at.
struct RecordedScene {
  std::vector<DrawMesh> meshes;
  std::deque<Placement> placement;
};

/// Adds the bones of a frame, moved by `shift`. `first_key`: bone i is sent to the device once, as this + i; 0 for each
/// time.
void add_bones(const WalkRecording& recording, std::size_t frame, const Vec3<float>& shift, std::uint64_t first_key,
               RecordedScene& scene);

/// A frame's muscles.
LegVertices muscles_of(const WalkRecording& recording, std::size_t frame);
/// Adds the muscles of a frame, moved by `shift`.
void add_muscles(const WalkRecording& recording, std::size_t frame, const Vec3<float>& shift, RecordedScene& scene);

}  // namespace mobil
