#include "assets/export/gltf_buffers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <exception>
#include <limits>
#include <sstream>

namespace mobil::inline v0_3 {
namespace {

static_assert(std::endian::native == std::endian::little, "a GLB holds little-endian numbers");

enum Array : int {
  vertex_array,
  texture_array,
  tangent_array,
  byte_array,
  index_array,
  key_array,
  bind_array,
  sparse_array
};
constexpr std::size_t array_count = 8;

template <class T>
std::size_t append(std::vector<unsigned char>& bytes, const T* value, std::size_t count) {
  const std::size_t start = bytes.size(), size = count * sizeof(T);
  bytes.resize(start + (size + 3) / 4 * 4);
  if (size > 0) std::memcpy(bytes.data() + start, value, size);
  return start;
}

int add_accessor(GltfDraft& draft, Array array, std::size_t offset, std::size_t count, int component, int type) {
  tinygltf::Accessor accessor;
  accessor.bufferView = array;
  accessor.byteOffset = offset;
  accessor.count = count;
  accessor.componentType = component;
  accessor.type = type;
  draft.model.accessors.push_back(std::move(accessor));
  return static_cast<int>(draft.model.accessors.size()) - 1;
}

/// Adds four bytes a vertex.
int add_bytes(GltfDraft& draft, std::span<const std::byte> value, bool normalised) {
  const std::size_t offset = append(draft.bytes, value.data(), value.size());
  const int accessor = add_accessor(draft, byte_array, offset, value.size() / 4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE,
                                    TINYGLTF_TYPE_VEC4);
  draft.model.accessors.back().normalized = normalised;
  return accessor;
}

void set_bounds(tinygltf::Accessor& accessor, const float* value, std::size_t width) {
  for (std::size_t c = 0; c < width; ++c) {
    float low = value[c], high = value[c];
    for (std::size_t i = 1; i < accessor.count; ++i) {
      low = std::min(low, value[i * width + c]);
      high = std::max(high, value[i * width + c]);
    }
    accessor.minValues.push_back(static_cast<double>(low));
    accessor.maxValues.push_back(static_cast<double>(high));
  }
}

Result<void> check_size(std::size_t bytes) {
  if (bytes <= static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) return {};
  return fail("the recording makes more than the 2 GiB that a GLB holds; record fewer frames, people or triangles");
}

/// Joins the arrays.
Result<void> pack_buffers(GltfDraft& draft) {
  const std::array<std::vector<unsigned char>*, array_count> arrays = {&draft.vertices, &draft.texture, &draft.tangents,
                                                                       &draft.bytes,    &draft.indices, &draft.keys,
                                                                       &draft.binds,    &draft.sparse};
  constexpr std::array<int, array_count> target = {TINYGLTF_TARGET_ARRAY_BUFFER,
                                                   TINYGLTF_TARGET_ARRAY_BUFFER,
                                                   TINYGLTF_TARGET_ARRAY_BUFFER,
                                                   TINYGLTF_TARGET_ARRAY_BUFFER,
                                                   TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER,
                                                   0,
                                                   0,
                                                   0};
  constexpr std::array<std::size_t, array_count> stride = {
      3 * sizeof(float), 2 * sizeof(float), 4 * sizeof(float), 4, 0, 0, 0, 0};
  std::array<int, array_count> view_of{};
  std::size_t total = 0;
  for (const auto* array : arrays) total += array->size();
  if (total == 0) return {};
  if (auto ok = check_size(total); !ok) return ok;
  tinygltf::Buffer buffer;
  buffer.data.reserve(total);
  for (std::size_t a = 0; a < arrays.size(); ++a) {
    if (arrays[a]->empty()) continue;
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = buffer.data.size();
    view.byteLength = arrays[a]->size();
    view.target = target[a];
    view.byteStride = stride[a];
    view_of[a] = static_cast<int>(draft.model.bufferViews.size());
    draft.model.bufferViews.push_back(std::move(view));
    buffer.data.insert(buffer.data.end(), arrays[a]->begin(), arrays[a]->end());
    std::vector<unsigned char>().swap(*arrays[a]);
  }
  draft.model.buffers.push_back(std::move(buffer));
  const auto number = [&](int array) { return array < 0 ? -1 : view_of[static_cast<std::size_t>(array)]; };
  for (auto& accessor : draft.model.accessors) {
    accessor.bufferView = number(accessor.bufferView);
    if (!accessor.sparse.isSparse) continue;
    accessor.sparse.indices.bufferView = number(accessor.sparse.indices.bufferView);
    accessor.sparse.values.bufferView = number(accessor.sparse.values.bufferView);
  }
  return {};
}

}  // namespace

int add_vertices(GltfDraft& draft, const Eigen::Matrix3Xf& column, bool with_bounds) {
  const auto count = static_cast<std::size_t>(column.cols());
  const std::size_t offset = append(draft.vertices, column.data(), 3 * count);
  const int accessor =
      add_accessor(draft, vertex_array, offset, count, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3);
  if (with_bounds) set_bounds(draft.model.accessors.back(), column.data(), 3);
  return accessor;
}

int add_displacements(GltfDraft& draft, const Eigen::Matrix3Xf& column, bool with_bounds, float negligible) {
  std::vector<std::uint32_t> moved;
  Eigen::Matrix3Xf kept = Eigen::Matrix3Xf::Zero(3, column.cols());
  std::vector<float> values;
  for (Eigen::Index v = 0; v < column.cols(); ++v) {
    if (column.col(v).norm() <= negligible) continue;
    kept.col(v) = column.col(v);
    moved.push_back(static_cast<std::uint32_t>(v));
    values.insert(values.end(), {column(0, v), column(1, v), column(2, v)});
  }
  constexpr std::size_t dense_bytes = 12, sparse_bytes = 16;
  if (sparse_bytes * moved.size() >= dense_bytes * static_cast<std::size_t>(column.cols()))
    return add_vertices(draft, column, with_bounds);
  const int number = add_accessor(draft, vertex_array, 0, static_cast<std::size_t>(column.cols()),
                                  TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3);
  auto& accessor = draft.model.accessors.back();
  accessor.bufferView = -1;  // zeros
  if (with_bounds) set_bounds(accessor, kept.data(), 3);
  if (moved.empty()) return number;
  accessor.sparse.isSparse = true;
  accessor.sparse.count = static_cast<int>(moved.size());
  accessor.sparse.indices.bufferView = accessor.sparse.values.bufferView = sparse_array;
  accessor.sparse.indices.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  accessor.sparse.indices.byteOffset = static_cast<int>(append(draft.sparse, moved.data(), moved.size()));
  accessor.sparse.values.byteOffset = static_cast<int>(append(draft.sparse, values.data(), values.size()));
  return number;
}

int add_texture_places(GltfDraft& draft, const std::vector<TexturePlace>& place) {
  std::vector<float> value;
  value.reserve(2 * place.size());
  for (const TexturePlace& p : place) value.insert(value.end(), {p.along, p.around});
  const std::size_t offset = append(draft.texture, value.data(), value.size());
  return add_accessor(draft, texture_array, offset, place.size(), TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC2);
}

int add_tangents(GltfDraft& draft, const std::vector<std::array<float, 4>>& tangent) {
  const std::size_t offset = append(draft.tangents, tangent.data(), tangent.size());
  return add_accessor(draft, tangent_array, offset, tangent.size(), TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC4);
}

int add_tissue(GltfDraft& draft, std::span<const Tissue> tissue) {
  return add_bytes(draft, std::as_bytes(tissue), true);
}

int add_colours(GltfDraft& draft, std::span<const Vec3<float>> colour) {
  std::vector<std::uint8_t> bytes;
  const auto byte = [](float share) { return static_cast<std::uint8_t>(std::lround(255 * share)); };
  for (const Vec3<float>& c : colour) bytes.insert(bytes.end(), {byte(c.x), byte(c.y), byte(c.z), 255});
  return add_bytes(draft, std::as_bytes(std::span(bytes)), true);
}

std::array<float, 4> byte_weights(const std::array<float, 4>& weight) {
  const auto heaviest = static_cast<std::size_t>(std::ranges::max_element(weight) - weight.begin());
  std::array<float, 4> rounded{};
  float left = 255;
  for (std::size_t k = 4; k-- > 0;) {
    if (k == heaviest) continue;
    const float share = std::min(left, std::round(255 * weight[k]));
    left -= share;
    rounded[k] = share / 255;
  }
  rounded[heaviest] = left / 255;  // takes the rounding error
  return rounded;
}

SkinAccessors add_joints(GltfDraft& draft, const std::vector<std::array<std::uint8_t, 4>>& joint,
                         const std::vector<std::array<float, 4>>& weight) {
  std::vector<std::uint8_t> joints(4 * joint.size(), 0), weights(4 * joint.size(), 0);
  for (std::size_t v = 0; v < joint.size(); ++v) {
    const std::array<float, 4> rounded = byte_weights(weight[v]);
    for (std::size_t k = 0; k < 4; ++k) {
      weights[4 * v + k] = static_cast<std::uint8_t>(std::lround(255 * rounded[k]));
      joints[4 * v + k] = weights[4 * v + k] == 0 ? std::uint8_t{0} : joint[v][k];
    }
  }
  return {add_bytes(draft, std::as_bytes(std::span(joints)), false),
          add_bytes(draft, std::as_bytes(std::span(weights)), true)};
}

int add_indices(GltfDraft& draft, const std::vector<std::uint32_t>& triangle, std::size_t vertex_count) {
  if (vertex_count > 65535) {  // index 65535 itself restarts a primitive
    const std::size_t offset = append(draft.indices, triangle.data(), triangle.size());
    return add_accessor(draft, index_array, offset, triangle.size(), TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                        TINYGLTF_TYPE_SCALAR);
  }
  std::vector<std::uint16_t> narrow;
  narrow.reserve(triangle.size());
  for (const auto i : triangle) narrow.push_back(static_cast<std::uint16_t>(i));
  const std::size_t offset = append(draft.indices, narrow.data(), narrow.size());
  return add_accessor(draft, index_array, offset, narrow.size(), TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
                      TINYGLTF_TYPE_SCALAR);
}

int add_keys(GltfDraft& draft, const std::vector<float>& value, int type, bool with_bounds) {
  const auto width = static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type)));
  const std::size_t offset = append(draft.keys, value.data(), value.size());
  const int accessor =
      add_accessor(draft, key_array, offset, value.size() / width, TINYGLTF_COMPONENT_TYPE_FLOAT, type);
  if (with_bounds) set_bounds(draft.model.accessors.back(), value.data(), width);
  return accessor;
}

