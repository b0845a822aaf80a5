// Readers of mesh formats, compared with the written data, with assimp, and on damaged files.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <cstdlib>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

#include <mobil/mesh_file.h>
#include "assets/import/mesh_text.h"
#include "assets/surfaces/surface_mesh.h"
#include "engine/eigen.h"
#include "tests/files/capsule.h"
#include "tests/labels.h"

MOBIL_TEST_LABELS("long");

namespace mobil::mesh_reader_test {
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
  const std::string on = continued ? " \\" + *rc::gen::element<std::string>("", " ", "\t ") + end : gap;
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
  for (const std::string head : {"binary", "solid binary", "solid\nfacet normal"}) {
    expect_refused("a.stl", binary_stl(mesh, head).substr(0, 300), "facets makes");
    expect_refused("a.stl", binary_stl(mesh, head) + std::string(50, 'x'), "several in one");
  }
  expect_refused("a.stl", std::string(84, '\0'), "count of facets is 0");
  EXPECT_TRUE(read_mesh_bytes(test::stl_text(mesh) + test::stl_text(mesh), "a.stl").has_value());  // two solids
}

TEST(MeshReader, BinaryStlIsKnownByItsSizeAndTextByItsWords) {
  const TestMesh mesh = test::capsule({0, 0, 0}, 10, 40, 3, 5);
  const Corners wanted = corners(mesh);
  const std::string text = test::stl_text(mesh);
  for (const std::string head : {"binary", "solid", "solid a\nfacet normal 0 0 1\n", "\n\n"}) {
    for (const std::string& spare :
         {std::string(), std::string("x"), std::string("\r\n"), std::string(49, 'x'), std::string(500, '\0')}) {
      const auto read = read_mesh_bytes(test::binary_stl(mesh, head) + spare, "a.stl");
      ASSERT_TRUE(read.has_value()) << read.error().message;
      EXPECT_EQ(largest_difference(corners(*read), wanted), 0.0);
    }
  }
  for (const std::string normal :
       {"nan nan nan", "-1.#IND -1.#IND 1.#QNAN", "-nan(ind) inf -inf", "1.#INF00 1.#SNAN 1.#J"}) {
    std::string other = text;
    for (std::size_t at = 0; (at = other.find("0 0 1\n", at)) != std::string::npos;) other.replace(at, 5, normal);
    const auto read = read_mesh_bytes(other, "a.stl");
    ASSERT_TRUE(read.has_value()) << read.error().message;
    EXPECT_EQ(read->triangles_in_file, mesh.triangle.size());
  }
  std::string bad = text;
  expect_refused("a.stl", bad.replace(bad.find("vertex ") + 7, 1, "-1.#IND"), "a.stl line 4");
  expect_refused("a.stl", "\xFF\xFEs\0", "UTF-16");
}

TEST(MeshReader, TextStlIsReadInEverySpellingOfItsGrammar) {
  const TestMesh mesh = test::capsule({0, 0, 0}, 10, 40, 3, 5);
  const std::string text = test::stl_text(mesh);
  const auto replaced = [](std::string whole, const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = whole.find(from, at)) != std::string::npos; at += to.size())
      whole.replace(at, from.size(), to);
    return whole;
  };
  const std::string one_line = replaced(text, "\n", " ");
  for (const std::string& spelling :
       {one_line, one_line + "\n", replaced(text, "endsolid", "end solid"), replaced(one_line, "endsolid", "END SOLID"),
        "# made up\n" + text, "#\n\n # cut short\r\n" + text + "# end", replaced(text, "\n", "\n# facet normal\n"),
        replaced(text, "\n", " # solid\n"), replaced(text, "solid", "solid facet normal")}) {
    const auto read = read_mesh_bytes(spelling, "a.stl");
    ASSERT_TRUE(read.has_value()) << read.error().message << spelling.substr(0, 200);
    EXPECT_EQ(largest_difference(corners(*read), corners(mesh)), 0.0) << spelling.substr(0, 200);
  }
  EXPECT_EQ(read_mesh_bytes(one_line + one_line, "a.stl")->triangles_in_file, 2 * mesh.triangle.size());
  expect_refused("a.stl", one_line.substr(0, one_line.find("endsolid")), "no 'endsolid'");
}

TEST(MeshReader, ZerosAndCtrlZBehindTextAreIgnored) {
  const TestMesh mesh = test::capsule({0, 0, 0}, 10, 40, 3, 5);
  for (const std::string& tail : {std::string("\x1A"), std::string("\0\0\0", 3), std::string("\n\x1A\0", 3)}) {
    for (const auto& [path, bytes] :
         {std::pair{"a.obj", test::obj_text(mesh)}, std::pair{"a.stl", test::stl_text(mesh)},
          std::pair{"a.ply", test::ply_text(mesh)}}) {
      const auto read = read_mesh_bytes(bytes + tail, path);
      ASSERT_TRUE(read.has_value()) << read.error().message;
      EXPECT_EQ(largest_difference(corners(*read), corners(mesh)), 0.0) << path;
    }
  }
}

