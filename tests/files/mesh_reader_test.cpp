// Readers of mesh formats, compared with the written data, with assimp, and on damaged files.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <unistd.h>

#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <mobil/mesh_file.h>
#include "assets/import/mesh_text.h"
#include "engine/eigen.h"
#include "tests/files/capsule.h"
#include "tests/files/temporary_folder.h"
#include "tests/labels.h"

MOBIL_TEST_LABELS("long");

namespace mobil::mesh_reader_test {
namespace fs = std::filesystem;
using Eigen::Vector3f;
using test::TestMesh;

using Corners = std::vector<std::array<Vector3f, 3>>;

Corners corners(const MeshFile& file) {
  Corners all;
  const auto at = [&](std::size_t i) {
    const auto& p = file.mesh.position[file.mesh.triangle[i]];
    return Vector3f(p.x, p.y, p.z);
  };
  for (std::size_t t = 0; t < file.mesh.triangle.size(); t += 3) all.push_back({at(t), at(t + 1), at(t + 2)});
  return all;
}

Corners corners(const TestMesh& mesh) {
  Corners all;
  for (const auto& t : mesh.triangle) all.push_back({mesh.position[t[0]], mesh.position[t[1]], mesh.position[t[2]]});
  return all;
}

Corners corners(const aiScene& scene) {
  Corners all;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    const auto at = [&](unsigned v) { return Vector3f(mesh.mVertices[v].x, mesh.mVertices[v].y, mesh.mVertices[v].z); };
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const auto& face = mesh.mFaces[f];
      if (face.mNumIndices != 3 || *std::max_element(face.mIndices, face.mIndices + 3) >= mesh.mNumVertices) return {};
      all.push_back({at(face.mIndices[0]), at(face.mIndices[1]), at(face.mIndices[2])});
    }
  }
  return all;
}

double largest_difference(const Corners& a, const Corners& b) {
  if (a.size() != b.size()) return 1e9;
  double largest = 0;
  for (std::size_t t = 0; t < a.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) largest = std::max<double>(largest, (a[t][c] - b[t][c]).norm());
  }
  return largest;
}

/// Returns a capsule with randomly displaced vertices.
TestMesh random_mesh() {
  auto mesh = test::capsule({static_cast<float>(*rc::gen::inRange(-900, 900)), 20, 400}, 40, 200,
                            static_cast<std::uint32_t>(*rc::gen::inRange(2, 7)),
                            static_cast<std::uint32_t>(*rc::gen::inRange(3, 9)));
  for (auto& p : mesh.position) {
    for (int i = 0; i < 3; ++i) p[i] += static_cast<float>(*rc::gen::inRange(-4000, 4001)) / 1237.0F;
  }
  return mesh;
}

std::vector<std::pair<std::string, std::string>> every_format(const TestMesh& mesh) {
  return {{"a.obj", test::obj_text(mesh)},          {"a.stl", test::stl_text(mesh)},
          {"b.STL", test::binary_stl(mesh)},        {"a.ply", test::ply_text(mesh)},
          {"b.Ply", test::binary_ply(mesh, false)}, {"c.ply", test::binary_ply(mesh, true)}};
}

RC_GTEST_PROP(MeshReader, EveryFormatRoundTrips, ()) {
  const TestMesh mesh = random_mesh();
  const Corners wanted = corners(mesh);
  for (const auto& [path, bytes] : every_format(mesh)) {
    const auto read = read_mesh_bytes(bytes, path);
    if (!read) RC_FAIL(read.error().message);
    RC_ASSERT(read->triangles_in_file == mesh.triangle.size());
    RC_ASSERT(read->mesh.position.size() == mesh.position.size());
    RC_ASSERT(largest_difference(corners(*read), wanted) == 0.0);
  }
}

