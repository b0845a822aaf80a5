#pragma once
// One mesh file of any format that assimp reads, as triangles by index, or one line that says what is wrong with it.

#include <cstddef>
#include <string>

#include "components/surface.h"
#include "engine/error.h"

namespace mobil {

/// A mesh in its file's own units and axes. Corners with the same coordinates are one vertex; polygons are cut into
/// triangles; triangles with two equal corners are left out of the mesh but counted in `triangles_in_file`.
struct MeshFile {
  SurfaceMesh mesh;
  std::size_t triangles_in_file = 0;
};

/// Reads every mesh in the file, its nodes' transforms applied. Fails with one line that begins with the path for: a
/// missing file, one assimp cannot read, an index out of range, a face with fewer than three corners, no triangle,
/// a coordinate that is not finite.
Result<MeshFile> read_mesh(const std::string& path);

/// Edges by how many triangles use them: one (a border), or more than two (not a surface).
struct EdgeCount {
  std::size_t border = 0, overused = 0;
};
EdgeCount count_edges(const SurfaceMesh& mesh);

}  // namespace mobil
