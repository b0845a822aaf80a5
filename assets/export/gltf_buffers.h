#pragma once
// Numbers on their way into a GLB: three growing byte arrays and the accessors that point into them.

#include <tiny_gltf.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/error.h"

namespace mobil {

/// A model whose accessors' `bufferView` is one of the three arrays until pack_buffers has run.
struct GltfDraft {
  tinygltf::Model model;
  std::vector<unsigned char> vertices, indices, keys;
};

/// Each adds one accessor and returns its number. Vertices: VEC3 floats; `with_bounds` writes min and max, which
/// positions (morphed ones too) and key times must have. Indices: 16 bits wide where `vertex_count` allows it.
int add_vertices(GltfDraft& draft, const Eigen::Matrix3Xf& column, bool with_bounds);
int add_indices(GltfDraft& draft, const std::vector<std::uint32_t>& triangle, std::size_t vertex_count);
/// `type` is TINYGLTF_TYPE_SCALAR, _VEC3 or _VEC4.
int add_keys(GltfDraft& draft, const std::vector<float>& value, int type, bool with_bounds);

/// Joins the three arrays into the one buffer of a GLB, a view for each that is not empty. Error: more than 2 GiB.
Result<void> pack_buffers(GltfDraft& draft);

}  // namespace mobil
