// glTF as its specification says, compared with volumes of a box and with assimp; hostile files are refused.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <mobil/fit_anatomy.h>
#include <mobil/mesh_file.h>
#include "assets/surfaces/surface_mesh.h"
#include "tests/files/gltf_box.h"
#include "tests/files/temporary_folder.h"
#include "tests/refused.h"

namespace mobil::gltf_reader_test {
namespace fs = std::filesystem;
using test::Gltf;

/// Volume in cm³, centre in mm.
void expect_box(const Result<MeshFile>& read, double volume = 672, std::array<double, 3> centre = {-90, 710, 0}) {
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_NEAR(1e6 * enclosed_volume(read->mesh), volume, 1e-3 * std::abs(volume));
  std::array<double, 3> least{1e9, 1e9, 1e9}, most{-1e9, -1e9, -1e9};
  for (const auto& p : read->mesh.position) {
    const std::array<float, 3> own = {p.x, p.y, p.z};
    for (std::size_t i = 0; i < 3; ++i) {
      least[i] = std::min<double>(least[i], own[i]);
      most[i] = std::max<double>(most[i], own[i]);
    }
  }
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(500 * (least[i] + most[i]), centre[i], 0.02) << "axis " << i;
}
void expect_box(const Gltf& file, double volume = 672, std::array<double, 3> centre = {-90, 710, 0}) {
  expect_box(read_mesh_bytes(file.text(), "a.gltf"), volume, centre);
  expect_box(read_mesh_bytes(file.glb(), "a.glb"), volume, centre);
}

void expect_refused(const Gltf& file, const std::string& piece) {
  EXPECT_TRUE(is_refused(read_mesh_bytes(file.text(), "a.gltf"), "a.gltf: ", piece));
}

Gltf box_file() {
  return test::gltf_of(test::box());
}

/// A file with these nodes below root 0, and a scene of it.
Gltf with_nodes(const std::string& nodes) {
  Gltf file = box_file();
  file.nodes = nodes;
  return file;
}

// ------------------------------------------------------------------------------------------------- nodes and scenes

TEST(GltfReader, NodesPlaceTheMesh) {
  expect_box(box_file());
  expect_box(with_nodes(R"({"mesh":0,"translation":[1,2,3]})"), 672, {910, 2710, 3000});
  expect_box(with_nodes(R"({"mesh":0,"scale":[1,2,1]})"), 1344, {-90, 1420, 0});
  expect_box(with_nodes(R"({"mesh":0,"rotation":[0,0,0.70710678,0.70710678]})"), 672, {-710, -90, 0});
  expect_box(with_nodes(R"({"children":[1],"translation":[0,1,0]},{"mesh":0,"scale":[2,2,2]})"), 5376, {-180, 2420, 0});
  expect_box(with_nodes(R"({"mesh":0,"matrix":[2,0,0,0, 0,1,0,0, 0,0,1,0, 0.5,0,0,1]})"), 1344, {320, 710, 0});
  expect_box(with_nodes(R"({"children":[1]},{"mesh":0,"children":[2]},{"mesh":0,"translation":[0,0,0.04]})"), 1344,
             {-90, 710, 20});
}

TEST(GltfReader, NegativeDeterminantTurnsTheTriangles) {
  expect_box(with_nodes(R"({"mesh":0,"scale":[-1,1,1]})"), 672, {90, 710, 0});
  expect_box(with_nodes(R"({"scale":[-1,1,1],"children":[1]},{"mesh":0,"scale":[-1,1,1]})"));
  expect_box(with_nodes(R"({"mesh":0,"matrix":[0,1,0,0, 1,0,0,0, 0,0,1,0, 0,0,0,1]})"), 672, {710, -90, 0});
}

TEST(GltfReader, DefaultSceneOrAllRootsAreShown) {
  Gltf file = with_nodes(R"({"mesh":0},{"mesh":0,"translation":[1,0,0]},{"mesh":0,"translation":[0,0,0.04]})");
  file.scene = R"("scene":1,"scenes":[{"nodes":[0,2]},{"nodes":[1]}],)";
  expect_box(file, 672, {910, 710, 0});
  file.scene = R"("scenes":[{"nodes":[0,2]},{"nodes":[1]}],)";
  expect_box(file, 1344, {-90, 710, 20});
  file.scene = "";
  expect_box(file, 2016, {410, 710, 20});
}

/// A skin of two joints, at their places 1.2 and 0.3 along y; the box follows the first, and half the second.
TEST(GltfReader, SkinnedMeshFollowsItsJointsAndNotItsNode) {
  const auto file = [](const std::string& first, const std::string& weight) {
    Gltf made =
        with_nodes(R"({"mesh":0,"skin":0,"translation":[0,0.3,0],"scale":[1.2,1.2,1.2]},{"children":[2,3]})" + first);
    made.scene = R"("scene":0,"scenes":[{"nodes":[0,1]}],)";
    std::string joints, weights;
    for (int v = 0; v < 8; ++v) {
      for (const int joint : {0, 1, 1, 1}) test::put(joints, static_cast<std::uint8_t>(joint));
      for (const char w : weight) test::put(weights, static_cast<std::uint8_t>(w == '1' ? 255 : w == 'h' ? 51 : 0));
    }
    made.add(joints, R"("componentType":5121,"count":8,"type":"VEC4")");
    made.add(weights, R"("componentType":5121,"normalized":true,"count":8,"type":"VEC4")");
    std::string bind;
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 16; ++i) test::put(bind, i % 5 == 0 ? 1.0F : i == 13 ? -1.0F : 0.0F);
    made.add(bind, R"("componentType":5126,"count":2,"type":"MAT4")");
    made.primitive = R"("attributes":{"POSITION":0,"JOINTS_0":2,"WEIGHTS_0":3},"indices":1)";
    made.more = R"(,"skins":[{"joints":[2,3],"inverseBindMatrices":4}])";
    return made;
  };
  const std::string rest = R"(,{"translation":[0,1,0]},{"translation":[0,1,0]})",
                    moved = R"(,{"translation":[0,1,0.5]},{"translation":[0,1,0]})";
  expect_box(file(rest, "1000"));
  expect_box(file(moved, "1000"), 672, {-90, 710, 500});
  expect_box(file(moved, "0100"));
  expect_box(file(moved, "hhhh"), 672, {-90, 710, 125});  // weights are made to sum to 1
  expect_box(file(R"(,{"translation":[0,1,0],"scale":[-1,1,1]},{})", "1000"), 672, {90, 710, 0});
  Gltf without = file(rest, "1000");
  without.more = R"(,"skins":[{"joints":[2]}])";
  expect_box(without, 672, {-90, 1710, 0});
  without.more = R"(,"skins":[{"joints":[9]}])";
  expect_refused(without, "nodes[9] is missing");
}

