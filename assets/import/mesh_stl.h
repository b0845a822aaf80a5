#pragma once
// STL, as text or binary.

#include <string_view>

#include <mobil/engine/error.h>
#include <mobil/mesh_file.h>

namespace mobil::inline v0_3 {

/// A file is binary if it is at least as long as its count of facets requires, whatever it begins with; text begins
/// with "solid" or a comment of `#`. Less than a facet, or zeros, can follow. Normals and attributes are skipped.
/// Messages begin with `path`. Fails as read_mesh.
Result<MeshFile> read_stl(std::string_view bytes, std::string_view path);

}  // namespace mobil::inline v0_3
