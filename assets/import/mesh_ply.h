#pragma once
// PLY, as text or binary of either byte order.

#include <string_view>

#include <mobil/engine/error.h>
#include <mobil/mesh_file.h>

namespace mobil::inline v0_3 {

/// Requires the elements vertex (x, y, z) and face or tristrips (a list vertex_indices or vertex_index); all others are
/// skipped. A
/// text has one item a line. Messages begin with `path`. Fails as read_mesh, and on fewer or more data than the header
/// promises.
Result<MeshFile> read_ply(std::string_view bytes, std::string_view path);

}  // namespace mobil::inline v0_3
