#pragma once
// Wavefront OBJ.

#include <string_view>

#include <mobil/engine/error.h>
#include <mobil/mesh_file.h>

namespace mobil::inline v0_3 {

/// Reads vertices and faces; all other statements of the format are skipped. A skipped line takes no statement with it.
/// A vertex has three numbers, then optionally a weight of 1 and a colour. Messages begin with `path`. Fails as
/// read_mesh, and on a statement that OBJ does not have.
Result<MeshFile> read_obj(std::string_view bytes, std::string_view path);

}  // namespace mobil::inline v0_3
