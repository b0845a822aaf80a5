#include "assets/import/gltf_scene.h"

#include <assimp/BaseImporter.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <assimp/DefaultIOSystem.h>
#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <filesystem>
#include <set>
#include <system_error>
#include <vector>

#include "assets/import/mesh_text.h"

namespace mobil::inline v0_3 {
namespace {

/// Opens only regular files of one folder, for reading.
class FolderFiles : public Assimp::DefaultIOSystem {
 public:
  explicit FolderFiles(const std::filesystem::path& file) : folder_(resolved(file).parent_path()) {}

  Assimp::IOStream* Open(const char* file, const char* mode) override {
    const auto path = resolved(file);
    std::error_code error;
    const bool inside = (path.parent_path() / "").native().starts_with((folder_ / "").native());
    const bool small =
        std::filesystem::is_regular_file(path, error) && std::filesystem::file_size(path, error) <= max_mesh_bytes;
    if (!inside || !small || mode == nullptr || mode[0] != 'r') return nullptr;
    return DefaultIOSystem::Open(path.c_str(), mode);
  }

 private:
  static std::filesystem::path resolved(const std::filesystem::path& file) {
    std::error_code error;
    auto path = std::filesystem::canonical(file, error);
    return error ? std::filesystem::path() : path;
  }
  std::filesystem::path folder_;
};

void leave_gltf_alone(Assimp::Importer& importer) {
  std::vector<Assimp::BaseImporter*> others;
  for (std::size_t i = 0; i < importer.GetImporterCount(); ++i) {
    std::set<std::string> extensions;
    importer.GetImporter(i)->GetExtensionList(extensions);
    if (!extensions.contains("gltf")) others.push_back(importer.GetImporter(i));
  }
  for (auto* other : others) importer.UnregisterLoader(other);
}

Result<void> add_scene_mesh(const aiMesh& mesh, const aiMatrix4x4& transform, RawMesh& raw) {
  const auto first = static_cast<std::uint32_t>(raw.position.size());
  if (raw.position.size() + mesh.mNumVertices > 3 * max_mesh_triangles) {
    return fail(fmt::format("more than {} vertices; make the mesh coarser in a mesh editor", 3 * max_mesh_triangles));
  }
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    const aiVector3D p = transform * mesh.mVertices[i];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      return fail(
          fmt::format("vertex {} is at ({}, {}, {}); every coordinate must be a finite number: export the mesh "
                      "again",
                      i + 1, p.x, p.y, p.z));
    }
    raw.position.push_back({p.x, p.y, p.z});
  }
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices < 3) {
      return fail(fmt::format("face {} has {} corners, it needs three or more; export the mesh as triangles", f + 1,
                              face.mNumIndices));
    }
    for (unsigned c = 0; c < face.mNumIndices; ++c) {
      if (face.mIndices[c] >= mesh.mNumVertices) {
        return fail(fmt::format("face {}: vertex {} is out of range; valid: 0 to {}: export the mesh again", f + 1,
                                face.mIndices[c], static_cast<std::int64_t>(mesh.mNumVertices) - 1));
      }
    }
    if (raw.triangle.size() + 3 * (face.mNumIndices - 2) > 3 * max_mesh_triangles) {
      return fail(fmt::format("more than {} triangles; make the mesh coarser in a mesh editor", max_mesh_triangles));
    }
    for (unsigned c = 2; c < face.mNumIndices; ++c) {
      for (const unsigned v : {face.mIndices[0], face.mIndices[c - 1], face.mIndices[c]}) {
        raw.triangle.push_back(first + v);
      }
    }
  }
  return {};
}

Result<void> add_scene_node(const aiScene& scene, const aiNode& node, const aiMatrix4x4& parent, RawMesh& raw) {
  const aiMatrix4x4 transform = parent * node.mTransformation;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    if (auto added = add_scene_mesh(*scene.mMeshes[node.mMeshes[i]], transform, raw); !added) return added;
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) {
    if (auto added = add_scene_node(scene, *node.mChildren[i], transform, raw); !added) return added;
  }
  return {};
}

}  // namespace

Result<RawMesh> read_gltf_scene(const std::string& path) {
  Assimp::Importer importer;
  leave_gltf_alone(importer);
  importer.SetIOHandler(new FolderFiles(path));  // the importer deletes it
  // No post-processing, because it trusts indices, which are only checked here.
  const aiScene* scene = importer.ReadFile(path, 0);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    return fail(fmt::format("cannot be read as glTF ({}); copy or export it again", shown(importer.GetErrorString())));
  }
  RawMesh raw;
  if (auto added = add_scene_node(*scene, *scene->mRootNode, aiMatrix4x4(), raw); !added) {
    return tl::unexpected(added.error());
  }
  return raw;
}

}  // namespace mobil::inline v0_3
