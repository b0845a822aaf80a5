#pragma once
// Numbers on their way into a GLB: growing byte arrays and the accessors that point into them.

#include <tiny_gltf.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <mobil/assets/surfaces/texture_places.h>
#include <mobil/engine/error.h>
#include "engine/eigen.h"

namespace mobil::inline v0_3 {

/// A model whose accessors' `bufferView` is one of the arrays until glb_bytes has run. A view of vertices has one
/// stride, so that texture places (8 bytes) and joints (4) have arrays of their own.
struct GltfDraft {
  tinygltf::Model model;
  std::vector<unsigned char> vertices, texture, tangents, skin, indices, keys, binds;
};

/// Each adds one accessor and returns its number. Vertices: VEC3 floats; `with_bounds` writes min and max, which
/// positions (morphed ones too) and key times must have. Indices: 16 bits wide where `vertex_count` allows it.
int add_vertices(GltfDraft& draft, const Eigen::Matrix3Xf& column, bool with_bounds);
int add_indices(GltfDraft& draft, const std::vector<std::uint32_t>& triangle, std::size_t vertex_count);
/// VEC2 floats: along, around; or of an atlas to the right, down.
int add_texture_places(GltfDraft& draft, const std::vector<TexturePlace>& place);
/// VEC4 floats.
int add_tangents(GltfDraft& draft, const std::vector<std::array<float, 4>>& tangent);
/// Each vertex follows up to four joints of its skin; weights as bytes, which add up to 255.
struct SkinAccessors {
  int joints, weights;
};
SkinAccessors add_joints(GltfDraft& draft, const std::vector<std::array<std::uint8_t, 4>>& joint,
                         const std::vector<std::array<float, 4>>& weight);
/// `type` is TINYGLTF_TYPE_SCALAR, _VEC3 or _VEC4.
int add_keys(GltfDraft& draft, const std::vector<float>& value, int type, bool with_bounds);

/// Inverse bind matrices of a skin, sixteen numbers each, column by column.
int add_bind_matrices(GltfDraft& draft, const std::vector<float>& matrix);

/// An animation of so many frames, evenly in time; all its channels share one list of key times, made with the first.
struct GltfAnimation {
  tinygltf::Animation animation;
  std::size_t frames = 0;
  double frame_s = 0;
  int time_accessor = -1;
};

/// A channel of a node's `path` ("translation", "rotation", "weights"), linear between frames. `type` as add_keys.
void add_channel(GltfDraft& draft, GltfAnimation& animation, int node, const std::string& path,
                 const std::vector<float>& value, int type);

/// Joins the arrays into the one buffer of a GLB, a view for each that is not empty, and encodes it. Errors: more
/// than 2 GiB, names that are not UTF-8.
Result<std::string> glb_bytes(GltfDraft& draft);

}  // namespace mobil::inline v0_3
