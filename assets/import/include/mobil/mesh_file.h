#pragma once
// Reads one mesh file as indexed triangles, or fails with one line. Files are not trusted.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <mobil/assets/import/mesh_edges.h>  // IWYU pragma: export
#include <mobil/components/surface.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// A mesh in its file's own units and axes. Corners with the same coordinates are one vertex, and polygons are cut into
/// triangles within them. Triangles with two equal corners are left out of the mesh but counted in `triangles_in_file`.
struct MeshFile {
  SurfaceMesh mesh;
  std::size_t triangles_in_file = 0;
  std::vector<std::string> said;  // lines about faces that cross themselves, and copies that are not read
};

/// Maximum size and number of triangles of a file.
inline constexpr std::size_t max_mesh_bytes = 256'000'000, max_mesh_triangles = 5'000'000;

/// Reads .obj, .stl, .ply, .gltf or .glb, by the name's ending in any case. Fails with one line that begins with the
/// path, and with the line number where the file has lines: on a missing file, another format, a file over the limits;
/// an error in its format's grammar, an invalid number, an index out of range; a face with fewer than three corners, or
/// no triangle. A glTF can refer to files of its own folder and below.
Result<MeshFile> read_mesh(const std::string& path);

/// Reads bytes in memory, by the ending of `path`, which also begins the messages. A glTF must have its data inside.
Result<MeshFile> read_mesh_bytes(std::string_view bytes, const std::string& path);

}  // namespace mobil::inline v0_3
