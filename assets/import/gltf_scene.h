#pragma once
// A glTF file through assimp, in this process. Call it in a process that can be lost.

#include <string>

#include <mobil/engine/error.h>
#include "assets/import/mesh_join.h"

namespace mobil::inline v0_3 {

/// Registers only the importers of glTF, and opens only files below the mesh's folder. Fails with a line that lacks the
/// path.
Result<RawMesh> read_gltf_scene(const std::string& path);

}  // namespace mobil::inline v0_3