TEST(MeshReader, EveryTextCanBeginWithAUtf8Mark) {
  const TestMesh mesh = test::capsule({0, 0, 0}, 10, 40, 3, 5);
  for (const auto& [path, bytes] : every_format(mesh)) {
    if (path == "b.STL") continue;
    const auto read = read_mesh_bytes("\xEF\xBB\xBF" + bytes, path);
    ASSERT_TRUE(read.has_value()) << read.error().message;
    EXPECT_EQ(largest_difference(corners(*read), corners(mesh)), 0.0) << path;
  }
}

/// Two boxes of 672 cm³; the first corner of the second follows a line that ends in a backslash.
std::string two_boxes(const std::string& line) {
  std::string text;
  for (const double x : {-0.11, -0.17}) {
    if (!text.empty()) text += line;
    for (const double y : {0.5, 0.92})
      for (const double z : {-0.02, 0.02}) text += fmt::format("v {} {} {}\nv {} {} {}\n", x, y, z, x + 0.04, y, z);
    text += "f -8 -7 -5 -6\nf -4 -2 -1 -3\nf -8 -4 -3 -7\nf -6 -5 -1 -2\nf -8 -6 -2 -4\nf -7 -3 -1 -5\n";
  }
  return text;
}

TEST(MeshReader, ObjLinesThatArePassedOverEndWithTheirLine) {
  for (const std::string line :
       {"# from C:\\bones\\\n", "#\\\n", "g C:\\bones\\\n", "o a \\\n", "mtllib C:\\bones\\\r\n", "usemtl \\\n",
        "s \\\n", "g a \\\n b c \\\n d\n", "parm u 0 1 \\\n 2 3\n", "vt 0 \\\n 0\n", "vn 0 \\\n0 1 \\\n", "l 1 2 \\\n",
        "p 1\n", "v 0 0 0 # 1 2 3 \\\n", "f 1 1 2 # \\\n", "curv2 1 \\\n# \\\n", "vt 0 \\ \t\n 0\n", "g C:\\bones\\ \n",
        "cstype bezier\ndeg 3\n"}) {
    const auto read = read_mesh_bytes(two_boxes(line), "a.obj");
    ASSERT_TRUE(read.has_value()) << read.error().message << line;
    EXPECT_NEAR(enclosed_volume(read->mesh), 0.001344, 2e-9) << line;
  }
  expect_refused("a.obj", two_boxes("g a\nb\n"), "'b'");
}

TEST(MeshReader, PlyIsReadInEverySpellingOfItsGrammar) {
  const std::string head = "ply\nformat ascii 1.0\nobj_info a \\\ncomment element face 9 \\\n";
  const std::string vertices =
      "element vertex 4\nproperty list uchar int near\nproperty double z\nproperty short x\nproperty uchar y\n";
  const std::string points = "0 0 0 0\n1 7 0 1 0\n2 8 9 0 0 1\n0 1 0 0\n";
  const std::string faces =
      "element face 4\nproperty float q\nproperty list ushort uint vertex_index\nproperty list int float t\n";
  const std::string strips = "element tristrips 1\nproperty list int int vertex_indices\n";
  const std::string others = "element edge 2\nproperty int vertex1\nproperty int vertex2\nproperty float nan\n";
  const std::string corners = "nan 3 0 2 1 0\n-1.#IND 3 0 1 3 1 .5\ninf 3 1 2 3 0\n0 3 2 0 3 2 1 nan\n",
                    edges = "0 1 nan\n1 2 0\n";
  const std::string strip = "12 2 1 0 3 -1 3 1 2 -1 2 0 3\n";
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    for (std::string text :
         {head + vertices + faces + "end_header\n" + points + corners,
          head + others + faces + vertices + "end_header\n" + edges + corners + points,
          head + vertices + others + strips + "end_header\n" + points + edges + strip,
          head + strips + "element face 0\n" + vertices + others + "end_header\n" + strip + points + edges}) {
      for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += end.size())
        text.replace(at, 1, end);
      const auto read = read_mesh_bytes(text, "a.ply");
      ASSERT_TRUE(read.has_value()) << read.error().message;
      EXPECT_EQ(read->mesh.position.size(), 4U);
      EXPECT_EQ(read->mesh.triangle.size(), 12U);
      EXPECT_EQ(count_edges(read->mesh).border, 0U);
      EXPECT_NEAR(enclosed_volume(read->mesh), 1 / 6.0, 1e-7) << text;
    }
  }
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
  EXPECT_TRUE(read_mesh_bytes(big + std::string("\r\n\0\0", 4), "a.ply").has_value());
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