/// Two boxes, of which each follows a joint of its own; a weight of the other one comes last.
TEST(GltfReader, JointsThatMirrorOneSideTurnItsTrianglesOnly) {
  for (const bool first : {false, true}) {
    test::TestMesh mesh = test::box();
    for (const auto& p : test::box().position) mesh.position.emplace_back(p.x() - 1, p.y(), p.z());
    for (auto t : test::box().triangle) mesh.triangle.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
    Gltf file = test::gltf_of(mesh);
    std::string joints, weights;
    for (std::uint8_t v = 0; v < 16; ++v) {
      for (const int joint : {v / 8, 0, 0, 1 - v / 8}) test::put(joints, static_cast<std::uint8_t>(joint));
      for (const float weight : {0.75F, 0.0F, 0.0F, 0.25F}) test::put(weights, weight);
    }
    file.add(joints, R"("componentType":5121,"count":16,"type":"VEC4")");
    file.add(weights, R"("componentType":5126,"count":16,"type":"VEC4")");
    const std::string plain = "{}", mirror = R"({"scale":[1,1,-1]})";
    file.nodes = R"({"mesh":0,"skin":0,"children":[1,2]},)" + (first ? mirror + "," + plain : plain + "," + mirror);
    file.primitive = R"("attributes":{"POSITION":0,"JOINTS_0":2,"WEIGHTS_0":3},"indices":1)";
    file.more = R"(,"skins":[{"joints":[1,2]}])";
    expect_box(file, 672, {-590, 710, 0});  // half of 1344, as z is halved
  }
}

TEST(GltfReader, CopiesThatAreNotReadAreReported) {
  Gltf file = with_nodes(R"({"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":0}}}})");
  file.more = R"(,"extensionsUsed":["EXT_mesh_gpu_instancing"])";
  const auto read = read_mesh_bytes(file.text(), "a.gltf");
  expect_box(read);
  ASSERT_EQ(read->said.size(), 1U);
  EXPECT_EQ(read->said[0], "nodes[0] has copies of its mesh by EXT_mesh_gpu_instancing, which are not read");
  EXPECT_TRUE(read_mesh_bytes(box_file().text(), "a.gltf")->said.empty());
}

