#include "assets/surfaces/surface_mesh.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <utility>

#include <mobil/engine/geometry.h>

namespace mobil::inline v0_3 {

using namespace geometry;

void append(SurfaceMesh& mesh, const SurfaceMesh& part) {
  const auto first = static_cast<std::uint32_t>(mesh.position.size());
  mesh.position.insert(mesh.position.end(), part.position.begin(), part.position.end());
  mesh.triangle.reserve(mesh.triangle.size() + part.triangle.size());
  for (const auto index : part.triangle) mesh.triangle.push_back(first + index);
}

void drop_unused(SurfaceMesh& mesh) {
  constexpr auto unused = ~std::uint32_t{0};
  std::vector<std::uint32_t> moved(mesh.position.size(), unused);
  for (const auto v : mesh.triangle) moved[v] = 0;
  std::uint32_t kept = 0;
  for (std::size_t v = 0; v < moved.size(); ++v) {
    if (moved[v] == unused) continue;
    mesh.position[kept] = mesh.position[v];
    moved[v] = kept++;
  }
  mesh.position.resize(kept);
  for (auto& v : mesh.triangle) v = moved[v];
}

void drop_fins(std::vector<std::uint32_t>& triangle) {
  using Corners = std::array<std::uint32_t, 3>;
  std::multimap<Corners, std::size_t> unpaired;  // by their corners from the smallest on: their first index
  std::vector<bool> is_fin(triangle.size());
  for (std::size_t t = 0; t < triangle.size(); t += 3) {
    Corners corners{triangle[t], triangle[t + 1], triangle[t + 2]};
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    const auto back = unpaired.find({corners[0], corners[2], corners[1]});
    if (back == unpaired.end()) {
      unpaired.emplace(corners, t);
      continue;
    }
    is_fin[t] = is_fin[back->second] = true;
    unpaired.erase(back);
  }
  std::size_t kept = 0;
  for (std::size_t t = 0; t < triangle.size(); t += 3) {
    if (is_fin[t]) continue;
    for (std::size_t corner = 0; corner < 3; ++corner) triangle[kept++] = triangle[t + corner];
  }
  triangle.resize(kept);
}

bool is_closed(const SurfaceMesh& mesh) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edge, back;
  for (std::size_t t = 0; t < mesh.triangle.size(); t += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangle[t + k], b = mesh.triangle[t + (k + 1) % 3];
      edge.emplace_back(a, b);
      back.emplace_back(b, a);
    }
  }
  std::ranges::sort(edge);
  std::ranges::sort(back);
  return edge == back && std::ranges::adjacent_find(edge) == edge.end();
}

void scale(SurfaceMesh& mesh, double factor) {
  for (auto& p : mesh.position) p = to_float(factor * to_double(p));
}

void turn_over(std::vector<std::uint32_t>& triangle) {
  for (std::size_t t = 0; t + 2 < triangle.size(); t += 3) std::swap(triangle[t + 1], triangle[t + 2]);
}

SurfaceMesh mirror_image(const SurfaceMesh& mesh) {
  SurfaceMesh image = mesh;
  for (auto& p : image.position) p = mirrored(p);
  turn_over(image.triangle);
  return image;
}

double enclosed_volume(const SurfaceMesh& mesh) {
  if (mesh.position.empty()) return 0;
  const Vec near = to_double(mesh.position.front());  // avoids cancellation far from the origin
  double sum = 0;
  for (std::size_t t = 0; t + 2 < mesh.triangle.size(); t += 3) {
    const auto at = [&](std::size_t k) { return to_double(mesh.position[mesh.triangle[t + k]]) - near; };
    sum += dot(at(0), cross(at(1), at(2)));
  }
  return sum / 6;
}

}  // namespace mobil::inline v0_3
