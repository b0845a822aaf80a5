#pragma once
// glTF and GLB, read by assimp where it can do no harm.

#include <string>

#include <mobil/engine/error.h>
#include <mobil/mesh_file.h>

namespace mobil::inline v0_3 {

/// Every mesh in the file, its nodes' transforms applied, in the file's own units and axes. A process of its own reads
/// it, with at most 10 s of processor time, 15 s of wall time and 2 GB of memory; it writes no file, and opens only
/// files of the mesh's own folder. One that dies or is slow is a refusal. Files are read one at a time. Where a program
/// cannot fork (Windows), every file is refused. Messages begin with the path.
Result<MeshFile> read_gltf(const std::string& path);

}  // namespace mobil::inline v0_3