int add_bind_matrices(GltfDraft& draft, const std::vector<float>& matrix) {
  const std::size_t offset = append(draft.binds, matrix.data(), matrix.size());
  return add_accessor(draft, bind_array, offset, matrix.size() / 16, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_MAT4);
}

void add_channel(GltfDraft& draft, GltfAnimation& animation, int node, const std::string& path,
                 const std::vector<float>& value, int type) {
  const auto width = static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type)));
  const bool constant = animation.frames > 1 && value.size() == width && path != "weights";
  int& times = constant ? animation.ends : animation.all_times;
  if (times < 0) {
    std::vector<float> time_s;
    for (std::size_t f = 0; f < animation.frames; f += constant ? animation.frames - 1 : 1) {
      time_s.push_back(static_cast<float>(static_cast<double>(f) * animation.frame_s));
    }
    times = add_keys(draft, time_s, TINYGLTF_TYPE_SCALAR, true);
  }
  std::vector<float> keys = value;
  if (constant) keys.insert(keys.end(), value.begin(), value.end());
  tinygltf::AnimationSampler sampler;
  sampler.input = times;
  sampler.output = add_keys(draft, keys, type, false);
  sampler.interpolation = "LINEAR";
  tinygltf::AnimationChannel channel;
  channel.sampler = static_cast<int>(animation.animation.samplers.size());
  channel.target_node = node;
  channel.target_path = path;
  animation.animation.samplers.push_back(std::move(sampler));
  animation.animation.channels.push_back(std::move(channel));
}

Result<std::string> glb_bytes(GltfDraft& draft) {
  if (auto ok = pack_buffers(draft); !ok) return tl::unexpected(ok.error());
  std::ostringstream bytes(std::ios::binary);
  try {
    if (!tinygltf::TinyGLTF().WriteGltfSceneToStream(&draft.model, bytes, false, true)) {
      return fail("the glTF library could not encode the recording");
    }
  } catch (const std::exception& e) {  // its JSON library refuses names that are not UTF-8
    return fail(fmt::format("a name cannot be written, it must be UTF-8 text ({})", e.what()));
  }
  std::string text = std::move(bytes).str();
  if (auto ok = check_size(text.size()); !ok) return tl::unexpected(ok.error());  // includes names and numbers
  return text;
}

}  // namespace mobil::inline v0_3
