#pragma once
// Buffers of a glTF: in the file, in a uri, or in a file of its folder.

#include <string_view>

#include "assets/import/gltf_file.h"

namespace mobil::inline v0_3 {

/// Returns the bytes of an element of bufferViews; reads its buffer at the first use.
std::string_view gltf_view(GltfFile& file, const GltfItem& view);

}  // namespace mobil::inline v0_3