TEST(GltfReader, MorphTargetsHaveTheirDefaultWeights) {
  Gltf file = box_file();
  std::string moved;
  for (int i = 0; i < 24; ++i) test::put(moved, i % 3 == 0 ? 1.0F : 0.0F);
  file.add(moved, test::vec3(8));
  file.primitive += R"(,"targets":[{"POSITION":2},{"NORMAL":2}])";
  expect_box(file);
  file.mesh = R"(,"weights":[0.5,1])";
  expect_box(file, 672, {410, 710, 0});
  file.nodes = R"({"mesh":0,"weights":[0.25,0]})";
  expect_box(file, 672, {160, 710, 0});
}

// --------------------------------------------------------------------------------------------- accessors, primitives

TEST(GltfReader, EveryTypeOfIndexIsRead) {
  const auto mesh = test::box();
  for (const auto& [code, bytes] :
       {std::pair{5121, test::index_bytes<std::uint8_t>(mesh)}, std::pair{5123, test::index_bytes<std::uint16_t>(mesh)},
        std::pair{5125, test::index_bytes<std::uint32_t>(mesh)}}) {
    Gltf file;
    file.add(test::position_bytes(mesh), test::vec3(8));
    file.add(bytes, fmt::format(R"("componentType":{},"count":36,"type":"SCALAR")", code));
    expect_box(file);
  }
  Gltf plain;
  auto soup = mesh;
  soup.position.clear();
  for (const auto& t : mesh.triangle)
    for (const auto v : t) soup.position.push_back(mesh.position[v]);
  plain.add(test::position_bytes(soup), test::vec3(36));
  plain.primitive = R"("attributes":{"POSITION":0})";
  expect_box(plain);
}

TEST(GltfReader, StripsAndFansKeepTheirWinding) {
  Gltf file;
  file.add(test::position_bytes(test::box()), test::vec3(8));
  const auto indices = [&](const std::vector<int>& list) {
    std::string bytes;
    for (const int i : list) test::put(bytes, static_cast<std::uint16_t>(i));
    file.add(bytes, fmt::format(R"("componentType":5123,"count":{},"type":"SCALAR")", list.size()));
  };
  indices({0, 1, 2, 3, 6, 7, 4, 5});  // 0 1 2 is turned: bottom, front, top
  indices({0, 4, 5, 1});              // back
  indices({0, 2, 6, 4});              // left
  indices({1, 5, 7, 3});              // right
  indices({0, 1, 0, 1, 0, 1});        // points, lines
  file.primitive =
      R"("attributes":{"POSITION":0},"indices":1,"mode":5},{"attributes":{"POSITION":0},"indices":2,"mode":6},)"
      R"({"attributes":{"POSITION":0},"indices":3,"mode":6},{"attributes":{"POSITION":0},"indices":4,"mode":6},)"
      R"({"attributes":{"POSITION":0},"mode":0},{"attributes":{"POSITION":0},"indices":5,"mode":1},)"
      R"({"attributes":{"POSITION":0},"indices":5,"mode":3},{"attributes":{"NORMAL":0})";
  expect_box(file);
  file.primitive = R"("attributes":{"POSITION":0},"mode":1)";
  expect_refused(file, "shows no triangle");
  file.primitive = R"("attributes":{"POSITION":0},"mode":7)";
  expect_refused(file, "mode 7");
  file.primitive = R"("attributes":{"POSITION":0})";
  expect_refused(file, "8 corners");
}

