#pragma once
// glTF 2.0, as text or GLB, whichever the bytes are.

#include <filesystem>
#include <string_view>

#include <mobil/engine/error.h>
#include <mobil/mesh_file.h>

namespace mobil::inline v0_3 {

/// Reads the triangles of the default scene (or the first, or all nodes without a scene) in place: node transforms,
/// skins with their joints as they stand, morph targets with their default weights. Points, lines, materials and images
/// are skipped. KHR_mesh_quantization is the only extension of meshes that is read. Buffers are in the bytes, in
/// data uris, or in files of `folder` and below; without a folder none is opened. Messages begin with `path`. Fails as
/// read_mesh.
Result<MeshFile> read_gltf(std::string_view bytes, std::string_view path, const std::filesystem::path& folder);

}  // namespace mobil::inline v0_3
