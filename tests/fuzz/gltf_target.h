#pragma once
// A glTF or GLB file with its data inside.

#include "tests/fuzz/mesh_target.h"

namespace mobil::fuzz {

inline void fuzz_gltf(Input input) {
  check_mesh(read_mesh_bytes(text_of(input), "a.gltf"));
}

}  // namespace mobil::fuzz