RC_GTEST_PROP(MeshReader, ReadsAssimpFilesAsAssimpDoes, ()) {
  TestMesh mesh = random_mesh();
  mesh.position[0].x() = 0.5F;  // assimp skips a first byte of 9, 10, 13 or 32 before binary data
  aiScene scene;                // owns its pointers
  scene.mRootNode = new aiNode("root");
  scene.mNumMeshes = scene.mNumMaterials = scene.mRootNode->mNumMeshes = 1;
  scene.mMeshes = new aiMesh* [1] { new aiMesh };
  scene.mMaterials = new aiMaterial* [1] { new aiMaterial };
  scene.mRootNode->mMeshes = new unsigned[1]{0};
  aiMesh& part = *scene.mMeshes[0];
  part.mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
  part.mNumVertices = static_cast<unsigned>(mesh.position.size());
  part.mVertices = new aiVector3D[part.mNumVertices];
  for (unsigned v = 0; v < part.mNumVertices; ++v) {
    part.mVertices[v] = {mesh.position[v].x(), mesh.position[v].y(), mesh.position[v].z()};
  }
  part.mNumFaces = static_cast<unsigned>(mesh.triangle.size());
  part.mFaces = new aiFace[part.mNumFaces];
  for (unsigned f = 0; f < part.mNumFaces; ++f) {
    part.mFaces[f].mNumIndices = 3;
    part.mFaces[f].mIndices = new unsigned[3]{mesh.triangle[f][0], mesh.triangle[f][1], mesh.triangle[f][2]};
  }
  for (const auto& [format, path] :
       {std::pair{"obj", "a.obj"}, std::pair{"objnomtl", "a.obj"}, std::pair{"stl", "a.stl"},
        std::pair{"stlb", "a.stl"}, std::pair{"ply", "a.ply"}, std::pair{"plyb", "a.ply"}}) {
    Assimp::Exporter exporter;
    const auto* blob = exporter.ExportToBlob(&scene, format);
    RC_ASSERT(blob != nullptr);
    const std::string bytes(static_cast<const char*>(blob->data), blob->size);
    const auto read = read_mesh_bytes(bytes, path);
    if (!read) RC_FAIL(fmt::format("{} {}", format, read.error().message));
    Assimp::Importer importer;
    const auto* again = importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, path + 2);
    RC_ASSERT(again != nullptr);
    RC_ASSERT(largest_difference(corners(*read), corners(*again)) < 1e-3);  // mm; assimp's own decimals
  }
}

RC_GTEST_PROP(MeshReader, ObjIsReadInEverySpellingOfItsGrammar, ()) {
  const TestMesh mesh = random_mesh();
  const std::string end = *rc::gen::element<std::string>("\n", "\r\n", "\r"),
                    gap = *rc::gen::element<std::string>(" ", "\t  ");
  const int corner_form = *rc::gen::inRange(0, 4);
  const bool backwards = *rc::gen::arbitrary<bool>(), continued = *rc::gen::arbitrary<bool>();
  const std::string extra = *rc::gen::element<std::string>("", " 1", " 0.5 .25 1e-3", " 1 0 0 +0.5", " # a vertex");
  const std::string on = continued ? " \\" + end : gap;
  std::string text = "\xEF\xBB\xBF# made up" + end + "mtllib a.mtl" + end + "o thing" + end;
  for (const auto& p : mesh.position) {
    text += "v" + gap + fmt::format("{}", p.x()) + on + fmt::format("{}", p.y()) + gap + fmt::format("{:e}", p.z()) +
            extra + end;
  }
  text += "vt 0 0" + end + "vn 0 0 1" + end + "s off" + end + "g" + end + end;
  const auto count = static_cast<long>(mesh.position.size());
  for (const auto& t : mesh.triangle) {
    text += "f";
    for (const long v : t) {
      const long named = backwards ? v - count : v + 1;
      constexpr std::array<const char*, 4> forms = {"", "/1", "//1", "/1/1"};
      text += on + fmt::format("{}{}", named, forms[static_cast<std::size_t>(corner_form)]);
    }
    text += end;
  }
  const auto read = read_mesh_bytes(text, "a.obj");
  if (!read) RC_FAIL(read.error().message);
  RC_ASSERT(largest_difference(corners(*read), corners(mesh)) < 1e-3);
  RC_ASSERT(read->mesh.position.size() == mesh.position.size());
}

/// Expects a refusal of one line that starts with the path and contains the piece.
void expect_refused(const std::string& path, const std::string& bytes, const std::string& piece) {
  const auto read = read_mesh_bytes(bytes, path);
  ASSERT_FALSE(read.has_value()) << path << " " << bytes;
  const std::string& line = read.error().message;
  EXPECT_TRUE(line.starts_with(path)) << line;
  EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  EXPECT_NE(line.find(piece), std::string::npos) << "no '" << piece << "' in: " << line;
}

TEST(MeshReaderRefuses, MalformedNumbers) {
  for (const std::string bad :
       {"1.2x", "1,5", "0x10", "inf", "nan", "-", "+", ".", "1e", "1e60", "--1", "+-1", "1.2.3"}) {
    expect_refused("a.obj", "v 0 0 0\nv 1 0 0\nv 0 " + bad + " 0\nf 1 2 3\n", "a.obj line 3");
    std::string stl = test::stl_text(test::capsule({0, 0, 0}, 1, 4, 2, 3));
    stl.insert(stl.find("vertex ") + 7, bad + " ");
    expect_refused("a.stl", stl, "a.stl line 4");
    const std::string head =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty double y\nproperty int z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    expect_refused("a.ply", head + "0 0 0\n1 " + bad + " 0\n0 1 0\n3 0 1 2\n", "a.ply line 11");
    expect_refused("a.ply", head + "0 0 0\n1 0 0\n0 1 0\n3 0 " + bad + " 2\n", "a.ply line 13");
  }
}

