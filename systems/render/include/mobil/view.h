#pragma once
// A scene's camera and lamps as the numbers the device's programs read.

#include <mobil/engine/error.h>
#include <mobil/systems/render/matrix.h>
#include <mobil/systems/render/scene.h>
#include <mobil/systems/render/shaders.h>

namespace mobil::inline v0_3 {

/// The same block for the camera and for the key lamp, which sees the casters' shadows.
struct FrameBlocks {
  FrameBlock camera, lamp;
  bool shadows = false;
};

/// `casters`: what throws shadows, in the world; the shadow map just covers it. Error: a camera that sees nothing
/// (field of view outside 1–170 degrees, eye in the target, NaN) or a light from below.
Result<FrameBlocks> frame_blocks(const Scene& scene, int width, int height, const capture_math::Box& casters);

}  // namespace mobil::inline v0_3
