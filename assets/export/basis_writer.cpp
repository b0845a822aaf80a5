#include <mobil/basis_writer.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include <mobil/assets/files/output_file.h>
#include "assets/export/gltf_buffers.h"
#include "assets/export/mesh_shading.h"

namespace mobil::inline v0_3 {
namespace {

bool all_finite(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

Result<void> check(const BasisRecording& recording) {
  if (recording.weight.empty() || recording.target.empty()) {
    return fail("there is nothing to write: record a frame of one vector at least");
  }
  for (const auto& target : recording.target) {
    if (target.size() != 3 * recording.mesh.node.size() || !all_finite(target)) {
      return fail("a vector does not have three finite numbers for each node");
    }
  }
  for (std::size_t f = 0; f < recording.weight.size(); ++f) {
    if (recording.weight[f].size() != recording.target.size() || !all_finite(recording.weight[f])) {
      return fail(fmt::format("frame {} does not have a finite weight for each vector", f));
    }
  }
  return {};
}

/// The boundary's nodes, each once, and its triangles as places in that list.
struct Skin {
  std::vector<std::uint32_t> node, triangle;
};

Skin skin_of(const HexahedralMesh& mesh) {
  constexpr std::uint32_t unused = UINT32_MAX;
  Skin skin;
  std::vector<std::uint32_t> place(mesh.node.size(), unused);
  for (const Quad& quad : boundary_quads(mesh.cells)) {
    for (const std::size_t corner : {0U, 1U, 2U, 0U, 2U, 3U}) {
      std::uint32_t& at = place[quad[corner]];
      if (at == unused) {
        at = static_cast<std::uint32_t>(skin.node.size());
        skin.node.push_back(quad[corner]);
      }
      skin.triangle.push_back(at);
    }
  }
  return skin;
}

/// Returns the factor of each target, by which its weights are divided.
std::vector<float> largest_weights(const BasisRecording& recording) {
  std::vector<float> largest(recording.target.size(), 0.0F);
  for (const auto& frame : recording.weight) {
    for (std::size_t t = 0; t < frame.size(); ++t) largest[t] = std::max(largest[t], std::fabs(frame[t]));
  }
  for (float& w : largest) w = w > 0.0F ? w : 1.0F;
  return largest;
}

Result<std::string> encode(const BasisRecording& recording) {
  const Skin skin = skin_of(recording.mesh);
  const auto count = static_cast<Eigen::Index>(skin.node.size());
  Eigen::Matrix3Xd rest(3, count);
  for (Eigen::Index v = 0; v < count; ++v) {
    const Vec3<double>& p = recording.mesh.node[skin.node[static_cast<std::size_t>(v)]];
    rest.col(v) << p.x, p.y, p.z;
  }
  const Eigen::Matrix3Xd normal = vertex_normals(rest, skin.triangle);
  const auto scale = largest_weights(recording);

  GltfDraft draft;
  draft.model.asset.version = "2.0";
  draft.model.asset.generator = "mobil";
  tinygltf::Primitive shape;
  shape.mode = TINYGLTF_MODE_TRIANGLES;
  shape.attributes["POSITION"] = add_vertices(draft, rest.cast<float>(), true);
  shape.attributes["NORMAL"] = add_vertices(draft, normal.cast<float>(), false);
  shape.indices = add_indices(draft, skin.triangle, skin.node.size());
  tinygltf::Mesh mesh;
  mesh.name = "belly";
  tinygltf::Value::Array names;
  for (std::size_t t = 0; t < recording.target.size(); ++t) {
    Eigen::Matrix3Xf moved(3, count);
    for (Eigen::Index v = 0; v < count; ++v) {
      const float* const u = &recording.target[t][3 * std::size_t{skin.node[static_cast<std::size_t>(v)]}];
      moved.col(v) << u[0] * scale[t], u[1] * scale[t], u[2] * scale[t];
    }
    const Eigen::Matrix3Xd there = rest + moved.cast<double>();
    auto& attributes = shape.targets.emplace_back();
    attributes["POSITION"] = add_vertices(draft, moved, true);
    attributes["NORMAL"] = add_vertices(draft, (vertex_normals(there, skin.triangle) - normal).cast<float>(), false);
    names.emplace_back(fmt::format("vector_{}", t + 1));
    mesh.weights.push_back(static_cast<double>(recording.weight.front()[t] / scale[t]));
  }
  mesh.extras = tinygltf::Value(tinygltf::Value::Object{{"targetNames", tinygltf::Value(std::move(names))}});
  mesh.primitives.push_back(std::move(shape));
  draft.model.meshes.push_back(std::move(mesh));
  tinygltf::Node node;
  node.name = "belly";
  node.mesh = 0;
  draft.model.nodes.push_back(std::move(node));
  tinygltf::Scene scene;
  scene.nodes = {0};
  draft.model.scenes.push_back(std::move(scene));
  draft.model.defaultScene = 0;

  GltfAnimation motion;
  motion.animation.name = "motion";
  motion.frames = recording.weight.size();
  motion.frame_s = recording.frame_s;
  std::vector<float> weights;
  for (const auto& frame : recording.weight) {
    for (std::size_t t = 0; t < frame.size(); ++t) weights.push_back(frame[t] / scale[t]);
  }
  add_channel(draft, motion, 0, "weights", weights, TINYGLTF_TYPE_SCALAR);
  draft.model.animations.push_back(std::move(motion.animation));
  return glb_bytes(draft);
}

}  // namespace

Result<void> write_basis_glb(const std::filesystem::path& path, const BasisRecording& recording) {
  if (auto ok = check(recording); !ok) return fail(fmt::format("{}: {}", path.string(), ok.error().message));
  const auto bytes = encode(recording);
  if (!bytes) return fail(fmt::format("{}: {}", path.string(), bytes.error().message));
  return write_file(path, *bytes);
}

}  // namespace mobil::inline v0_3
