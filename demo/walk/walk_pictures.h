#pragma once
// Pictures of a recorded walk: frame_*.png, walk.mp4.

#include <cstddef>
#include <functional>

#include <mobil/systems/surfaces/place_skin.h>
#include "demo/walk/figure.h"
#include "demo/walk/walk_options.h"

namespace mobil {

/// Content of pictures in addition to the recording, by frame. Lines of action (for the stick view) and edges of the
/// finite-element meshes (for the wireframe view) have two ends per line, world, m. `fat` is the displacement of
/// wobbling fat (for the views with skin).
struct WalkDrawing {
  const WalkRecording* recording = nullptr;
  const Body* body = nullptr;
  const Figure* figure = nullptr;
  std::vector<std::vector<Vec3<float>>> action_line, mesh_edge;
  std::vector<FatBeside> fat;
};

/// Renders every frame at 1280×720 with a following camera, as PNGs, a video or both in `folder`, according to
/// `options`. `progress` receives the number of finished frames. Errors: no driver, no ffmpeg, an unwritable folder.
Result<void> write_pictures(const WalkDrawing& drawing, const WalkOptions& options, const std::filesystem::path& folder,
                            const std::function<void(std::size_t)>& progress);

}  // namespace mobil
