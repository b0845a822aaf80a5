#pragma once
// A scene's camera and lamps as the numbers the device's programs read.

#include "engine/error.h"
#include "systems/capture/matrix.h"
#include "systems/capture/scene.h"
#include "systems/capture/shaders.h"

namespace mobil {

/// The same block for the camera and for the key lamp, which sees the casters' shadows.
struct FrameBlocks {
  FrameBlock camera, lamp;
  bool shadows = false;
};

/// `casters`: what throws shadows, in the world; the shadow map just covers it. Error: a camera that sees nothing
/// (field of view outside 1–170 degrees, eye in the target, NaN) or a light from below.
Result<FrameBlocks> frame_blocks(const Scene& scene, int width, int height, const capture_math::Box& casters);

}  // namespace mobil
