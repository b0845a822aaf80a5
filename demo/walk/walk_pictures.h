#pragma once
// A recorded walk as pictures: frame_*.png, walk.mp4.

#include <cstddef>
#include <functional>

#include <mobil/systems/surfaces/place_skin.h>
#include "demo/walk/figure.h"
#include "demo/walk/walk_options.h"

namespace mobil {

/// What pictures show beyond the recording, by frame, two ends a line, in the world (m): lines of action (the stick
/// view needs them), edges of the finite-element meshes (the wireframe view); and where the fat is beside its place, if
/// it wobbles (the views with skin).
struct WalkDrawing {
  const WalkRecording* recording = nullptr;
  const Body* body = nullptr;
  const Figure* figure = nullptr;
  std::vector<std::vector<Vec3<float>>> action_line, mesh_edge;
  std::vector<FatBeside> fat;
};

/// Renders every frame at 1280×720 with the camera following, as PNGs and/or a video in `folder`, as `options` says;
/// `progress` is called with the number of frames done. Errors: no driver, no ffmpeg, an unwritable folder.
Result<void> write_pictures(const WalkDrawing& drawing, const WalkOptions& options, const std::filesystem::path& folder,
                            const std::function<void(std::size_t)>& progress);

}  // namespace mobil