TEST(MeshReaderRefuses, InvalidObj) {
  const std::string v = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  expect_refused("a.obj", v + "f 1 2\n", "2 corners");
  expect_refused("a.obj", v + "f 1 2 4\n", "line 4");
  expect_refused("a.obj", v + "f 1 2 0\n", "line 4");
  expect_refused("a.obj", v + "f 1 2 -4\n", "range");
  expect_refused("a.obj", v + "f 1 2 99999999999999999999\n", "line 4");
  expect_refused("a.obj", v + "f 1 2 3/x\n", "'3/x'");
  expect_refused("a.obj", v + "f 1 2 3/1/1/1\n", "'3/1/1/1'");
  expect_refused("a.obj", v + "f 1.0 2 3\n", "'1.0'");
  expect_refused("a.obj", v + "face 1 2 3\n", "'face'");
  expect_refused("a.obj", "v 0 0\n" + v + "f 1 2 3\n", "2 numbers");
  expect_refused("a.obj", "v 0 0 0 1 1\n" + v + "f 1 2 3\n", "5 numbers");
  expect_refused("a.obj", "v 0 0 0 2\n" + v + "f 1 2 3\n", "weight 2");
  expect_refused("a.obj", v, "no triangle");
  expect_refused("a.obj", v + "f 1 1 2\n", "no triangle");
  expect_refused("a.obj", "", "no triangle");
  expect_refused("a.obj", "v \x1b[31m 0 0\n", "'?[31m'");
  EXPECT_TRUE(read_mesh_bytes("f 1 2 3\n" + v, "a.obj").has_value());  // a face can precede its vertices
}

TEST(MeshReaderRefuses, InvalidStl) {
  const TestMesh mesh = test::capsule({0, 0, 0}, 10, 40, 3, 5);
  std::string text = test::stl_text(mesh);
  expect_refused("a.stl", text.substr(0, text.find("endsolid")), "endsolid");
  expect_refused("a.stl", text + "more", "'more'");
  text.replace(text.find("outer"), 5, "inner");
  expect_refused("a.stl", text, "a.stl line 3: 'inner' where 'outer'");
  expect_refused("a.stl", binary_stl(mesh, "binary") + "x", "facets makes");
  expect_refused("a.stl", binary_stl(mesh, "binary").substr(0, 300), "facets makes");
  expect_refused("a.stl", binary_stl(mesh, "solid binary").substr(0, 300), "a.stl line");
  EXPECT_TRUE(read_mesh_bytes(test::stl_text(mesh) + test::stl_text(mesh), "a.stl").has_value());  // two solids
}

TEST(MeshReaderRefuses, InvalidPly) {
  const TestMesh mesh = test::capsule({0, 0, 0}, 10, 40, 3, 5);
  const std::string text = test::ply_text(mesh), big = test::binary_ply(mesh, true);
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string other = text;
    other.replace(other.find(from), from.size(), to);
    return other;
  };
  expect_refused("a.ply", "PLY\nformat ascii 1.0\n", "'ply'");
  expect_refused("a.ply", "ply\nformat ascii 1.0\n", "end_header");
  expect_refused("a.ply", changed("ascii 1.0", "ascii 2.0"), "a.ply line 2");
  expect_refused("a.ply", changed("format ascii 1.0\n", ""), "format");
  expect_refused("a.ply", changed("float x", "half x"), "a.ply line 5");
  expect_refused("a.ply", changed("float y", "float x"), "once");
  expect_refused("a.ply", changed("float z", "float w"), "x, y, z");
  expect_refused("a.ply", changed("vertex_indices", "indices"), "vertex_indices");
  expect_refused("a.ply", changed("list uchar", "list float"), "INTEGER_TYPE");
  expect_refused("a.ply", changed("element face", "element face 4000000000 #"), "COUNT");
  expect_refused("a.ply", changed("element vertex 17", "element vertex 4000000000"), "too short");
  expect_refused("a.ply", changed("element vertex 17", "element vertex 18"), "a.ply");
  expect_refused("a.ply", changed("element vertex 17", "element vertex -1"), "COUNT");
  expect_refused("a.ply", text + "1 2 3\n", "after the last element");
  expect_refused("a.ply", text.substr(0, text.size() - 9), "a.ply");
  expect_refused("a.ply", big + "x", "after the last element");
  expect_refused("a.ply", big.substr(0, big.size() - 1), "cut short");
  std::string out_of_range = big;
  out_of_range.back() = 17;
  expect_refused("a.ply", out_of_range, "range");
}

