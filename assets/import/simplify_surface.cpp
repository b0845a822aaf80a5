#include "assets/import/simplify_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "assets/import/mesh_pieces.h"
#include "assets/surfaces/surface_mesh.h"
#include "engine/eigen.h"

namespace mobil::inline v0_3 {
namespace {

Eigen::Vector3d at(const SurfaceMesh& mesh, std::uint32_t vertex) {
  const auto& p = mesh.position[vertex];
  return {p.x, p.y, p.z};
}

/// Returns the triangle rotated so that its smallest index is first: equal for the same corners and winding.
std::array<std::uint32_t, 3> canonical(std::array<std::uint32_t, 3> t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

}  // namespace

std::size_t remove_specks(SurfaceMesh& mesh, double share) {
  const Pieces pieces = label_pieces(mesh);
  const std::vector<std::size_t> triangles = piece_triangles(pieces);
  if (triangles.empty()) return 0;
  const std::size_t largest = *std::ranges::max_element(triangles);
  const double least = share * static_cast<double>(pieces.of.size());
  const auto stays = [&](std::uint32_t piece) {
    return triangles[piece] == largest || static_cast<double>(triangles[piece]) >= least;
  };
  std::size_t removed = 0;
  for (std::uint32_t piece = 0; piece < pieces.count; ++piece) removed += stays(piece) ? 0 : 1;
  keep_pieces(mesh, pieces, stays);
  return removed;
}

SurfaceMesh clustered(const SurfaceMesh& mesh, double cell_m) {
  if (cell_m <= 0) return mesh;
  std::vector<double> weight(mesh.position.size(), 0.0);
  for (std::size_t t = 0; t + 2 < mesh.triangle.size(); t += 3) {
    const Eigen::Vector3d a = at(mesh, mesh.triangle[t]);
    const double area = (at(mesh, mesh.triangle[t + 1]) - a).cross(at(mesh, mesh.triangle[t + 2]) - a).norm();
    for (std::size_t c = 0; c < 3; ++c) weight[mesh.triangle[t + c]] += area + 1e-12;
  }
  SurfaceMesh light;
  light.name = mesh.name;
  std::map<std::array<long, 3>, std::uint32_t> cell_index;
  std::vector<std::uint32_t> cell_of(mesh.position.size());
  std::vector<Eigen::Vector4d> sum;
  for (std::uint32_t v = 0; v < mesh.position.size(); ++v) {
    const Eigen::Vector3d p = at(mesh, v);
    const std::array<long, 3> cell = {std::lround(std::floor(p.x() / cell_m)), std::lround(std::floor(p.y() / cell_m)),
                                      std::lround(std::floor(p.z() / cell_m))};
    const auto [found, is_new] = cell_index.try_emplace(cell, static_cast<std::uint32_t>(sum.size()));
    if (is_new) sum.push_back(Eigen::Vector4d::Zero());
    cell_of[v] = found->second;
    sum[found->second] += weight[v] * Eigen::Vector4d(p.x(), p.y(), p.z(), 1);
  }
  for (const auto& s : sum) {
    const Eigen::Vector3f p = (s.head<3>() / std::max(s.w(), 1e-300)).cast<float>();
    light.position.push_back({p.x(), p.y(), p.z()});
  }
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::size_t t = 0; t + 2 < mesh.triangle.size(); t += 3) {
    const std::array<std::uint32_t, 3> corner = {cell_of[mesh.triangle[t]], cell_of[mesh.triangle[t + 1]],
                                                 cell_of[mesh.triangle[t + 2]]};
    if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue;
    triangles.push_back(canonical(corner));
  }
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  for (const auto& t : triangles) {  // a sheet folded flat onto itself vanishes, with both sides
    if (std::binary_search(triangles.begin(), triangles.end(), canonical({t[0], t[2], t[1]}))) continue;
    light.triangle.insert(light.triangle.end(), t.begin(), t.end());
  }
  drop_unused(light);
  return light;
}

}  // namespace mobil::inline v0_3
