#include <mobil/assets/import/mesh_edges.h>

#include <algorithm>
#include <utility>

namespace mobil::inline v0_3 {

std::vector<MeshEdge> sorted_edges(const SurfaceMesh& mesh) {
  std::vector<MeshEdge> sorted(mesh.triangle.size());
  for (std::uint32_t e = 0; e < sorted.size(); ++e) {
    const std::uint64_t a = mesh.triangle[e], b = mesh.triangle[next_corner(e)];
    sorted[e] = {std::min(a, b) << 32U | std::max(a, b), e};
  }
  std::sort(sorted.begin(), sorted.end(),
            [](const MeshEdge& a, const MeshEdge& b) { return std::pair(a.ends, a.edge) < std::pair(b.ends, b.edge); });
  return sorted;
}

EdgeCount count_edges(const SurfaceMesh& mesh) {
  EdgeCount count;
  each_edge(sorted_edges(mesh), [&](std::size_t first, std::size_t last) {
    count.border += last - first == 1 ? 1 : 0;
    count.overused += last - first > 2 ? 1 : 0;
  });
  return count;
}

}  // namespace mobil::inline v0_3
