#include "assets/import/mesh_file.h"

#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <bit>
#include <cmath>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <string_view>
#include <unordered_map>

namespace mobil {
namespace {

struct Bits {
  std::array<std::uint32_t, 3> word;
  bool operator==(const Bits&) const = default;
};

struct BitsHash {
  std::size_t operator()(const Bits& b) const {
    std::uint64_t h = 0;
    for (const auto w : b.word) {
      h = (h ^ w) * 0x9E3779B97F4A7C15ULL;
      h ^= h >> 29U;
    }
    return static_cast<std::size_t>(h);
  }
};

class Gatherer {
 public:
  explicit Gatherer(std::string path) : path_(std::move(path)) {}

  Result<void> add_node(const aiScene& scene, const aiNode& node, const aiMatrix4x4& parent) {
    const aiMatrix4x4 transform = parent * node.mTransformation;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      if (auto added = add_mesh(*scene.mMeshes[node.mMeshes[i]], transform); !added) return added;
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) {
      if (auto added = add_node(scene, *node.mChildren[i], transform); !added) return added;
    }
    return {};
  }

  [[nodiscard]] std::size_t faces() const { return faces_; }
  MeshFile take() { return std::move(file_); }

 private:
  Result<void> add_mesh(const aiMesh& mesh, const aiMatrix4x4& transform) {
    std::vector<std::uint32_t> joined(mesh.mNumVertices);
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D& p = mesh.mVertices[i];
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
        return fail(fmt::format(
            "{}: vertex {} is ({}, {}, {}); every coordinate must be a finite number: export the mesh again", path_,
            i + 1, p.x, p.y, p.z));
      }
      joined[i] = vertex(transform * p);
    }
    faces_ += mesh.mNumFaces;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices < 3) {
        return fail(
            fmt::format("{}: face {} has {} corners, a face needs three or more; the file may be cut short: copy or "
                        "export it again",
                        path_, f + 1, face.mNumIndices));
      }
      for (unsigned c = 0; c < face.mNumIndices; ++c) {
        if (face.mIndices[c] >= mesh.mNumVertices) {
          return fail(fmt::format("{}: face {} names vertex {}, the file has {}; export the mesh again", path_, f + 1,
                                  face.mIndices[c] + 1, mesh.mNumVertices));
        }
      }
      for (unsigned c = 2; c < face.mNumIndices; ++c) {
        triangle(joined[face.mIndices[0]], joined[face.mIndices[c - 1]], joined[face.mIndices[c]]);
      }
    }
    return {};
  }

  std::uint32_t vertex(const aiVector3D& p) {
    const auto bits = [](float f) { return std::bit_cast<std::uint32_t>(f + 0.0F); };  // −0 becomes +0
    const Bits key{{bits(p.x), bits(p.y), bits(p.z)}};
    const auto [found, is_new] = index_.try_emplace(key, static_cast<std::uint32_t>(file_.mesh.position.size()));
    if (is_new) file_.mesh.position.push_back({p.x, p.y, p.z});
    return found->second;
  }

  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    ++file_.triangles_in_file;
    if (a == b || b == c || c == a) return;
    file_.mesh.triangle.insert(file_.mesh.triangle.end(), {a, b, c});
  }

  std::string path_;
  std::size_t faces_ = 0;
  MeshFile file_;
  std::unordered_map<Bits, std::uint32_t, BitsHash> index_;
};