TEST(GltfReader, StridesSparsePartsAndAbsentViewsAreRead) {
  const auto mesh = test::box();
  Gltf strided;
  std::string wide;
  for (const auto& p : mesh.position) wide += test::position_bytes({{p}, {}}) + "normals and";
  for (std::size_t at = 23; at < wide.size(); at += 24) wide.insert(at, 1, '!');
  strided.add("1234" + wide, R"("byteOffset":4,)" + test::vec3(8), R"(,"byteStride":24)");
  strided.add(test::index_bytes<std::uint16_t>(mesh), R"("componentType":5123,"count":36,"type":"SCALAR")");
  expect_box(strided);

  Gltf sparse;  // zeros, all of them replaced
  sparse.add(test::position_bytes(mesh), "");
  sparse.add(std::string("\7\6\5\4\3\2\1\0", 8), "");
  sparse.accessors =
      R"({"componentType":5126,"count":8,"type":"VEC3","sparse":{"count":7,)"
      R"("indices":{"bufferView":1,"byteOffset":1,"componentType":5121},"values":{"bufferView":0,"byteOffset":12}}})";
  sparse.add(test::index_bytes<std::uint8_t>(mesh), R"("componentType":5121,"count":36,"type":"SCALAR")");
  const auto read = read_mesh_bytes(sparse.text(), "a.gltf");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->mesh.position.size(), 8U);  // the last one is at zero
}

/// A box of whole numbers, moved and scaled to its place by the node.
template <class T>
Gltf quantised(int code, bool normalised, double most) {
  Gltf file;
  std::string bytes;
  const auto mesh = test::box();
  for (const auto& p : mesh.position) {
    test::put(bytes, static_cast<T>(p.x() < -0.09F ? 0 : 100));
    test::put(bytes, static_cast<T>(p.y() < 0.6F ? 0 : 100));
    test::put(bytes, static_cast<T>(p.z() < 0 ? 0 : 100));
    test::put(bytes, T{0});
  }
  file.add(bytes, fmt::format(R"("componentType":{},"normalized":{},"count":8,"type":"VEC3")", code, normalised),
           fmt::format(R"(,"byteStride":{})", 4 * sizeof(T)));
  file.add(test::index_bytes<std::uint8_t>(mesh), R"("componentType":5121,"count":36,"type":"SCALAR")");
  const double unit = (normalised ? most : 1) / 100;
  file.nodes = fmt::format(R"({{"mesh":0,"translation":[-0.11,0.5,-0.02],"scale":[{},{},{}]}})", 0.04 * unit,
                           0.42 * unit, 0.04 * unit);
  file.more = R"(,"extensionsUsed":["KHR_mesh_quantization"],"extensionsRequired":["KHR_mesh_quantization"])";
  return file;
}

TEST(GltfReader, QuantisedPositionsAreRead) {
  for (const bool normalised : {false, true}) {
    expect_box(quantised<std::int8_t>(5120, normalised, 127));
    expect_box(quantised<std::uint8_t>(5121, normalised, 255));
    expect_box(quantised<std::int16_t>(5122, normalised, 32767));
    expect_box(quantised<std::uint16_t>(5123, normalised, 65535));
  }
}

// --------------------------------------------------------------------------------------------------- files and uris

TEST(GltfReader, MagicAndNotTheNameTellsGlb) {
  const Gltf file = box_file();
  expect_box(read_mesh_bytes(file.glb(), "a.GLTF"));
  expect_box(read_mesh_bytes(file.text(), "a.glb"));
  expect_box(read_mesh_bytes("\xEF\xBB\xBF" + file.text(), "a.gltf"));
  expect_box(read_mesh_bytes(file.json("data:;base64," + test::base64(file.bytes)), "a.gltf"));
  std::string percent;
  for (const char c : file.bytes) percent += fmt::format("%{:02x}", static_cast<unsigned char>(c));
  expect_box(read_mesh_bytes(file.json("data:application/gltf-buffer," + percent), "a.gltf"));
  expect_box(read_mesh_bytes(file.glb() + "behind the length", "a.glb"));
}

TEST(GltfReader, BuffersAreFoundInTheFolderByTheirDecodedName) {
  const TemporaryFolder folder;
  const Gltf file = box_file();
  fs::create_directories(folder.path / "parts");
  for (const char* name : {"femur a.bin", "M\xC3\xBCskel.bin", "parts/b.bin", "Buffer.BIN"})
    folder.write(name, file.bytes + "spare");
  for (const char* uri : {"femur%20a.bin", "femur a.bin", "M%C3%BCskel.bin", "M\xC3\xBCskel.bin", "parts/b.bin",
                          "./parts/b.bin", "parts%2Fb.bin", "parts\\\\b.bin", "buffer.bin"}) {
    expect_box(read_mesh(folder.write("a.gltf", file.json(uri))));
    const std::string glb = Gltf(file).glb();
    Gltf outside = file;
    EXPECT_TRUE(is_refused(read_mesh_bytes(outside.json(uri), "a.gltf"), "buffers[0]", "export it as .glb"));
  }
  for (const char* name : {"a%20b.bin", "100%ab.bin"}) {  // also as they are, if no decoded one is there
    folder.write(name, file.bytes);
    expect_box(read_mesh(folder.write("a.gltf", file.json(name))));
  }
  folder.write("a b.bin", std::string(file.bytes.size(), '\0'));
  EXPECT_TRUE(is_refused(read_mesh(folder.write("a.gltf", file.json("a%20b.bin"))), "no triangle"));
  fs::create_directory_symlink(folder.path / "parts", folder.path / "linked");
  expect_box(read_mesh(folder.write("a.gltf", file.json("linked/b.bin"))));
}

