#pragma once
// Wavefront OBJ.

#include <string_view>

#include <mobil/engine/error.h>
#include <mobil/mesh_file.h>

namespace mobil::inline v0_3 {

/// Vertices and faces; all other statements of the format are passed over. A vertex has three numbers, a weight of 1
/// after them or not, and a colour after them or not. Messages begin with `path`; see read_mesh for what fails, which
/// also is a statement that OBJ does not have.
Result<MeshFile> read_obj(std::string_view bytes, std::string_view path);

}  // namespace mobil::inline v0_3
