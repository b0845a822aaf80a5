#pragma once
// Render targets: the multisampled picture, the picture that it is resolved into, and the shadow map.

#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

inline constexpr int shadow_map_size = 2048;

/// Framebuffer objects, owned by the context in which they were made.
struct RenderTargets {
  unsigned multisampled = 0, resolved = 0, shadow = 0, shadow_texture = 0;
};

/// Makes the targets in the current context. Errors: a size that the driver does not support.
Result<RenderTargets> make_render_targets(int width, int height);

}  // namespace mobil::inline v0_3
