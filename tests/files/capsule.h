#pragma once
// Closed test meshes, and writers for each format.

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/eigen.h"

namespace mobil::test {

struct TestMesh {
  std::vector<Eigen::Vector3f> position;
  std::vector<std::array<std::uint32_t, 3>> triangle;  // wound outwards
};

/// A capsule about the z axis through `centre`, `length` from tip to tip; 2 · sectors · rings triangles.
inline TestMesh capsule(const Eigen::Vector3f& centre, float radius, float length, std::uint32_t rings = 24,
                        std::uint32_t sectors = 20) {
  TestMesh mesh;
  const double straight = static_cast<double>(length) / 2 - static_cast<double>(radius);
  mesh.position.push_back(centre - Eigen::Vector3f(0, 0, length / 2));
  for (std::uint32_t r = 1; r <= rings; ++r) {
    const double a = M_PI * r / (rings + 1);
    const double z = -std::cos(a) * static_cast<double>(radius) - std::cos(a) * straight;
    for (std::uint32_t s = 0; s < sectors; ++s) {
      const double b = 2 * M_PI * s / sectors, across = std::sin(a) * static_cast<double>(radius);
      mesh.position.push_back(centre + Eigen::Vector3d(across * std::cos(b), across * std::sin(b), z).cast<float>());
    }
  }
  mesh.position.push_back(centre + Eigen::Vector3f(0, 0, length / 2));
  const auto top = static_cast<std::uint32_t>(mesh.position.size() - 1);
  const auto at = [&](std::uint32_t r, std::uint32_t s) { return 1 + r * sectors + s % sectors; };
  for (std::uint32_t s = 0; s < sectors; ++s) {
    mesh.triangle.push_back({0, at(0, s + 1), at(0, s)});
    for (std::uint32_t r = 0; r + 1 < rings; ++r) {
      mesh.triangle.push_back({at(r, s), at(r, s + 1), at(r + 1, s)});
      mesh.triangle.push_back({at(r, s + 1), at(r + 1, s + 1), at(r + 1, s)});
    }
    mesh.triangle.push_back({at(rings - 1, s), at(rings - 1, s + 1), top});
  }
  return mesh;
}

inline double volume(const TestMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangle) {
    const auto p = [&](std::size_t c) { return mesh.position[t[c]].cast<double>().eval(); };
    sum += p(0).dot(p(1).cross(p(2))) / 6;
  }
  return sum;
}

inline std::string obj_text(const TestMesh& mesh) {
  std::string text;
  for (const auto& p : mesh.position) text += fmt::format("v {} {} {}\n", p.x(), p.y(), p.z());
  for (const auto& t : mesh.triangle) text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return text;
}

inline std::string stl_text(const TestMesh& mesh) {
  std::string text = "solid made up\n";
  for (const auto& t : mesh.triangle) {
    text += "facet normal 0 0 1\n outer loop\n";
    for (const auto v : t) {
      const auto& p = mesh.position[v];
      text += fmt::format("  vertex {} {} {}\n", p.x(), p.y(), p.z());
    }
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid made up\n";
}

template <class T>
void put(std::string& bytes, T value, bool big = false) {
  std::array<char, sizeof(T)> raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (big) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

inline std::string binary_stl(const TestMesh& mesh, const std::string& head = "solid but binary") {
  std::string bytes = head;
  bytes.resize(80, ' ');
  put(bytes, static_cast<std::uint32_t>(mesh.triangle.size()));
  for (const auto& t : mesh.triangle) {
    for (int i = 0; i < 3; ++i) put(bytes, 0.0F);
    for (const auto v : t) {
      for (int i = 0; i < 3; ++i) put(bytes, mesh.position[v][i]);
    }
    put(bytes, std::uint16_t{0});
  }
  return bytes;
}

inline std::string ply_head(const TestMesh& mesh, const std::string& format) {
  return fmt::format(
      "ply\nformat {} 1.0\ncomment made up\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar red\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
      format, mesh.position.size(), mesh.triangle.size());
}

inline std::string ply_text(const TestMesh& mesh) {
  std::string text = ply_head(mesh, "ascii");
  for (const auto& p : mesh.position) text += fmt::format("{} {} {} 255\n", p.x(), p.y(), p.z());
  for (const auto& t : mesh.triangle) text += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
  return text;
}

inline std::string binary_ply(const TestMesh& mesh, bool big) {
  std::string bytes = ply_head(mesh, big ? "binary_big_endian" : "binary_little_endian");
  for (const auto& p : mesh.position) {
    for (int i = 0; i < 3; ++i) put(bytes, p[i], big);
    put(bytes, std::uint8_t{255});
  }
  for (const auto& t : mesh.triangle) {
    put(bytes, std::uint8_t{3});
    for (const auto v : t) put(bytes, static_cast<std::int32_t>(v), big);
  }
  return bytes;
}

}  // namespace mobil::test
