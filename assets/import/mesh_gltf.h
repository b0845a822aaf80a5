#pragma once
// glTF and GLB, read by assimp in isolation.

#include <string>

#include <mobil/engine/error.h>
#include <mobil/mesh_file.h>

namespace mobil::inline v0_3 {

/// Reads every mesh in the file with its nodes' transforms applied, in the file's own units and axes. A separate
/// process reads it, with at most 10 s of processor time, 15 s of wall time and 2 GB of memory. It writes no file, and
/// opens only files of the mesh's own folder. If it dies or is slow, the file is refused. Files are read one at a time.
/// Without fork (Windows), every file is refused. Messages begin with the path.
Result<MeshFile> read_gltf(const std::string& path);

}  // namespace mobil::inline v0_3