TEST(MeshReaderRefuses, OtherFormatsByName) {
  for (const std::string path : {"a.off", "a.smd", "a.mot", "a", "a.obj.gz", ".obj", "a.OBJ "}) {
    expect_refused(path, "OFF\n3 1 0\n", ".obj, .stl, .ply, .gltf, .glb");
  }
}

// ---------------------------------------------------------------------------------------------------------- files

using Folder = TemporaryFolder;

/// Returns the smallest glTF of a mesh, with its numbers in a separate file.
std::string gltf(const TestMesh& mesh, const std::string& uri) {
  return fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0,"translation":[1,2,3]}}],)"
      R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],"buffers":[{{"uri":"{}","byteLength":{}}}],)"
      R"("bufferViews":[{{"buffer":0,"byteLength":{}}},{{"buffer":0,"byteOffset":{},"byteLength":{}}}],)"
      R"("accessors":[{{"bufferView":0,"componentType":5126,"count":{},"type":"VEC3"}},)"
      R"({{"bufferView":1,"componentType":5125,"count":{},"type":"SCALAR"}}]}})",
      uri, 12 * (mesh.position.size() + mesh.triangle.size()), 12 * mesh.position.size(), 12 * mesh.position.size(),
      12 * mesh.triangle.size(), mesh.position.size(), 3 * mesh.triangle.size());
}

std::string gltf_buffer(const TestMesh& mesh) {
  std::string bytes;
  for (const auto& p : mesh.position) {
    for (int i = 0; i < 3; ++i) test::put(bytes, p[i]);
  }
  for (const auto& t : mesh.triangle) {
    for (const auto v : t) test::put(bytes, v);
  }
  return bytes;
}

TEST(MeshReader, GltfIsReadInASeparateProcess) {
  const Folder folder;
  TestMesh mesh = test::capsule({0, 0, 0}, 10, 40, 5, 7);
  folder.write("a.bin", gltf_buffer(mesh));
  const auto read = read_mesh(folder.write("a.gltf", gltf(mesh, "a.bin")));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  for (auto& p : mesh.position) p += Vector3f(1, 2, 3);
  EXPECT_LT(largest_difference(corners(*read), corners(mesh)), 1e-5);
}

TEST(MeshReaderRefuses, DamagedOrOutsideReferringGltf) {
  const Folder folder;
  const TestMesh mesh = test::capsule({0, 0, 0}, 10, 40, 5, 7);
  const std::string buffer = gltf_buffer(mesh);
  fs::create_directories(folder.path / "inner");
  folder.write("a.bin", buffer);
  const auto refused = [&](const std::string& path) {
    const auto read = read_mesh(path);
    ASSERT_FALSE(read.has_value()) << path;
    EXPECT_TRUE(read.error().message.starts_with(path)) << read.error().message;
    EXPECT_EQ(read.error().message.find('\n'), std::string::npos);
  };
  refused(folder.write("inner/a.gltf", gltf(mesh, "../a.bin")));
  refused(folder.write("inner/b.gltf", gltf(mesh, (folder.path / "a.bin").string())));
  refused(folder.write("c.gltf", gltf(mesh, "missing.bin")));
  folder.write("short.bin", buffer.substr(0, 50));
  refused(folder.write("d.gltf", gltf(mesh, "short.bin")));
  folder.write("wild.bin", std::string(4, '\xFF') + buffer.substr(4));  // not a number
  refused(folder.write("e.gltf", gltf(mesh, "wild.bin")));
  refused(folder.write("f.glb", "glTF" + std::string(40, '\xFF')));
  refused(folder.write("g.gltf", "{"));
  refused(folder.write("h.gltf", std::string(100000, '[')));
}

/// Returns the processor seconds for reading a mesh in each format.
std::vector<double> reading_s(int rings) {
  std::vector<double> took;
  for (const auto& [path, bytes] : every_format(test::capsule({0, 0, 0}, 100, 400, rings, rings))) {
    const std::clock_t start = std::clock();
    const auto read = read_mesh_bytes(bytes, path);
    took.push_back(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    EXPECT_TRUE(read.has_value()) << path;
    if (read) fmt::print("{}: {} triangles, {:.2f} s\n", path, read->triangles_in_file, took.back());
  }
  return took;
}

/// Four times as many triangles cost less than 10 times as much; up to a million triangles with MOBIL_LONG.
TEST(MeshReader, TimeGrowsWithTriangleCount) {
  MOBIL_SLOW();
  const int rings = std::getenv("MOBIL_LONG") != nullptr ? 700 : 300;
  const std::vector<double> few = reading_s(rings / 2), many = reading_s(rings);
  for (std::size_t i = 0; i < many.size(); ++i) EXPECT_LT(many[i], 10 * few[i] + 0.1) << "format " << i;
}

}  // namespace mobil::mesh_reader_test
