#pragma once
// What is drawn into: the multisampled picture, the plain one it is resolved into, and the shadow map.

#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

inline constexpr int shadow_map_size = 2048;

/// Framebuffer objects of the context they were made in, which takes them with it.
struct RenderTargets {
  unsigned multisampled = 0, resolved = 0, shadow = 0, shadow_texture = 0;
};

/// In the current context. Error: the driver cannot hold a picture of that size.
Result<RenderTargets> make_render_targets(int width, int height);

}  // namespace mobil::inline v0_3
