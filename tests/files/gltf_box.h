#pragma once
// A glTF of a box, in pieces that tests replace.

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tests/files/capsule.h"

namespace mobil::test {

/// The box from (−0.11, 0.5, −0.02) to (−0.07, 0.92, 0.02), 672 cm³, wound outwards.
inline TestMesh box() {
  TestMesh mesh;
  for (const float y : {0.5F, 0.92F})
    for (const float z : {-0.02F, 0.02F})
      for (const float x : {-0.11F, -0.07F}) mesh.position.emplace_back(x, y, z);
  mesh.triangle = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                   {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  return mesh;
}

inline std::string base64(std::string_view bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8U |
             (i + k < bytes.size() ? static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i + k])) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63U];
  }
  return text;
}

/// The parts of a file, of which each can be replaced. Views begin where data is added.
struct Gltf {
  std::string asset = R"({"version":"2.0"})", scene = R"("scene":0,"scenes":[{"nodes":[0]}],)";
  std::string nodes = R"({"mesh":0})", primitive = R"("attributes":{"POSITION":0},"indices":1)", mesh, more, uri;
  std::string views, accessors, bytes;

  /// Adds a view of these bytes, and an accessor unless the rest of one is empty.
  void add(std::string_view data, std::string_view accessor, std::string_view view = "") {
    const auto number = std::count(views.begin(), views.end(), '{');
    bytes.resize((bytes.size() + 3) / 4 * 4);
    views += fmt::format(R"({}{{"buffer":0,"byteOffset":{},"byteLength":{}{}}})", number > 0 ? "," : "", bytes.size(),
                         data.size(), view);
    bytes += data;
    if (accessor.empty()) return;
    accessors += fmt::format(R"({}{{"bufferView":{},{}}})", accessors.empty() ? "" : ",", number, accessor);
  }
  std::string json(std::string_view buffer_uri) const {
    return fmt::format(
        R"({{"asset":{},{}"nodes":[{}],"meshes":[{{"primitives":[{{{}}}]{}}}],"buffers":[{{{}"byteLength":{}}}],)"
        R"("bufferViews":[{}],"accessors":[{}]{}}})",
        asset, scene, nodes, primitive, mesh, buffer_uri.empty() ? "" : fmt::format(R"("uri":"{}",)", buffer_uri),
        bytes.size(), views, accessors, more);
  }
  std::string text() const { return json("data:application/octet-stream;base64," + base64(bytes)); }
  /// A GLB with chunks of unknown kinds.
  std::string glb() const {
    std::string chunks;
    const auto chunk = [&](std::string data, std::string_view kind, char fill) {
      data.resize((data.size() + 3) / 4 * 4, fill);
      put(chunks, static_cast<std::uint32_t>(data.size()));
      chunks += kind;
      chunks += data;
    };
    chunk(json(""), "JSON", ' ');
    chunk("unknown", "ACME", '\0');
    chunk(bytes, std::string_view("BIN\0", 4), '\0');
    chunk("", "LAST", '\0');
    std::string head = "glTF";
    put(head, std::uint32_t{2});
    put(head, static_cast<std::uint32_t>(12 + chunks.size()));
    return head + chunks;
  }
};

inline std::string vec3(std::size_t count) {
  return fmt::format(R"("componentType":5126,"count":{},"type":"VEC3")", count);
}

template <class Index>
std::string index_bytes(const TestMesh& mesh) {
  std::string bytes;
  for (const auto& t : mesh.triangle)
    for (const auto v : t) put(bytes, static_cast<Index>(v));
  return bytes;
}

inline std::string position_bytes(const TestMesh& mesh) {
  std::string bytes;
  for (const auto& p : mesh.position)
    for (int i = 0; i < 3; ++i) put(bytes, p[i]);
  return bytes;
}

inline Gltf gltf_of(const TestMesh& mesh) {
  Gltf file;
  file.add(position_bytes(mesh), vec3(mesh.position.size()));
  file.add(index_bytes<std::uint32_t>(mesh),
           fmt::format(R"("componentType":5125,"count":{},"type":"SCALAR")", 3 * mesh.triangle.size()));
  return file;
}

}  // namespace mobil::test
