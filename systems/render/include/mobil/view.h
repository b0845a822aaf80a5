#pragma once
// Converts a scene's camera and lamps to the uniform blocks of the shaders.

#include <mobil/engine/error.h>
#include <mobil/systems/render/matrix.h>
#include <mobil/systems/render/scene.h>
#include <mobil/systems/render/shaders.h>

namespace mobil::inline v0_3 {

/// Blocks of the camera and of the key lamp, from which the shadow map is rendered.
struct FrameBlocks {
  FrameBlock camera, lamp;
  bool shadows = false;
};

/// Computes the blocks. `casters` is the box of all objects that cast shadows, in the world, and the shadow map covers
/// it. Errors: an invalid camera (field of view outside 1–170 degrees, eye at the target, NaN), a light from below.
Result<FrameBlocks> frame_blocks(const Scene& scene, int width, int height, const capture_math::Box& casters);

}  // namespace mobil::inline v0_3
