#pragma once
// Numbers of a GLB: growing byte arrays and the accessors into them.

#include <tiny_gltf.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <mobil/assets/surfaces/texture_places.h>
#include <mobil/components/surface.h>
#include <mobil/engine/error.h>
#include "engine/eigen.h"

namespace mobil::inline v0_3 {

/// A model whose accessors' `bufferView` is one of the arrays until glb_bytes has run. A view of vertices has one
/// stride, so texture places (8 bytes) and `bytes` (4: joints, weights, tissue, colours) have separate arrays.
struct GltfDraft {
  tinygltf::Model model;
  std::vector<unsigned char> vertices, texture, tangents, bytes, indices, keys, binds, sparse;
};

/// Each adds one accessor and returns its number. Vertices are VEC3 floats; `with_bounds` writes min and max, which
/// positions (including morphed ones) and key times must have. Indices are 16 bits wide if `vertex_count` permits.
int add_vertices(GltfDraft& draft, const Eigen::Matrix3Xf& column, bool with_bounds);
/// Adds displacements of a morph target, only those of vertices that it moves by more than `negligible` (sparse) if
/// these are few.
int add_displacements(GltfDraft& draft, const Eigen::Matrix3Xf& column, bool with_bounds, float negligible);
int add_indices(GltfDraft& draft, const std::vector<std::uint32_t>& triangle, std::size_t vertex_count);
/// Adds VEC2 floats: along and around, or in an atlas right and down.
int add_texture_places(GltfDraft& draft, const std::vector<TexturePlace>& place);
/// Adds VEC4 unsigned bytes, normalised.
int add_tissue(GltfDraft& draft, std::span<const Tissue> tissue);
/// Adds VEC4 unsigned bytes, normalised: linear colours and full opacity.
int add_colours(GltfDraft& draft, std::span<const Vec3<float>> colour);
/// Adds VEC4 floats.
int add_tangents(GltfDraft& draft, const std::vector<std::array<float, 4>>& tangent);
/// Returns weights as a GLB has them, multiples of 1/255 that add up to 1.
std::array<float, 4> byte_weights(const std::array<float, 4>& weight);
/// Accessors for vertices that follow up to four joints of their skin; weights are bytes, which add up to 255.
struct SkinAccessors {
  int joints, weights;
};
SkinAccessors add_joints(GltfDraft& draft, const std::vector<std::array<std::uint8_t, 4>>& joint,
                         const std::vector<std::array<float, 4>>& weight);
/// `type` is TINYGLTF_TYPE_SCALAR, _VEC3 or _VEC4.
int add_keys(GltfDraft& draft, const std::vector<float>& value, int type, bool with_bounds);

/// Adds the inverse bind matrices of a skin, sixteen numbers each, column by column.
int add_bind_matrices(GltfDraft& draft, const std::vector<float>& matrix);

/// An animation of frames evenly spaced in time. Channels with a key per frame share one list of key times, constant
/// ones another list of the first and the last time. Each is made at first use.
struct GltfAnimation {
  tinygltf::Animation animation;
  std::size_t frames = 0;
  double frame_s = 0;
  int all_times = -1, ends = -1;
};

/// Adds a channel of a node's `path` ("translation", "rotation", "weights"), linear between frames. `value` has a key
/// for each frame, or one for a constant channel. `type` as add_keys.
void add_channel(GltfDraft& draft, GltfAnimation& animation, int node, const std::string& path,
                 const std::vector<float>& value, int type);

/// Joins the arrays into the one buffer of a GLB, a view for each that is not empty, and encodes it. Fails beyond 2
/// GiB, or on names that are not UTF-8.
Result<std::string> glb_bytes(GltfDraft& draft);

}  // namespace mobil::inline v0_3
