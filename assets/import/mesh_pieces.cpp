#include "assets/import/mesh_pieces.h"

#include <mobil/engine/geometry.h>
#include "assets/import/union_find.h"

namespace mobil::inline v0_3 {

Pieces label_pieces(const SurfaceMesh& mesh) {
  UnionFind sets(mesh.position.size());
  for (std::size_t t = 0; t + 2 < mesh.triangle.size(); t += 3) {
    sets.join(mesh.triangle[t], mesh.triangle[t + 1]);
    sets.join(mesh.triangle[t], mesh.triangle[t + 2]);
  }
  constexpr std::uint32_t none = ~0U;
  Pieces pieces;
  std::vector<std::uint32_t> number(mesh.position.size(), none);
  for (std::size_t t = 0; t + 2 < mesh.triangle.size(); t += 3) {
    std::uint32_t& own = number[sets.find(mesh.triangle[t])];
    if (own == none) own = pieces.count++;
    pieces.of.push_back(own);
  }
  return pieces;
}

std::vector<std::size_t> piece_triangles(const Pieces& pieces) {
  std::vector<std::size_t> count(pieces.count, 0);
  for (const auto piece : pieces.of) ++count[piece];
  return count;
}

std::vector<double> piece_volumes(const SurfaceMesh& mesh, const Pieces& pieces) {
  using namespace geometry;
  std::vector<double> volume(pieces.count, 0.0);
  const Vec near = mesh.position.empty() ? Vec{0, 0, 0} : to_double(mesh.position.front());
  for (std::size_t t = 0; t < pieces.of.size(); ++t) {
    const auto at = [&](std::size_t c) { return to_double(mesh.position[mesh.triangle[3 * t + c]]) - near; };
    volume[pieces.of[t]] += dot(at(0), cross(at(1), at(2))) / 6;
  }
  return volume;
}

}  // namespace mobil::inline v0_3
