#pragma once
// One program on the graphics device, valid as long as the context in which it was made.

#include <string>

#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// A program and the locations of its uniforms, -1 for those that it lacks.
struct ShaderProgram {
  unsigned id = 0;
  int albedo = -1, tendon_albedo = -1, fibres = -1, outward = -1, width = -1, radius = -1, opacity = -1;
};

/// Compiles and links a program in the current context, and binds the block "Frame" to 0 and the shadow map to texture
/// unit 0. Errors: the first line of the driver's message, with `name`.
Result<ShaderProgram> make_program(const char* name, const std::string& vertex_source,
                                   const std::string& fragment_source);

}  // namespace mobil::inline v0_3
