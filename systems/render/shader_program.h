#pragma once
// One program on the graphics device. It lives as long as the context it was made in.

#include <string>

#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

struct ShaderProgram {
  unsigned id = 0;
  int albedo = -1, outward = -1, width = -1, radius = -1, opacity = -1;  // uniform locations; -1: the program has none
};

/// Compiles and links in the current context, binds the block "Frame" to 0 and the shadow map to texture unit 0.
/// Error: what the driver says, first line, with `name`.
Result<ShaderProgram> make_program(const char* name, const std::string& vertex_source,
                                   const std::string& fragment_source);

}  // namespace mobil::inline v0_3
