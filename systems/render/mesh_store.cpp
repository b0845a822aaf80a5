#include "systems/render/mesh_store.h"

#include <GLES3/gl3.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "systems/render/vertex_normals.h"

namespace mobil::inline v0_3 {
namespace {

template <class T>
void send(GLenum target, GLuint buffer, const std::vector<T>& data, GLenum usage) {
  glBindBuffer(target, buffer);
  glBufferData(target, static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data(), usage);
}

Result<void> check(const DrawMesh& mesh) {
  if (mesh.triangle.size() % 3 != 0) {
    return fail(
        fmt::format("a mesh to draw has {} triangle indices; give three for each triangle", mesh.triangle.size()));
  }
  if (std::max(mesh.triangle.size(), mesh.position.size()) > std::numeric_limits<std::int32_t>::max() / 16) {
    return fail(fmt::format("a mesh to draw has {} vertices and {} indices; at most {} of either, split it",
                            mesh.position.size(), mesh.triangle.size(), std::numeric_limits<std::int32_t>::max() / 16));
  }
  if (!mesh.normal.empty() && mesh.normal.size() != mesh.position.size()) {
    return fail(fmt::format("a mesh to draw has {} normals for {} vertices; give one for each, or none",
                            mesh.normal.size(), mesh.position.size()));
  }
  if (!mesh.tissue.empty() && mesh.tissue.size() != mesh.position.size()) {
    return fail(fmt::format("a mesh to draw has the tissue of {} vertices, and {} vertices; give one for each, or none",
                            mesh.tissue.size(), mesh.position.size()));
  }
  const auto highest = std::max_element(mesh.triangle.begin(), mesh.triangle.end());
  if (highest != mesh.triangle.end() && *highest >= mesh.position.size()) {
    return fail(fmt::format("a triangle to draw names vertex {} of a mesh with {} vertices; indices count from 0",
                            *highest, mesh.position.size()));
  }
  return {};
}

/// Appends the mesh's positions, normals and tissue to `out`, for a wireframe positions and normals of each corner.
void append(const DrawMesh& mesh, std::span<const Vec3<float>> normal, std::vector<Vec3<float>>& out,
            StoredMesh& stored) {
  const auto add = [&](const auto& values) {
    const std::size_t at = out.size() * sizeof(Vec3<float>);
    if (mesh.wireframe) {
      for (const std::uint32_t v : mesh.triangle) out.push_back(values[v]);
    } else {
      out.insert(out.end(), values.begin(), values.end());
    }
    return at;
  };
  stored.position_at = add(mesh.position);
  stored.normal_at = add(normal);
  stored.has_tissue = !mesh.tissue.empty() && !mesh.wireframe;
  if (stored.has_tissue) {
    const std::size_t bytes = mesh.tissue.size_bytes();
    stored.tissue_at = out.size() * sizeof(Vec3<float>);
    out.resize(out.size() + (bytes + sizeof(Vec3<float>) - 1) / sizeof(Vec3<float>));
    std::memcpy(reinterpret_cast<std::byte*>(out.data()) + stored.tissue_at, mesh.tissue.data(), bytes);
  }
  stored.count = static_cast<int>(mesh.triangle.size());
  for (const auto& p : mesh.position) stored.box.add(p);
}

}  // namespace

void MeshStore::create_buffers() {
  glGenBuffers(1, &stream_vertices_);
  glGenBuffers(1, &stream_indices_);
}

void MeshStore::begin_frame() {
  vertices_.clear();
  indices_.clear();
  last_places_ = nullptr;
}

Result<StoredMesh> MeshStore::place(const DrawMesh& mesh) {
  const Kept kept{mesh.key, mesh.wireframe};
  if (mesh.key != 0) {
    if (const auto found = kept_.find(kept); found != kept_.end()) return found->second;
  }
  if (const auto checked = check(mesh); !checked) return tl::unexpected(checked.error());
  std::span<const Vec3<float>> normal = mesh.normal;
  if (normal.empty()) {
    vertex_normals(mesh.position, mesh.triangle, normal_);
    normal = normal_;
  }
  StoredMesh stored;
  if (mesh.key == 0) {
    // Consecutive parts of one surface, with given normals, share its vertices.
    const bool again = !mesh.normal.empty() && !mesh.wireframe && last_places_ == mesh.position.data() &&
                       last_normals_ == mesh.normal.data();
    if (again) {
      stored = last_;
      stored.count = static_cast<int>(mesh.triangle.size());
    } else {
      append(mesh, normal, vertices_, stored);
    }
    stored.vertex_buffer = stream_vertices_;
    stored.index_buffer = stream_indices_;
    last_ = stored;
    last_places_ = mesh.wireframe ? nullptr : mesh.position.data();
    last_normals_ = mesh.normal.data();
    stored.index_at = indices_.size() * sizeof(std::uint32_t);
    if (!mesh.wireframe) indices_.insert(indices_.end(), mesh.triangle.begin(), mesh.triangle.end());
    return stored;
  }
  own_vertices_.clear();
  append(mesh, normal, own_vertices_, stored);
  glGenBuffers(1, &stored.vertex_buffer);
  send(GL_ARRAY_BUFFER, stored.vertex_buffer, own_vertices_, GL_STATIC_DRAW);
  if (!mesh.wireframe) {
    glGenBuffers(1, &stored.index_buffer);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, stored.index_buffer);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.triangle.size_bytes()), mesh.triangle.data(),
                 GL_STATIC_DRAW);
  }
  kept_.emplace(kept, stored);
  return stored;
}

void MeshStore::send_stream() {
  send(GL_ARRAY_BUFFER, stream_vertices_, vertices_, GL_STREAM_DRAW);
  send(GL_ELEMENT_ARRAY_BUFFER, stream_indices_, indices_, GL_STREAM_DRAW);
}

void MeshStore::forget(std::uint64_t key) {
  for (const bool wireframe : {false, true}) {
    const auto found = kept_.find({key, wireframe});
    if (found == kept_.end()) continue;
    glDeleteBuffers(1, &found->second.vertex_buffer);
    glDeleteBuffers(1, &found->second.index_buffer);
    kept_.erase(found);
  }
}

}  // namespace mobil::inline v0_3
