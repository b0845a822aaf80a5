#pragma once
// One mesh file as triangles by index, or one line that says what is wrong with it. Nothing of a file is trusted.

#include <cstddef>
#include <string>
#include <string_view>

#include <mobil/assets/import/mesh_edges.h>  // IWYU pragma: export
#include <mobil/components/surface.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// A mesh in its file's own units and axes. Corners with the same coordinates are one vertex; polygons are cut into
/// triangles; triangles with two equal corners are left out of the mesh but counted in `triangles_in_file`.
struct MeshFile {
  SurfaceMesh mesh;
  std::size_t triangles_in_file = 0;
};

/// What a file may hold at most.
inline constexpr std::size_t max_mesh_bytes = 256'000'000, max_mesh_triangles = 5'000'000;

/// Reads .obj, .stl, .ply, .gltf or .glb, told by the name's end in any case, and nothing else. Fails with one line
/// that begins with the path, and names the line where the file has lines, for: a missing file, another format, a file
/// over the limits, one that does not keep to its format's grammar, a number that is not one, an index out of range, a
/// face with fewer than three corners, no triangle. glTF is read in a process of its own; see read_gltf.
Result<MeshFile> read_mesh(const std::string& path);

/// The same of bytes in memory: OBJ, STL or PLY, by the end of `path`, which also begins the messages.
Result<MeshFile> read_mesh_bytes(std::string_view bytes, const std::string& path);

}  // namespace mobil::inline v0_3
