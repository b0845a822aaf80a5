#pragma once
// STL, as text or binary.

#include <string_view>

#include <mobil/engine/error.h>
#include <mobil/mesh_file.h>

namespace mobil::inline v0_3 {

/// Binary is what is as long as its count of facets says, whatever it begins with; text begins with "solid". Normals
/// and attributes are passed over. Messages begin with `path`; see read_mesh for what fails.
Result<MeshFile> read_stl(std::string_view bytes, std::string_view path);

}  // namespace mobil::inline v0_3