TEST(GltfReaderRefuses, BuffersOutsideTheFolder) {
  const TemporaryFolder folder;
  const Gltf file = box_file();
  fs::create_directories(folder.path / "inner");
  const std::string outside = folder.write("a.bin", file.bytes);
  fs::create_symlink(outside, folder.path / "inner/link.bin");
  for (const std::string& uri :
       {std::string("../a.bin"), std::string("%2e%2e/a.bin"), std::string("..%2Fa.bin"), std::string("..\\\\a.bin"),
        outside, std::string("link.bin"), std::string("a%00.bin"), std::string("x/../../a.bin")}) {
    EXPECT_TRUE(
        is_refused(read_mesh(folder.write("inner/a.gltf", file.json(uri))), "a.gltf: buffers[0]: file", "leads out"))
        << uri;
  }
  for (const std::string uri : {"missing.bin", "http://localhost/a.bin", "file:///a.bin"}) {
    EXPECT_TRUE(
        is_refused(read_mesh(folder.write("inner/a.gltf", file.json(uri))), "a.gltf: buffers[0]: no file", uri));
  }
  const std::string name = std::string(60, 'n') + ".bin";  // names are told whole
  EXPECT_TRUE(is_refused(read_mesh(folder.write("a.gltf", file.json(name))), "no file '" + name));
  folder.write("short.bin", file.bytes.substr(1));
  EXPECT_TRUE(is_refused(read_mesh(folder.write("a.gltf", file.json("short.bin"))), "has 239 bytes where 240"));
  folder.write("case.bin", "");
  folder.write("CASE.bin", "");
  EXPECT_TRUE(is_refused(read_mesh(folder.write("a.gltf", file.json("Case.bin"))), "fits 'CASE.bin' and 'case.bin'"));
}

TEST(GltfReaderRefuses, RequiredExtensionsByTheirNames) {
  Gltf file = box_file();
  file.more = R"(,"extensionsRequired":["KHR_materials_unlit","ACME_positions_in_inches","EXT_meshopt_compression"])";
  expect_refused(file, "requires 'ACME_positions_in_inches', 'EXT_meshopt_compression'");
  file.more = R"(,"extensionsUsed":["ACME_other"],"extensionsRequired":["KHR_texture_transform"])";
  expect_box(file);
  file.more = "";
  file.primitive += R"(,"extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0}}})";
  expect_box(file);  // as the file has the positions, too
  file.accessors =
      R"({"componentType":5126,"count":8,"type":"VEC3"},)" + file.accessors.substr(file.accessors.find("},") + 2);
  expect_refused(file, "KHR_draco_mesh_compression");
  Gltf packed = box_file();
  const std::string text = packed.json("");
  EXPECT_TRUE(is_refused(read_mesh_bytes(text, "a.gltf"), "buffers[0]: no data"));
}

TEST(GltfReaderRefuses, OtherVersions) {
  Gltf file = box_file();
  for (const auto& [asset, piece] :
       {std::pair{R"({"version":"1.0"})", "glTF 1.0"}, std::pair{R"({"version":"2.1","minVersion":"2.1"})", "glTF 2.1"},
        std::pair{R"({"version":"3.0"})", "glTF 3.0"}, std::pair{"{}", "asset.version"},
        std::pair{R"({"version":2})", "asset.version"}}) {
    file.asset = asset;
    expect_refused(file, piece);
  }
  file.asset = R"({"version":"2.7","minVersion":"2.0"})";
  expect_box(file);
}

