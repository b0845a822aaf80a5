#include "assets/surfaces/surface_mesh.h"

#include <cstddef>
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