std::string file_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// What assimp 5.2 takes without a word, or never returns from: a PLY whose header has no end, an ASCII STL cut short.
/// Of a PLY, the count of faces its header promises.
Result<std::optional<std::size_t>> check_ends(const std::string& path) {
  const auto cut_short = [&](std::string_view missing) {
    return fail(fmt::format("{}: no '{}' in it; the file is cut short: copy or export it again", path, missing));
  };
  std::array<char, 5> start{};
  std::ifstream(path, std::ios::binary).read(start.data(), start.size());
  const std::string_view magic(start.data(), start.size());
  if (magic.starts_with("ply")) {
    std::istringstream lines(file_text(path));
    std::size_t promised_lines = 0, faces = 0, data_lines = 0;
    bool ascii = false, ended = false;
    for (std::string line; !ended && std::getline(lines, line);) {
      std::istringstream words(line);
      std::string word, name;
      std::size_t count = 0;
      words >> word >> name >> count;
      ended = word == "end_header";
      ascii = ascii || (word == "format" && name == "ascii");
      if (word != "element") continue;
      promised_lines += count;
      if (name == "face") faces = count;
    }
    if (!ended) return cut_short("end_header");
    if (faces == 0) return fail(fmt::format("{}: its header promises no face; export it as triangles", path));
    for (std::string line; ascii && std::getline(lines, line);) data_lines += line.size() > 1 ? 1 : 0;
    if (ascii && data_lines < promised_lines) {
      return fail(
          fmt::format("{}: {} lines where its header promises {}; the file is cut short: copy or export it again", path,
                      data_lines, promised_lines));
    }
    return std::optional(faces);
  }
  if (magic == "solid") {
    constexpr std::size_t head = 84, facet = 50;
    const std::string text = file_text(path);
    std::uint32_t count = 0;
    if (text.size() >= head) std::memcpy(&count, text.data() + head - sizeof count, sizeof count);
    const bool binary = text.size() == head + facet * count;
    if (!binary && text.find("endsolid") == std::string::npos) return cut_short("endsolid");
  }
  return std::optional<std::size_t>();
}

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.empty() ? std::string("no reason given") : text;
}

}  // namespace

Result<MeshFile> read_mesh(const std::string& path) try {
  if (!std::filesystem::is_regular_file(path)) {
    return fail(fmt::format("{}: no such file; put the mesh there or take its row out of the manifest", path));
  }
  const auto promised_faces = check_ends(path);
  if (!promised_faces) return fail(promised_faces.error().message);
  Assimp::Importer importer;
  // No post-processing: it trusts indices, which are only checked here.
  const aiScene* scene = importer.ReadFile(path, 0);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    return fail(
        fmt::format("{}: cannot be read as a mesh ({}); expected an undamaged OBJ, STL, PLY or other format that "
                    "assimp reads: copy or export it again",
                    path, one_line(importer.GetErrorString())));
  }
  Gatherer gatherer(path);
  if (auto added = gatherer.add_node(*scene, *scene->mRootNode, aiMatrix4x4()); !added)
    return fail(added.error().message);
  if (*promised_faces && **promised_faces != gatherer.faces()) {
    return fail(fmt::format("{}: {} faces where its header promises {}; the file is cut short: copy or export it again",
                            path, gatherer.faces(), **promised_faces));
  }
  MeshFile file = gatherer.take();
  if (file.mesh.triangle.empty()) {
    return fail(fmt::format(
        "{}: no triangle with three different corners; a surface needs at least one: export the mesh again", path));
  }
  return file;
} catch (const std::exception& error) {
  return fail(fmt::format("{}: cannot be read as a mesh ({}); export it again", path, one_line(error.what())));
}

EdgeCount count_edges(const SurfaceMesh& mesh) {
  std::vector<std::uint64_t> edge(mesh.triangle.size());
  for (std::size_t t = 0; t < mesh.triangle.size(); t += 3) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint64_t a = mesh.triangle[t + c], b = mesh.triangle[t + (c + 1) % 3];
      edge[t + c] = std::min(a, b) << 32U | std::max(a, b);
    }
  }
  std::sort(edge.begin(), edge.end());
  EdgeCount count;
  for (std::size_t i = 0; i < edge.size();) {
    const auto last = static_cast<std::size_t>(
        std::upper_bound(edge.begin() + static_cast<std::ptrdiff_t>(i), edge.end(), edge[i]) - edge.begin());
    count.border += last - i == 1 ? 1 : 0;
    count.overused += last - i > 2 ? 1 : 0;
    i = last;
  }
  return count;
}

}  // namespace mobil