/// Each replaces a piece of a good file.
TEST(GltfReaderRefuses, FaultsByTheirPlace) {
  const std::string good = box_file().text();
  const auto refused = [&](const std::string& from, const std::string& to, const std::string& piece) {
    std::string text = good;
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    EXPECT_TRUE(is_refused(read_mesh_bytes(text, "a.gltf"), "a.gltf: ", piece)) << to;
  };
  refused(R"("count":8)", R"("count":9)", "accessors[0]: 9 elements reach beyond the 96 bytes of bufferViews[0]");
  refused(R"("count":8)", R"("count":8.5)", "accessors[0]: count is not a whole number");
  refused(R"("count":8)", R"("count":-8)", "accessors[0]: count is not a whole number");
  refused(R"("count":8)", R"("count":"8")", "accessors[0]: count is not a whole number");
  refused(R"("count":8)", R"("count":18446744073709551615)", "accessors[0]");
  refused(R"("count":8)", R"("count":4611686018427387904)", "accessors[0]");
  refused(R"("count":8)", R"("count":1e300)", "accessors[0]");
  refused(R"("count":8)", R"("count":7)", "meshes[0]: vertex 7 is out of range; valid: 0 to 6");
  refused(R"("count":8)", R"("count":8,"byteOffset":9007199254740992)", "accessors[0]: 8 elements reach beyond");
  refused(R"("count":8)", R"("count":8,"byteOffset":4)", "reach beyond");
  refused(R"("count":36)", R"("count":35)", "35 corners");
  refused(R"("byteLength":96)", R"("byteLength":9007199254740992)", "bufferViews[0]: bytes 0 to");
  refused(R"("byteLength":96)", R"("byteLength":96,"byteStride":8)", "bufferViews[0]: byteStride 8");
  refused(R"("byteLength":96)", R"("byteLength":96,"byteStride":1e9)", "bufferViews[0]: byteStride");
  refused(R"("buffer":0)", R"("buffer":1)", "buffers[1] is missing");
  refused(R"("buffer":0)", R"("buffers":0)", "bufferViews[0]: no buffer");
  refused(R"("byteLength":240)", R"("byteLength":241)", "240 bytes where 241 are promised");
  refused(R"("byteLength":240)", R"("byteLength":999999999)", "256 MB");
  refused(R"("bufferView":0)", R"("bufferView":7)", "bufferViews[7] is missing");
  refused(R"("VEC3")", R"("VEC2")", "accessors[0]: not of type VEC3");
  refused("5126", "5125", "accessors[0]: components of 32-bit integers");
  refused("5126", "5124", "componentType 5124");
  refused("5125", "5122", "accessors[1]: components that are no unsigned");
  refused("5126", "5126,\"sparse\":{\"count\":9}", "sparse");
  refused(R"("POSITION":0)", R"("POSITION":5)", "accessors[5] is missing");
  refused(R"("mesh":0)", R"("mesh":1)", "meshes[1] is missing");
  refused(R"("mesh":0)", R"("mesh":0,"matrix":[1,2,3])", "nodes[0]: matrix is not 16 numbers");
  refused(R"("mesh":0)", R"("mesh":0,"rotation":[0,0,0,0])", "quaternion");
  refused(R"("mesh":0)", R"("mesh":0,"scale":[1e300,1,1])", "vertex 0 is at (-inf");
  refused(R"("scene":0)", R"("scene":1)", "scenes[1] is missing");
  refused(R"("nodes":[0])", R"("nodes":[3])", "nodes[3] is missing");
  refused(R"("nodes":[0])", R"("nodes":[])", "no triangle");
  refused(R"(base64,)", R"(base64,!)", "base64");
  refused(R"(base64,)", R"(base64 )", "comma");
  refused(R"("asset")", R"(asset)", "not JSON at byte 2");
  EXPECT_TRUE(is_refused(read_mesh_bytes("", "a.gltf"), "not JSON"));
  EXPECT_TRUE(is_refused(read_mesh_bytes("[]", "a.gltf"), "no object"));
  EXPECT_TRUE(is_refused(read_mesh_bytes(R"({"asset":{"version":"2.0"},"x":1e999})", "a.gltf"), "too large"));
}

