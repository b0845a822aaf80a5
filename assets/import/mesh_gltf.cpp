#include "assets/import/mesh_gltf.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "assets/import/gltf_file.h"
#include "assets/import/mesh_join.h"
#include "engine/eigen.h"

namespace mobil::inline v0_3 {
namespace {

using Eigen::Affine3d;
using Eigen::Vector3d;
using nlohmann::json;

/// Nodes of a file with their places in the world.
struct GltfNodes {
  std::vector<std::size_t> order;  // parents before their children
  std::vector<bool> in_scene;
  std::vector<Affine3d> world;
};

Affine3d local_transform(const GltfItem& node) {
  Affine3d transform = Affine3d::Identity();
  if (std::array<double, 16> matrix{}; gltf_numbers(node, "matrix", matrix)) {
    transform.matrix() = Eigen::Map<Eigen::Matrix4d>(matrix.data());
    transform.makeAffine();
    return transform;
  }
  std::array<double, 3> move{}, scale{1, 1, 1};
  std::array<double, 4> turn{0, 0, 0, 1};
  gltf_numbers(node, "translation", move);
  gltf_numbers(node, "rotation", turn);
  gltf_numbers(node, "scale", scale);
  const Eigen::Quaterniond rotation(turn[3], turn[0], turn[1], turn[2]);
  if (!(rotation.norm() > 0)) gltf_fault(node, "its rotation is not a quaternion; export it again");
  transform.translate(Vector3d(move.data())).rotate(rotation.normalized()).scale(Vector3d(scale.data()));
  return transform;
}

/// Returns the roots of the scene; all roots without one.
std::vector<std::size_t> scene_roots(const GltfFile& file, const std::vector<bool>& is_child) {
  const auto named = gltf_whole({file.root, "file", 0}, "scene");
  if (named || gltf_count(file, "scenes") > 0) {
    const GltfItem scene = gltf_item(file, "scenes", named.value_or(0));
    auto roots = gltf_wholes(scene, "nodes");
    for (const std::size_t node : roots) {
      const GltfItem root = gltf_item(file, "nodes", node);
      if (is_child[node]) gltf_fault(root, "in a scene, and below another node; export it again");
    }
    return roots;
  }
  std::vector<std::size_t> roots;
  for (std::size_t node = 0; node < is_child.size(); ++node) {
    if (!is_child[node]) roots.push_back(node);
  }
  return roots;
}

GltfNodes place_nodes(const GltfFile& file) {
  const std::size_t count = gltf_count(file, "nodes");
  GltfNodes nodes{{}, std::vector<bool>(count), std::vector<Affine3d>(count)};
  std::vector<std::vector<std::size_t>> children(count);
  std::vector<bool> is_child(count);
  for (std::size_t node = 0; node < count; ++node) {
    const GltfItem item = gltf_item(file, "nodes", node);
    nodes.world[node] = local_transform(item);
    children[node] = gltf_wholes(item, "children");
    for (const std::size_t child : children[node]) {
      const GltfItem below = gltf_item(file, "nodes", child);
      if (is_child[child]) gltf_fault(below, "has two parents; export it again");
      is_child[child] = true;
    }
  }
  for (const std::size_t root : scene_roots(file, is_child)) nodes.in_scene[root] = true;
  for (std::size_t node = 0; node < count; ++node) {
    if (!is_child[node]) nodes.order.push_back(node);
  }
  for (std::size_t i = 0; i < nodes.order.size(); ++i) {
    const std::size_t node = nodes.order[i];
    for (const std::size_t child : children[node]) {
      nodes.world[child] = nodes.world[node] * nodes.world[child];
      nodes.in_scene[child] = nodes.in_scene[node];
      nodes.order.push_back(child);
    }
  }
  if (nodes.order.size() < count) throw GltfFault{"nodes that are their own ancestors; export it again"};
  return nodes;
}

/// Returns the matrices that take the vertices of a skinned mesh to their joints.
std::vector<Affine3d> joint_matrices(GltfFile& file, const GltfNodes& nodes, const GltfItem& skin) {
  std::vector<Affine3d> matrix;
  for (const std::size_t joint : gltf_wholes(skin, "joints")) {
    gltf_item(file, "nodes", joint);
    matrix.push_back(nodes.world[joint]);
  }
  const auto accessor = gltf_whole(skin, "inverseBindMatrices");
  if (!accessor) return matrix;
  if (gltf_accessor_count(file, *accessor) < matrix.size()) {
    gltf_fault(skin, "fewer inverseBindMatrices than joints; export it again");
  }
  const std::vector<float> inverse = gltf_floats(file, *accessor, 16);
  for (std::size_t j = 0; j < matrix.size(); ++j) {
    Affine3d bind;
    bind.matrix() = Eigen::Map<const Eigen::Matrix4f>(&inverse[16 * j]).cast<double>();
    bind.makeAffine();
    matrix[j] = matrix[j] * bind;
  }
  return matrix;
}

constexpr std::string_view different_counts = "attributes of a primitive have different counts; export it again";

/// A primitive's attributes, and its vertices as one node shows them.
struct Shown {
  const json& attributes;
  const GltfItem& mesh;
  std::vector<Vector3d> place;
  std::vector<bool> mirrored;  // for each vertex
};

std::optional<std::size_t> attribute(const Shown& shown, const std::string& name) {
  return gltf_whole({shown.attributes, shown.mesh.list, shown.mesh.index}, name.c_str());
}

/// Returns an attribute's numbers, of which every vertex has `width`.
std::vector<float> vertex_floats(GltfFile& file, const Shown& shown, std::size_t accessor, std::size_t width) {
  auto values = gltf_floats(file, accessor, width);
  if (values.size() != width * shown.place.size()) {
    gltf_fault(shown.mesh, different_counts);
  }
  return values;
}

/// Adds the morph targets by the node's weights, or else the mesh's.
void add_targets(GltfFile& file, const GltfItem& node, const json& primitive, Shown& shown) {
  const json* targets = gltf_member(primitive, "targets");
  if (targets == nullptr || !targets->is_array()) return;
  gltf_spend(file, shown.mesh, targets->size());
  std::vector<double> weight(targets->size());
  if (!gltf_numbers(node, "weights", weight)) gltf_numbers(shown.mesh, "weights", weight);
  for (std::size_t t = 0; t < weight.size(); ++t) {
    if (weight[t] == 0) continue;
    const auto accessor = gltf_whole({(*targets)[t], shown.mesh.list, shown.mesh.index}, "POSITION");
    if (!accessor) continue;
    const auto moved = vertex_floats(file, shown, *accessor, 3);
    for (std::size_t v = 0; v < shown.place.size(); ++v) {
      shown.place[v] += weight[t] * Eigen::Map<const Eigen::Vector3f>(&moved[3 * v]).cast<double>();
    }
  }
}

/// Four joints of each vertex, and their weights.
struct Influences {
  std::vector<float> weight;
  std::vector<std::uint32_t> joint;
};

/// Moves each vertex with the weighted mean of its joints' matrices, which decides whether it is mirrored.
void move_with_joints(GltfFile& file, const std::vector<Affine3d>& matrix, Shown& shown) {
  std::vector<Influences> sets;
  for (;;) {
    const auto joints = attribute(shown, fmt::format("JOINTS_{}", sets.size()));
    const auto weights = attribute(shown, fmt::format("WEIGHTS_{}", sets.size()));
    if (!joints || !weights) break;
    sets.push_back({vertex_floats(file, shown, *weights, 4), gltf_indices(file, *joints, 4)});
    if (sets.back().joint.size() != sets.back().weight.size()) gltf_fault(shown.mesh, different_counts);
  }
  shown.mirrored.assign(shown.place.size(), false);
  for (std::size_t v = 0; v < shown.place.size(); ++v) {
    Affine3d sum = Affine3d::Identity();
    sum.affine().setZero();
    double whole = 0;  // 1 within rounding
    for (const Influences& set : sets) {
      for (std::size_t i = 4 * v; i < 4 * v + 4; ++i) {
        if (set.weight[i] == 0) continue;
        const std::size_t joint = set.joint[i];
        if (joint >= matrix.size()) {
          gltf_fault(shown.mesh,
                     fmt::format("joint {}; valid: below {}, as its skin has: export it again", joint, matrix.size()));
        }
        const auto share = static_cast<double>(set.weight[i]);
        sum.affine() += share * matrix[joint].affine();
        whole += share;
      }
    }
    if (!(whole > 0)) continue;
    sum.affine() /= whole;
    shown.place[v] = sum * shown.place[v];
    shown.mirrored[v] = sum.linear().determinant() < 0;
  }
}

/// Adds the triangles of a primitive. A triangle is turned if most of its corners are mirrored.
void add_triangles(const Shown& shown, std::vector<std::uint32_t> corner, std::size_t mode, RawMesh& raw) {
  constexpr std::size_t triangles = 4, strip = 5;
  if (mode == triangles && corner.size() % 3 != 0) {
    gltf_fault(shown.mesh,
               fmt::format("{} corners of triangles; valid: a multiple of 3: export it again", corner.size()));
  }
  const std::size_t count = mode == triangles ? corner.size() / 3 : corner.size() < 3 ? 0 : corner.size() - 2;
  if (!has_room(raw, count)) {
    throw GltfFault{fmt::format("more than {} triangles; make the mesh coarser in a mesh editor", max_mesh_triangles)};
  }
  const auto first = static_cast<std::uint32_t>(raw.position.size());
  for (auto& vertex : corner) {
    if (vertex >= shown.place.size()) {
      gltf_fault(shown.mesh, fmt::format("vertex {} is out of range; valid: 0 to {}: export it again", vertex,
                                         static_cast<std::int64_t>(shown.place.size()) - 1));
    }
    vertex += first;
  }
  const std::size_t begin = raw.triangle.size();
  if (mode == triangles) {
    raw.triangle.insert(raw.triangle.end(), corner.begin(), corner.end());
  } else if (mode == strip) {
    add_strip(raw, corner);
  } else {
    for (std::size_t c = 2; c < corner.size(); ++c) {
      raw.triangle.insert(raw.triangle.end(), {corner[c - 1], corner[c], corner[0]});
    }
  }
  for (std::size_t t = begin; t < raw.triangle.size(); t += 3) {
    int mirrored = 0;
    for (std::size_t c = t; c < t + 3; ++c) mirrored += shown.mirrored[raw.triangle[c] - first] ? 1 : 0;
    if (mirrored >= 2) std::swap(raw.triangle[t], raw.triangle[t + 1]);
  }
}

/// A node, the place of its mesh, and the matrices of its skin.
struct ShownNode {
  const GltfItem& node;
  const Affine3d& world;
  const std::vector<Affine3d>* joints;  // null without a skin
};

void add_primitive(GltfFile& file, const ShownNode& by, const GltfItem& mesh, const json& primitive, RawMesh& raw) {
  const GltfItem item{primitive, mesh.list, mesh.index};
  gltf_spend(file, mesh, 100);  // its time, even if nothing is read
  const json* attributes = gltf_member(primitive, "attributes");
  const auto mode = *gltf_whole(item, "mode", 4);
  if (mode > 6) gltf_fault(mesh, fmt::format("a primitive of mode {}; valid: 0 to 6: export it again", mode));
  if (mode < 4 || attributes == nullptr) return;  // points and lines
  Shown shown{*attributes, mesh, {}, {}};
  const auto positions = attribute(shown, "POSITION");
  if (!positions) return;
  const json* extensions = gltf_member(primitive, "extensions");
  if (extensions != nullptr && gltf_member(*extensions, "KHR_draco_mesh_compression") != nullptr &&
      gltf_member(gltf_item(file, "accessors", *positions).value, "bufferView") == nullptr) {
    gltf_fault(mesh, "compressed by KHR_draco_mesh_compression; export it without");
  }
  const std::size_t count = gltf_accessor_count(file, *positions);
  if (raw.position.size() + count > 3 * max_mesh_triangles) {
    throw GltfFault{
        fmt::format("more than {} vertices; make the mesh coarser in a mesh editor", 3 * max_mesh_triangles)};
  }
  const auto values = gltf_floats(file, *positions, 3);
  for (std::size_t v = 0; v < count; ++v) {
    shown.place.push_back(Eigen::Map<const Eigen::Vector3f>(&values[3 * v]).cast<double>());
  }
  add_targets(file, by.node, primitive, shown);
  if (by.joints != nullptr) {
    move_with_joints(file, *by.joints, shown);
  } else {
    for (auto& p : shown.place) p = by.world * p;
    shown.mirrored.assign(count, by.world.linear().determinant() < 0);
  }
  std::vector<std::uint32_t> corner;
  if (const auto indices = gltf_whole(item, "indices")) {
    corner = gltf_indices(file, *indices, 1);
  } else {
    for (std::uint32_t v = 0; v < count; ++v) corner.push_back(v);
  }
  add_triangles(shown, std::move(corner), mode, raw);
  for (std::size_t v = 0; v < count; ++v) {
    const auto p = shown.place[v].cast<float>().eval();
    if (!p.allFinite()) {
      gltf_fault(mesh, fmt::format("vertex {} is at ({}, {}, {}); every coordinate must be a finite number: export the "
                                   "mesh again",
                                   v, p.x(), p.y(), p.z()));
    }
    raw.position.push_back({p.x(), p.y(), p.z()});
  }
}

/// Adds a line to `said` if a node stands for several copies of its mesh.
RawMesh read_scene(GltfFile& file, std::vector<std::string>& said) {
  const GltfNodes nodes = place_nodes(file);
  RawMesh raw;
  std::vector<std::vector<Affine3d>> joints(gltf_count(file, "skins"));
  for (const std::size_t index : nodes.order) {
    if (!nodes.in_scene[index]) continue;
    const GltfItem node = gltf_item(file, "nodes", index);
    const auto shown = gltf_whole(node, "mesh"), skinned = gltf_whole(node, "skin");
    if (!shown) continue;
    const GltfItem mesh = gltf_item(file, "meshes", *shown);
    const json* extensions = gltf_member(node.value, "extensions");
    if (said.empty() && extensions != nullptr && gltf_member(*extensions, "EXT_mesh_gpu_instancing") != nullptr) {
      said.push_back(
          fmt::format("nodes[{}] has copies of its mesh by EXT_mesh_gpu_instancing, which are not read", index));
    }
    if (skinned) {
      const GltfItem skin = gltf_item(file, "skins", *skinned);
      if (joints[*skinned].empty()) joints[*skinned] = joint_matrices(file, nodes, skin);
    }
    const json* primitives = gltf_member(mesh.value, "primitives");
    if (primitives == nullptr || !primitives->is_array()) gltf_fault(mesh, "no primitives; export it again");
    for (const json& primitive : *primitives) {
      add_primitive(file, {node, nodes.world[index], skinned ? &joints[*skinned] : nullptr}, mesh, primitive, raw);
    }
  }
  return raw;
}

}  // namespace

Result<MeshFile> read_gltf(std::string_view bytes, std::string_view path, const std::filesystem::path& folder) try {
  GltfFile file = open_gltf(bytes, folder);
  std::vector<std::string> said;
  RawMesh raw = read_scene(file, said);
  if (raw.triangle.empty()) {
    return fail(
        fmt::format("{}: its scene shows no triangle; export it with nodes, and triangles rather than points, "
                    "lines or curves",
                    path));
  }
  auto joined = join_mesh(std::move(raw), path);
  if (joined) joined->said.insert(joined->said.end(), said.begin(), said.end());
  return joined;
} catch (const GltfFault& fault) {
  return fail(fmt::format("{}: {}", path, fault.line));
} catch (const nlohmann::json::exception&) {
  return fail(fmt::format("{}: its JSON has a value of another kind than glTF; export it again", path));
}

}  // namespace mobil::inline v0_3
