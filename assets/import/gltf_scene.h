#pragma once
// A glTF file through assimp, in this process: for a process that may be lost.

#include <string>

#include <mobil/engine/error.h>
#include "assets/import/mesh_join.h"

namespace mobil::inline v0_3 {

/// Only the importers of glTF are registered, and only files below the mesh's folder are opened. Fails with a line
/// that lacks the path.
Result<RawMesh> read_gltf_scene(const std::string& path);

}  // namespace mobil::inline v0_3