TEST(GltfReaderRefuses, NodesThatAreNoTree) {
  expect_refused(with_nodes(R"({"children":[1,1]},{"mesh":0})"), "nodes[1]: has two parents");
  expect_refused(with_nodes(R"({"mesh":0},{"children":[2]},{"children":[1]})"), "their own ancestors");
  expect_refused(with_nodes(R"({"mesh":0},{"children":[1]})"), "their own ancestors");
  expect_refused(with_nodes(R"({"mesh":0},{"children":[0]})"), "nodes[0]: in a scene, and below another");
  std::string chain;
  for (int i = 0; i < 100'000; ++i) chain += fmt::format(R"({{"children":[{}]}},)", i + 1);
  expect_box(with_nodes(chain + R"({"mesh":0})"));
}

TEST(GltfReaderRefuses, DeepAndWideJsonAndCutChunks) {
  const auto refused = [](const std::string& bytes, const std::string& piece) {
    EXPECT_TRUE(is_refused(read_mesh_bytes(bytes, "a.gltf"), "a.gltf: ", piece));
  };
  refused(std::string(100'000, '['), "nested more than 64 deep");
  refused(R"({"asset":{"version":"2.0"},"extras":)" + std::string(1'000'000, '[') + std::string(1'000'000, ']') + "}",
          "nested");
  std::string wide = R"({"asset":{"version":"2.0"},"extras":[0)";
  for (int i = 0; i < 2'000'000; ++i) wide += ",0";
  refused(wide + "]}", "more than 1000000 values");
  const std::string glb = box_file().glb();
  for (const std::size_t size : {4U, 12U, 19U, 20U, 100U}) refused(glb.substr(0, size), "cut short");
  refused(glb.substr(0, glb.size() - 1), "cut short");
  std::string old = glb;
  old[4] = 1;
  refused(old, "GLB version 1");
  std::string unsized_glb = glb;
  unsized_glb.replace(8, 4, std::string(4, '\0'));
  refused(unsized_glb, fmt::format("its head says 0 bytes in all; valid: 20 to the file's {}", glb.size()));
  // Few bytes that name the same numbers many times.
  Gltf many;
  many.accessors = R"({"componentType":5126,"count":1000000,"type":"VEC3"})";
  many.primitive = R"("attributes":{"POSITION":0},"targets":[{"POSITION":0})";
  many.mesh = R"(,"weights":[1)";
  for (int i = 0; i < 100; ++i) {
    many.primitive += R"(,{"POSITION":0})";
    many.mesh += ",1";
  }
  many.primitive += "]";
  many.mesh += "]";
  refused(many.text(), "read more than 200000000 numbers");
}

// ------------------------------------------------------------------------------------------------------- references

RC_GTEST_PROP(GltfReader, ReadsNodesAsAssimpDoes, ()) {
  const auto number = [] { return *rc::gen::inRange(-200, 201) / 100.0; };
  Gltf file = test::gltf_of(test::capsule({1, 2, 3}, 1, 4, 3, 5));
  const auto transform = [&] {
    return fmt::format(R"("translation":[{},{},{}],"rotation":[{},0.5,0.1,{}],"scale":[{},{},{}])", number(), number(),
                       number(), 0.3, 0.806225774829855, number() + 2.5, number() + 2.5, number() + 2.5);
  };
  file.nodes = fmt::format(R"({{"children":[1,2],{}}},{{"mesh":0,{}}},{{"children":[3],{}}},{{"mesh":0,{}}})",
                           transform(), transform(), transform(), transform());
  const std::string bytes = file.text();
  const auto read = read_mesh_bytes(bytes, "a.gltf");
  if (!read) RC_FAIL(read.error().message);
  Assimp::Importer importer;
  const auto* scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), aiProcess_PreTransformVertices, "gltf");
  RC_ASSERT(scene != nullptr);
  std::vector<std::array<float, 3>> own, other;
  for (const auto index : read->mesh.triangle) {
    const auto& p = read->mesh.position[index];
    own.push_back({p.x, p.y, p.z});
  }
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& mesh = *scene->mMeshes[m];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f)
      for (unsigned c = 0; c < 3; ++c) {
        const auto& p = mesh.mVertices[mesh.mFaces[f].mIndices[c]];
        other.push_back({p.x, p.y, p.z});
      }
  }
  RC_ASSERT(own.size() == other.size());
  std::ranges::sort(own);
  std::ranges::sort(other);
  double sum = 0;
  for (std::size_t i = 0; i < own.size(); ++i)
    for (std::size_t a = 0; a < 1; ++a) sum = std::max<double>(sum, std::abs(own[i][a] - other[i][a]));
  RC_ASSERT(sum < 1e-3);
}

}  // namespace mobil::gltf_reader_test
